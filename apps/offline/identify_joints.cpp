#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/offline/identify_command.h"
#include "hg/core/text.h"
#include "hg/identify/recorded_elasticity.h"

namespace hg::apps {
namespace {

using identify::Figure;
using identify::IdentifiedJoint;
using identify::RecordedElasticity;

constexpr int kDigits = 3;  // significant digits of printed numbers

void print_line(const char* key, const Figure& found, double nominal) {
  print_out("  {:<24}{:>9} {:<12}  files {}\n", key,
            found.is_found ? to_text(found.value, kDigits) : "-",
            found.is_found ? fmt::format("+- {}", to_text(found.interval(), kDigits)) : "",
            nominal > 0.0 ? to_text(nominal, kDigits) : "-");
}

void print_missing(const std::vector<std::string>& missing) {
  for (const std::string& what : missing) print_out("  not found: {}\n", what);
}

void print_elasticity(const IdentifiedJoint& joint) {
  const auto& found = joint.elasticity;
  print_out("\n{}  torque {:.3g} Nm rms, twist {:.2g} rad rms, {:.1g} rad rms unexplained\n",
            joint.name, found.torque, found.twist, found.residual);
  print_line("stiffness_Nm_per_rad", found.stiffness, joint.nominal.stiffness);
  print_line("damping_Nms_per_rad", found.damping, joint.nominal.damping);
  print_missing(found.missing);
}

void print_delay(const IdentifiedJoint& joint) {
  const auto& found = joint.delay;
  print_out("\n{}  commanded {:.2g} rad/s rms, {:.1g} rad rms unexplained\n", joint.name,
            found.speed, found.residual);
  if (found.delay.is_found) {
    print_out("  from command to position {:>7.2f} ms +- {:.2f}\n", 1e3 * found.delay.value,
              1e3 * found.delay.interval());
    print_out("  of that, first-order lag {}\n",
              found.lag.is_found
                  ? fmt::format("{:>7.2f} ms +- {:.2f}", 1e3 * found.lag.value,
                                1e3 * found.lag.interval())
                  : fmt::format("      - (less than {:.1f} ms)", 1e3 * found.lag.deviation));
  }
  print_missing(found.missing);
}

void print_actuators(const RecordedElasticity& result) {
  print_out("{}actuators:\n", result.follows_positions ? "  " : "");
  const char* indent = result.follows_positions ? "    " : "  ";
  for (const IdentifiedJoint& joint : result.joints) {
    const auto& found = joint.elasticity;
    if (!found.stiffness.is_found) continue;
    print_out("{}{}:\n", indent, joint.name);
    print_out("{}  stiffness_Nm_per_rad: {}  # +- {}\n", indent,
              to_text(found.stiffness.value, kDigits),
              to_text(found.stiffness.interval(), kDigits));
    if (!found.damping.is_found) continue;
    print_out("{}  damping_Nms_per_rad: {}  # +- {}\n", indent,
              to_text(found.damping.value, kDigits), to_text(found.damping.interval(), kDigits));
  }
}

void print_yaml(const RecordedElasticity& result) {
  if (!result.follows_positions) {
    print_out(
        "\nfor device.yaml, into the entry of each joint (and 'stiffness: 1', 'damping: 1' under "
        "'factors' of the simulation file):\n");
    print_actuators(result);
    return;
  }
  print_out("\nfor the simulation file:\ndrives:\n");
  if (result.latency.is_found) {
    print_out("  latency_s: {:.5f}  # +- {:.5f}, file {:.5f}\n", result.latency.value,
              result.latency.interval(), result.nominal_latency);
  }
  if (result.has_both_sides) print_actuators(result);
}

nlohmann::ordered_json to_json(const Figure& figure, double nominal) {
  nlohmann::ordered_json json;
  json["is_found"] = figure.is_found;
  if (figure.is_found) {
    json["value"] = figure.value;
    json["deviation"] = figure.deviation;
  }
  json["files"] = nominal;
  return json;
}

nlohmann::ordered_json to_json(const RecordedElasticity& result) {
  nlohmann::ordered_json json;
  json["identified"] = "joints";
  if (result.follows_positions) {
    json["delay_s"] = to_json(result.delay, result.nominal_delay);
    json["latency_s"] = to_json(result.latency, result.nominal_latency);
  }
  json["joints"] = nlohmann::ordered_json::array();
  for (const IdentifiedJoint& identified : result.joints) {
    nlohmann::ordered_json joint;
    joint["name"] = identified.name;
    std::vector<std::string> missing = identified.delay.missing;
    if (result.has_both_sides) {
      const auto& found = identified.elasticity;
      joint["stiffness_Nm_per_rad"] = to_json(found.stiffness, identified.nominal.stiffness);
      joint["damping_Nms_per_rad"] = to_json(found.damping, identified.nominal.damping);
      missing.insert(missing.end(), found.missing.begin(), found.missing.end());
    }
    if (result.follows_positions) {
      joint["delay_s"] = to_json(identified.delay.delay, result.nominal_delay);
      joint["lag_s"] = to_json(identified.delay.lag, 0.0);
    }
    joint["missing"] = missing;
    json["joints"].push_back(joint);
  }
  return json;
}

bool is_anything_found(const RecordedElasticity& result) {
  return result.delay.is_found ||
         std::ranges::any_of(result.joints, [](const IdentifiedJoint& joint) {
           return joint.elasticity.stiffness.is_found;
         });
}

}  // namespace

int identify_joints(const IdentifyRecordingArguments& arguments) {
  check_writable(arguments.json, kJson);
  const RecordedElasticity result =
      identify::identify_recorded_elasticity(arguments.file, given_device(arguments));
  print_out(recording::to_text(result.losses));
  print_out("{}: {} joints, drives on for {:.1f} s; +- is the 95 % interval\n", arguments.file,
            result.joints.size(), result.used_s);
  if (!result.has_both_sides) {
    print_out(
        "stiffness and damping: not in this recording, the device does not report motors, joints "
        "and joint torques\n");
  }
  for (const IdentifiedJoint& joint : result.joints) {
    if (result.has_both_sides) print_elasticity(joint);
    if (result.follows_positions) print_delay(joint);
  }
  write_json(arguments.json, to_json(result));
  if (!is_anything_found(result)) {
    print_error("not usable: no joint moved enough for its stiffness or delay\n");
    return 2;
  }
  print_yaml(result);
  return 0;
}

}  // namespace hg::apps
