#include "hg/config/actuator_library.h"

#include <algorithm>
#include <cmath>

#include "hg/config/device_schema.h"
#include "hg/config/loader.h"

namespace hg::config {

std::vector<ActuatorType> load_actuator_library(const std::filesystem::path& path) {
  SourceReader reader;
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  std::vector<ActuatorType> library;
  load_file(file, [&](Loader& loader) {
    loader.list(
        "actuators",
        [&](Loader& child) {
          ActuatorType& type = library.emplace_back();
          child.words("name", type.name, "name of the type", Need::kRequired);
          child.words("source", type.source, "what it is typical of", Need::kRequired);
          child.number("gear_ratio", type.gear_ratio, {.lb = 1e-3, .ub = 1e5},
                       "turns of the motor per turn of the joint");
          describe(child, type.model);
        },
        "types of joints", Need::kRequired);
    loader.rule(!library.empty(), "actuators", "needs at least one type");
  });
  return library;
}

ActuatorType actuator_for(const std::vector<ActuatorType>& library, double torque_max,
                          double dq_max) {
  const auto distance = [&](const ActuatorType& type) {
    return std::abs(std::log(torque_max / type.model.torque_max));
  };
  ActuatorType type = *std::ranges::min_element(library, {}, distance);
  ActuatorModel& model = type.model;
  const double scale = torque_max / model.torque_max;
  const double reserve = model.speed_no_load / model.speed_full_torque;
  for (double* value : {&model.rotor_inertia, &model.stiffness, &model.damping,
                        &model.coulomb_friction, &model.viscous_friction, &model.torque_rated}) {
    *value *= scale;
  }
  model.torque_max = torque_max;
  model.speed_full_torque = dq_max;
  model.speed_no_load = reserve * dq_max;
  return type;
}

}  // namespace hg::config
