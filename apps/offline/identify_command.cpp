#include "apps/offline/identify_command.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/offline/subcommand.h"
#include "hg/config/device.h"
#include "hg/config/shipped_files.h"
#include "hg/core/open_file.h"
#include "hg/identify/payload.h"
#include "hg/identify/payload_units.h"
#include "hg/identify/static_poses.h"

namespace hg::apps {
namespace {

using identify::PayloadEstimate;
using identify::StaticPose;

struct IdentifyArguments {
  std::vector<std::string> files;                          ///< CSV files; empty = simulate
  std::string device = "models/haptic_giant/device.yaml";  ///< device to simulate and compare with
  int poses = 12;  ///< number of poses taken on the simulated device
};

std::vector<StaticPose> simulated_poses(const config::SimulatedDeviceConfig& device, int count) {
  std::vector<StaticPose> poses;
  for (const VectorM& q_m : identify::static_postures(device, count)) {
    poses.push_back(identify::measure_simulated(device, q_m));
  }
  return poses;
}

std::vector<StaticPose> poses_of(const std::vector<std::string>& files) {
  std::vector<StaticPose> poses;
  for (const std::string& file : files) {
    for (const StaticPose& pose : identify::read_static_poses(file, read_file(file))) {
      poses.push_back(pose);
    }
  }
  return poses;
}

std::vector<double> numbers(const auto& v) { return {v.begin(), v.end()}; }

nlohmann::ordered_json to_json(const PayloadEstimate& found, const Payload& expected) {
  nlohmann::ordered_json json = {{"kind", "identify"},
                                 {"identified", "payload"},
                                 {"mass_kg", found.mass},
                                 {"mass_deviation_kg", found.mass_deviation},
                                 {"com_m", numbers(found.com)},
                                 {"com_deviation_m", found.com_deviation},
                                 {"offset", numbers(found.offset)},
                                 {"residual_N", found.force_residual},
                                 {"residual_Nm", found.torque_residual},
                                 {"condition", found.condition},
                                 {"doubts", identify::payload_doubts(found, expected)},
                                 {"missing", found.missing}};
  if (expected.mass > 0.0) {
    json["device_file"] = {{"mass_kg", expected.mass}, {"com_m", numbers(expected.com)}};
  }
  return json;
}

int identify_payload(const IdentifyArguments& arguments) {
  const config::SimulatedDeviceConfig device =
      config::load_simulated_device(config::find_device(arguments.device, {}));
  check_report_program();
  const bool is_simulated = arguments.files.empty();
  const std::vector<StaticPose> poses =
      is_simulated ? simulated_poses(device, arguments.poses) : poses_of(arguments.files);
  nlohmann::ordered_json results =
      to_json(identify::identify_payload(poses), device.estimation.wrench.payload);
  results["poses"] = poses.size();
  results["files"] = arguments.files;
  results["device"] = device.name;
  return become_reports({{.results = results}});
}

using Identify = nlohmann::ordered_json (*)(const IdentifyRecordingArguments& arguments);

int identify_recorded(Identify identify, const IdentifyRecordingArguments& arguments) {
  check_writable(arguments.json, kJson);
  if (arguments.json.empty()) check_report_program();
  nlohmann::ordered_json results = identify(arguments);
  results["file"] = arguments.file;
  write_json(arguments.json, results);
  return become_reports(
      {{.results = results,
        .kept = arguments.json.empty() ? "" : arguments.json + " has the results\n"}});
}

// Adds a subcommand that identifies something from a recording.
void add_recorded(Command identify, int& exit_code, Identify run, const char* name,
                  const char* what, const char* examples) {
  const auto arguments = std::make_shared<IdentifyRecordingArguments>();
  const Command command = identify.add_subcommand(name, what);
  command.footer(examples);
  command.add_option("file", arguments->file, "recording of hapticgiant run")
      .required()
      .existing_file();
  command.add_option("--device", arguments->device,
                     "device.yaml to compare with instead of that of the recording");
  command.add_option("--json", arguments->json, "write all figures as JSON to this file");
  command.callback(
      [arguments, run, &exit_code] { exit_code = identify_recorded(run, *arguments); });
}

}  // namespace

std::optional<config::SimulatedDeviceConfig> given_device(
    const IdentifyRecordingArguments& arguments) {
  if (arguments.device.empty()) return {};
  return config::load_simulated_device(config::find_device(arguments.device, {}));
}

nlohmann::ordered_json figure_json(const identify::Figure& figure, const char* file_key,
                                   double in_file) {
  nlohmann::ordered_json json = {{"is_found", figure.is_found}};
  if (figure.is_found) {
    json["value"] = figure.value;
    json["deviation"] = figure.deviation;
  }
  json[file_key] = in_file;
  return json;
}

void add_identify(Command app, int& exit_code) {
  const auto arguments = std::make_shared<IdentifyArguments>();
  const Command identify = add_offline(app, "identify");
  identify.require_subcommand(1);
  const Command payload = identify.add_subcommand(
      "payload", "Mass and centre of what hangs beyond the force/torque sensor.");
  payload.footer(
      "Examples:\n"
      "  hapticgiant identify payload             the simulated device takes the poses itself\n"
      "  hapticgiant identify payload poses.csv   columns a_x a_y a_z f_x f_y f_z n_x n_y n_z "
      "pose");
  payload.add_option("files", arguments->files, "CSV files of poses at rest; none: simulate");
  payload.add_option("--device", arguments->device, "device.yaml").capture_default_str();
  payload.add_option("--poses", arguments->poses, "poses of the simulated device")
      .check(at_least(1))
      .capture_default_str();
  payload.callback([arguments, &exit_code] { exit_code = identify_payload(*arguments); });
  add_recorded(identify, exit_code, identify_friction, "friction",
               "Friction of each joint from a recording of its motion (docs/concepts/friction.md).",
               "Examples:\n"
               "  hapticgiant run free_space --user friction --fast   moves all joints\n"
               "  hapticgiant identify friction recordings/latest.mcap");
  add_recorded(identify, exit_code, identify_joints, "joints",
               "Stiffness and damping of each joint, or the delay of drives that follow positions, "
               "from a recording (docs/concepts/identification.md).",
               "Examples:\n"
               "  hapticgiant run fr3/move_tool --fast\n"
               "  hapticgiant identify joints recordings/latest.mcap");
  add_recorded(identify, exit_code, identify_inertia, "inertia",
               "Inertial parameters of the links of an arm with joint torque sensors, from a "
               "recording (docs/concepts/identification.md).",
               "Examples:\n"
               "  hapticgiant run fr3/excite --fast   moves all joints\n"
               "  hapticgiant identify inertia recordings/latest.mcap");
}

}  // namespace hg::apps
