#include <array>
#include <nlohmann/json.hpp>

#include "apps/offline/identify_command.h"
#include "hg/identify/inertia.h"

namespace hg::apps {
namespace {

constexpr std::array<const char*, identify::kLinkFigures> kNames = {
    "mass_kg",   "com_x_m",   "com_y_m",   "com_z_m",   "ixx_kg_m2",
    "ixy_kg_m2", "iyy_kg_m2", "ixz_kg_m2", "iyz_kg_m2", "izz_kg_m2"};

// Also what was not found has a value: it is mostly the URDF's.
nlohmann::ordered_json to_json(const identify::Figure& figure, double nominal) {
  return {{"urdf", nominal},
          {"value", figure.value},
          {"deviation", figure.deviation},
          {"is_found", figure.is_found}};
}

}  // namespace

nlohmann::ordered_json identify_inertia(const IdentifyRecordingArguments& arguments) {
  const identify::RecordedInertia result =
      identify::identify_recorded_inertia(arguments.file, given_device(arguments));
  nlohmann::ordered_json json = recorded_json("inertia", result);
  json["missing"] = result.found.missing;
  for (const identify::JointFit& joint : result.found.joints) {
    json["joints"].push_back({{"name", joint.name},
                              {"way_rad", joint.way},
                              {"acceleration_rad_per_s2", joint.acceleration},
                              {"unexplained_Nm", joint.after},
                              {"unexplained_by_files_Nm", joint.before}});
  }
  json["base"] = nlohmann::ordered_json::array();
  for (const identify::BaseFigure& base : result.found.base) {
    nlohmann::ordered_json& entry = json["base"].emplace_back(to_json(base.found, base.nominal));
    entry["name"] = base.name;
  }
  json["links"] = nlohmann::ordered_json::array();
  for (const identify::LinkInertia& link : result.found.links) {
    nlohmann::ordered_json entry = {{"name", link.name}};
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      entry[kNames[i]] = to_json(link.figures[i], link.nominal_values[i]);
    }
    json["links"].push_back(entry);
  }
  return json;
}

}  // namespace hg::apps
