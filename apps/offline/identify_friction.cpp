#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/offline/identify_command.h"
#include "hg/config/device.h"
#include "hg/config/shipped_files.h"
#include "hg/core/text.h"
#include "hg/identify/recorded_friction.h"

namespace hg::apps {
namespace {

using identify::Figure;
using identify::FrictionEstimate;
using identify::JointFriction;

// One line of the table and of the device file.
struct Line {
  const char* key;
  Figure found;
  double nominal;
};

std::vector<Line> lines_of(const JointFriction& joint) {
  const FrictionEstimate& found = joint.found;
  const ActuatorModel& nominal = joint.nominal;
  return {{"coulomb_friction_Nm", found.coulomb, nominal.coulomb_friction},
          {"viscous_friction_Nms_per_rad", found.viscous, nominal.viscous_friction},
          {"load_friction", found.load, nominal.load_friction},
          {"stiction", found.stiction, nominal.stiction},
          {"stribeck_rad_per_s", found.stribeck_speed, nominal.stribeck_speed},
          {"presliding_rad", found.presliding, nominal.presliding}};
}

constexpr int kDigits = 3;  // significant digits of printed numbers

void print(const JointFriction& joint) {
  const FrictionEstimate& found = joint.found;
  print_out(
      "\n{}  slid {:.0f} s forward, {:.0f} s backward, {} reversals, up to {:.2f} rad/s; {:.2f} Nm "
      "rms unexplained\n",
      joint.name, found.forward_s, found.backward_s, found.reversals, found.speed, found.residual);
  for (const Line& line : lines_of(joint)) {
    print_out(
        "  {:<30}{:>9} {:<12}  device file {}\n", line.key,
        line.found.is_found ? to_text(line.found.value, kDigits) : "-",
        line.found.is_found ? fmt::format("+- {}", to_text(line.found.deviation, kDigits)) : "",
        to_text(line.nominal, kDigits));
  }
  for (const std::string& missing : found.missing) print_out("  not found: {}\n", missing);
}

void print_yaml(const std::vector<JointFriction>& joints) {
  print_out("\nfor device.yaml, into the entry of each joint:\nactuators:\n");
  for (const JointFriction& joint : joints) {
    print_out("  {}:\n", joint.name);
    if (!joint.found.coulomb.is_found) print_out("    # nothing was found\n");
    for (const Line& line : lines_of(joint)) {
      if (!line.found.is_found) continue;
      print_out("    {}: {}  # +- {}\n", line.key, to_text(line.found.value, kDigits),
                to_text(line.found.deviation, kDigits));
    }
    if (joint.found.presliding_elements > 0) {
      print_out("    presliding_elements: {}\n", joint.found.presliding_elements);
    }
  }
}

nlohmann::ordered_json to_json(const std::vector<JointFriction>& joints) {
  nlohmann::ordered_json json;
  json["identified"] = "friction";
  json["joints"] = nlohmann::ordered_json::array();
  for (const JointFriction& identified : joints) {
    const FrictionEstimate& found = identified.found;
    nlohmann::ordered_json joint;
    joint["name"] = identified.name;
    for (const Line& line : lines_of(identified)) {
      nlohmann::ordered_json& entry = joint[line.key];
      entry["is_found"] = line.found.is_found;
      if (line.found.is_found) {
        entry["value"] = line.found.value;
        entry["deviation"] = line.found.deviation;
      }
      entry["device_file"] = line.nominal;
    }
    if (found.presliding_elements > 0) joint["presliding_elements"] = found.presliding_elements;
    joint["residual_Nm"] = found.residual;
    joint["forward_s"] = found.forward_s;
    joint["backward_s"] = found.backward_s;
    joint["reversals"] = found.reversals;
    joint["missing"] = found.missing;
    json["joints"].push_back(joint);
  }
  return json;
}

}  // namespace

int identify_friction(const IdentifyRecordingArguments& arguments) {
  check_writable(arguments.json, kJson);
  std::optional<config::DeviceConfig> device;
  if (!arguments.device.empty()) {
    device = config::load_device(config::find_device(arguments.device, {}));
  }
  const identify::RecordedFriction result =
      identify::identify_recorded_friction(arguments.file, std::move(device));
  print_out(recording::to_text(result.losses));
  print_out("{}: {} joints, drives on for {:.1f} s\n", arguments.file, result.joints.size(),
            result.used_s);
  for (const JointFriction& joint : result.joints) print(joint);
  write_json(arguments.json, to_json(result.joints));
  const auto is_found = [](const JointFriction& joint) { return joint.found.coulomb.is_found; };
  if (std::ranges::none_of(result.joints, is_found)) {
    print_error("not usable: no joint moved enough for its friction\n");
    return 2;
  }
  print_yaml(result.joints);
  return 0;
}

}  // namespace hg::apps
