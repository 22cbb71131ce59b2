#include "apps/hapticgiant/new_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <system_error>

#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "hg/commissioning/checks/way.h"
#include "hg/commissioning/generator/gripper.h"
#include "hg/commissioning/generator/scaffold.h"
#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/model/urdf.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

void check_new(const NewArguments& arguments, const fs::path& output) {
  std::error_code error;
  if (fs::exists(output, error) && !arguments.may_overwrite) {
    throw SetupError(output.string() +
                     ": exists already; --force overwrites it, -o FILE writes another file");
  }
  check_writable(output.string());
}

fs::path output_of(const NewArguments& arguments, const char* kind) {
  const fs::path output = arguments.output.empty()
                              ? arguments.part.urdf.stem().string() + "_" + kind + ".yaml"
                              : arguments.output;
  check_new(arguments, output);
  return output;
}

generator::Drives drives_named(const std::string& name) {
  if (name == "torque") return generator::Drives::kTorque;
  return name == "ideal" ? generator::Drives::kIdeal : generator::Drives::kPosition;
}

// The part as asked for; the whole of a robot is taken without its gripper, which is told.
generator::ChainPart device_part(const NewArguments& arguments) {
  generator::ChainPart part = arguments.part;
  if (!part.root_link.empty() || !part.tip_link.empty()) return part;
  const auto gripper = generator::find_gripper(model::read_urdf_file(part.urdf));
  if (!gripper) return part;
  part.tip_link = gripper->link;
  print_out(
      "note        taken as a gripper, which stands still: {}; --tip-link takes another part\n",
      fmt::join(gripper->joints, ", "));
  return part;
}

}  // namespace

int new_device(const NewArguments& arguments) {
  const fs::path output = output_of(arguments, "device");
  const fs::path simulation = output.parent_path() / (output.stem().string() + "_simulation.yaml");
  const generator::Drives drives = drives_named(arguments.drives);
  if (drives != generator::Drives::kIdeal) check_new(arguments, simulation);
  const generator::DeviceFiles files =
      generator::draft_device(device_part(arguments), output.parent_path(), drives,
                              simulation.filename().string(), progress_of("self-collision"));
  if (!files.simulation.empty()) {
    write_output(simulation.string(), files.simulation);
    print_out("{} written: its simulated drives and sensors, typical ones ([A]: assumed).\n",
              simulation.string());
  } else if (drives != generator::Drives::kIdeal) {
    print_out(
        "note        a joint is prismatic, and the known drives turn: it is simulated with "
        "ideal drives\n");
  }
  write_output(output.string(), files.device);
  for (const std::string& line : files.news) print_out("note        {}\n", line);
  print_out(
      "{0} written. Next:\n"
      "  hapticgiant check {0}\n"
      "  hapticgiant new twin TWIN.urdf --device {0}\n",
      output.string());
  return 0;
}

int new_twin(const NewArguments& arguments) {
  const fs::path output = output_of(arguments, "twin");
  const bool is_own = !arguments.device.empty();
  const config::SimulatedDeviceConfig device = config::load_simulated_device(
      config::find_device(is_own ? arguments.device : "haptic_giant", {}));
  const generator::TwinDraft draft = generator::draft_twin(arguments.part, output.parent_path(),
                                                           device, progress_of("placements"));
  write_output(output.string(), draft.yaml);
  if (!draft.trouble.empty()) {
    print_error("WARNING {}: {}\n  what helps: {}\n", output.string(), draft.trouble,
                checks::kCuresOfWay);
  }
  const std::string file = is_own ? device.sources.front().name : "";
  const std::string with = is_own ? " --device " + file : "";
  print_out(
      "{0} written. Next:\n"
      "  hapticgiant check {2}{0}\n"
      "  hapticgiant run{1} --twin {0}\n",
      output.string(), with, is_own ? file + " " : "");
  return 0;
}

void add_new(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<NewArguments>();
  CLI::App* command =
      app.add_subcommand("new", "Write a first device.yaml or twin.yaml for a URDF.");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hapticgiant new device my_arm.urdf\n"
      "  hapticgiant new twin my_gate.urdf --device my_arm_device.yaml");
  const auto add = [&](const char* kind, const char* text, int (*run)(const NewArguments&)) {
    CLI::App* what = command->add_subcommand(kind, text);
    what->add_option("urdf", arguments->part.urdf, "URDF of the robot or mechanism")
        ->required()
        ->check(CLI::ExistingFile);
    what->add_option("--root-link", arguments->part.root_link,
                     "first link of the part that is taken");
    what->add_option("--tip-link", arguments->part.tip_link, "last link of the part that is taken");
    what->add_option("-o,--output", arguments->output,
                     "file to write; default: URDF name + _device.yaml or _twin.yaml");
    what->add_flag("--force", arguments->may_overwrite, "overwrite the file");
    what->callback([arguments, &exit_code, run] { exit_code = run(*arguments); });
    return what;
  };
  add("device", "the robot whose handle is held", new_device)
      ->add_option("--drives", arguments->drives,
                   "how its joints take commands, and how they are simulated: position, torque, or "
                   "ideal (positions, followed exactly)")
      ->check(CLI::IsMember({"position", "torque", "ideal"}));
  add("twin", "the mechanism that is felt", new_twin)
      ->add_option(
          "--device", arguments->device,
          "device.yaml that the twin is placed for, or the name of a shipped device (fr3)");
}

}  // namespace hg::apps
