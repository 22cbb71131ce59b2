#include "hg/design/catalogue.h"

#include <algorithm>
#include <set>

#include "hg/config/device_schema.h"
#include "hg/config/loader.h"
#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::design {
namespace {

constexpr config::Range kRatio = {.lb = 1.0, .ub = 1e4};

JointSize read_size(config::Loader& loader) {
  using config::Need;
  JointSize size;
  loader.words("name", size.name, "name of the size", Need::kRequired);
  loader.words("source", size.source, "where the values come from", Need::kRequired);
  loader.number("mass_kg", size.mass, config::kPositive, "of the whole joint", Need::kRequired);
  loader.number("price", size.price, {.lb = 0.0, .ub = 1e9}, "of one joint", Need::kRequired);
  loader.number("radius_m", size.radius, config::kPositive, "of the housing", Need::kRequired);
  loader.number("tube_metre_kg", size.tube_mass, config::kNotNegative,
                "a metre of the tube that suits this joint", Need::kRequired);
  loader.number("gear_torque_max_Nm", size.gear_torque_max, config::kPositive,
                "largest peak torque of the gear", Need::kRequired);
  loader.number("gear_ratio", size.gear_ratio, kRatio, "ratio that the values count for",
                Need::kRequired);
  loader.list(
      "ratios",
      [&](config::Loader& child) {
        child.number("ratio", size.ratios.emplace_back(), kRatio, "turns of the motor per turn",
                     Need::kRequired);
      },
      "ratios that can be had", Need::kRequired);
  loader.rule(!size.ratios.empty() && std::ranges::is_sorted(size.ratios), "ratios",
              "needs at least one ratio, from small to large");
  describe(loader, size.actuator);
  loader.rule(size.actuator.torque_max <= size.gear_torque_max, "gear_torque_max_Nm",
              "must not be below torque_max_Nm");
  return size;
}

}  // namespace

int Catalogue::size(const std::string& name) const {
  std::vector<std::string> names;
  for (const JointSize& it : sizes) names.push_back(it.name);
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw SetupError("catalogue: no size '" + name + "'; nearest is '" + nearest_name(name, names) +
                   "'");
}

ActuatorModel with_ratio(const JointSize& size, double ratio) {
  const double k = ratio / size.gear_ratio;
  ActuatorModel actuator = size.actuator;
  actuator.torque_max = std::min(k * actuator.torque_max, size.gear_torque_max);
  actuator.torque_rated = std::min(k * actuator.torque_rated, actuator.torque_max);
  actuator.coulomb_friction *= k;
  actuator.rotor_inertia *= k * k;
  actuator.viscous_friction *= k * k;
  actuator.speed_full_torque /= k;
  actuator.speed_no_load /= k;
  return actuator;
}

Catalogue load_catalogue(const std::filesystem::path& path, config::SourceReader& reader) {
  config::LoaderFile file = {path, reader, config::Faults(path.generic_string())};
  Catalogue catalogue;
  load_file(file, [&](config::Loader& loader) {
    loader.list(
        "sizes", [&](config::Loader& child) { catalogue.sizes.push_back(read_size(child)); },
        "joint sizes, from small to large", config::Need::kRequired);
    loader.rule(!catalogue.sizes.empty(), "sizes", "needs at least one size");
    loader.rule(
        std::ranges::is_sorted(catalogue.sizes, {},
                               [](const JointSize& size) { return size.actuator.torque_max; }),
        "sizes", "must be in the order of their peak torques");
    std::set<std::string> names;
    for (const JointSize& size : catalogue.sizes) {
      loader.rule(names.insert(size.name).second, "sizes", "names must differ",
                  "'" + size.name + "'");
    }
  });
  return catalogue;
}

}  // namespace hg::design
