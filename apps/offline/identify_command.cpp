#include "apps/offline/identify_command.h"

#include <fmt/format.h>
#include <memory>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
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

std::string row(const Eigen::Vector3d& v, int digits) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v.x(), digits, v.y(), digits, v.z(), digits);
}

void print_estimate(const PayloadEstimate& found) {
  print_out("mass            {:.4f} kg, +-{:.4f}\n", found.mass, found.mass_deviation);
  print_out("centre of mass  {} m in S, +-{:.4f}\n", row(found.com, 4), found.com_deviation);
  print_out("sensor offset   {} N; {} Nm\n", row(found.offset.head<3>(), 2),
            row(found.offset.tail<3>(), 4));
  print_out("residuals       {:.3f} N, {:.4f} Nm rms\n", found.force_residual,
            found.torque_residual);
  print_out("condition       {:.1f}  (1 = every direction shows alike)\n", found.condition);
}

void print_comparison(const PayloadEstimate& found, const Payload& expected) {
  if (!(expected.mass > 0.0)) return;
  print_out("device.yaml     mass {:+.2f} %, centre of mass {:.1f} mm from its values\n",
            100.0 * (found.mass / expected.mass - 1.0), 1e3 * (found.com - expected.com).norm());
}

void print_yaml(const PayloadEstimate& found) {
  print_out(
      "\nfor device.yaml:\npayload:\n  mass_kg: {:.4f}\n  centre_of_mass_m: [{}]\n"
      "  # inertia_kg_m2 does not show at rest: from the drawing\n",
      found.mass, row(found.com, 4));
}

// Adds a subcommand that identifies something from a recording.
void add_recorded(Command identify, int& exit_code,
                  int (*run)(const IdentifyRecordingArguments& arguments), const char* name,
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
  command.callback([arguments, run, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace

std::optional<config::SimulatedDeviceConfig> given_device(
    const IdentifyRecordingArguments& arguments) {
  if (arguments.device.empty()) return {};
  return config::load_simulated_device(config::find_device(arguments.device, {}));
}

int identify_payload(const IdentifyArguments& arguments) {
  const config::SimulatedDeviceConfig device =
      config::load_simulated_device(config::find_device(arguments.device, {}));
  const bool is_simulated = arguments.files.empty();
  const std::vector<StaticPose> poses =
      is_simulated ? simulated_poses(device, arguments.poses) : poses_of(arguments.files);
  print_out("{} poses {}\n\n", poses.size(),
            is_simulated ? "of the simulated " + device.name + ", handle not held"
                         : "from " + fmt::format("{}", fmt::join(arguments.files, ", ")));
  const PayloadEstimate found = identify::identify_payload(poses);
  print_estimate(found);
  print_comparison(found, device.estimation.wrench.payload);
  for (const std::string& doubt :
       identify::payload_doubts(found, device.estimation.wrench.payload)) {
    print_error("WARNING {}\n", doubt);
  }
  if (!found.missing.empty()) {
    print_error("not usable: {}\n", found.missing);
    return 2;
  }
  print_yaml(found);
  return 0;
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
