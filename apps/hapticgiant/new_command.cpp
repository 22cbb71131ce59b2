#include "apps/hapticgiant/new_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "hg/check/ignored_urdf.h"
#include "hg/check/twin_bodies.h"
#include "hg/check/unit_inspection.h"
#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/model/urdf.h"
#include "hg/new/gripper.h"
#include "hg/new/scaffold.h"
#include "hg/workspace/way.h"

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

// What stands where a URDF is expected; empty: it may be one.
std::string no_urdf(const std::string& file) {
  const std::string text = read_file(file);
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '<') return "";
  return file + ": expected a URDF, which is XML, got another kind of file";
}

fs::path output_of(const NewArguments& arguments, const char* kind) {
  const fs::path output = arguments.output.empty()
                              ? arguments.part.urdf.stem().string() + "_" + kind + ".yaml"
                              : arguments.output;
  check_new(arguments, output);
  return output;
}

new_files::Drives drives_named(const std::string& name) {
  if (name == "torque") return new_files::Drives::kTorque;
  return name == "ideal" ? new_files::Drives::kIdeal : new_files::Drives::kPosition;
}

// The part as asked for; the whole of a robot is taken without its gripper, and a note says so.
new_files::ChainPart device_part(const NewArguments& arguments) {
  new_files::ChainPart part = arguments.part;
  if (!part.root_link.empty() || !part.tip_link.empty()) return part;
  const auto gripper = new_files::find_gripper(model::read_urdf_file(part.urdf));
  if (!gripper) return part;
  part.tip_link = gripper->link;
  print_out(
      "note        taken as a gripper, which stands still: {}; --tip-link takes another part\n",
      fmt::join(gripper->joints, ", "));
  return part;
}

// What a draft leaves out of the URDF.
void print_not_read(const std::filesystem::path& urdf, check::UrdfUse use) {
  const std::vector<config::SourceText> sources = {{"", ""}, {urdf.string(), read_file(urdf)}};
  const config::Places places;
  check::Collector found(sources, places);
  check::inspect_ignored(sources, use, found);
  for (const check::Finding& finding : found.findings) print_out("note        {}\n", finding.what);
}

// Numbers of the URDF that can only be in another unit, or placeholders.
void print_doubted_units(const new_files::ChainPart& part) {
  const std::string file = part.urdf.string();
  const std::vector<config::SourceText> sources = {{file, read_file(part.urdf)}};
  const config::Places places;
  check::Collector found(sources, places);
  const std::vector<std::string> joints = check::joint_names(new_files::read_part(part));
  check::inspect_units(sources, joints, found);
  check::inspect_bodies(sources, joints, found);
  for (const check::Finding& finding : found.findings) {
    print_error("WARNING {}:{}: {}: {}\n  to fix: {}\n", finding.file, finding.place.line,
                finding.item, finding.what, finding.fix);
  }
}

}  // namespace

int new_device(const NewArguments& arguments) {
  const fs::path output = output_of(arguments, "device");
  const fs::path simulation = output.parent_path() / (output.stem().string() + "_simulation.yaml");
  const new_files::Drives drives = drives_named(arguments.drives);
  if (drives != new_files::Drives::kIdeal) check_new(arguments, simulation);
  const new_files::ChainPart part = device_part(arguments);
  const new_files::DeviceFiles files =
      new_files::draft_device(part, output.parent_path(), drives, simulation.filename().string(),
                              progress_of("self-collision"));
  if (!files.simulation.empty()) {
    write_output(simulation.string(), files.simulation);
    print_out("{} written: its simulated drives and sensors, typical ones ([A]: assumed).\n",
              simulation.string());
  } else if (drives != new_files::Drives::kIdeal) {
    print_out(
        "note        a joint is prismatic, and the known drives turn: it is simulated with "
        "ideal drives\n");
  }
  write_output(output.string(), files.device);
  print_not_read(arguments.part.urdf, check::UrdfUse::kDevice);
  print_doubted_units(part);
  for (const std::string& line : files.news) print_out("note        {}\n", line);
  for (const std::string& line : files.doubts)
    print_error("WARNING {}: {}\n", output.string(), line);
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
  const new_files::TwinDraft draft = new_files::draft_twin(arguments.part, output.parent_path(),
                                                           device, progress_of("placements"));
  write_output(output.string(), draft.yaml);
  print_not_read(arguments.part.urdf, check::UrdfUse::kTwin);
  print_doubted_units(arguments.part);
  if (!draft.note.empty()) print_out("note        {}\n", draft.note);
  if (!draft.doubt.empty()) print_error("WARNING {}: {}\n", output.string(), draft.doubt);
  if (!draft.problem.empty()) {
    print_error("WARNING {}: {}\n  what helps: {}\n", output.string(), draft.problem,
                workspace::kCuresOfWay);
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

namespace {

std::string replaced(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

int new_driver(const NewDriverArguments& arguments) {
  const std::string& name = arguments.name;
  const auto is_letter = [](unsigned char c) { return std::isalpha(c) != 0 || c == '_'; };
  const auto is_of_name = [&](unsigned char c) { return is_letter(c) || std::isdigit(c) != 0; };
  if (name.empty() || !is_letter(name[0]) || !std::ranges::all_of(name, is_of_name)) {
    throw SetupError("new driver: the name must have letters, digits and _ only, got '" + name +
                     "'");
  }
  const fs::path templates =
      config::installation_root() / "examples" / "driver" / arguments.language;
  std::error_code error;
  if (!fs::is_directory(templates, error)) {
    throw SetupError(templates.string() + ": not part of this installation");
  }
  const fs::path folder = name;
  if (fs::exists(folder, error)) throw SetupError(name + ": exists already");
  std::string device = "DEVICE.yaml", options = "--joints 6 --rate-hz 250";
  std::vector<std::pair<std::string_view, std::string>> names = {{"my_driver", name}};
  if (!arguments.device.empty()) {
    const config::DeviceConfig config =
        config::load_device(config::find_device(arguments.device, {}));
    const bool has_torques = config.control.method != tracking::Method::kDrives;
    device = arguments.device;
    options =
        fmt::format("--joints {} --axes {} --rate-hz {:g}{}", config.model.n_m, config.model.n_p,
                    config.model.rate_Hz, has_torques ? " --interface torque" : "");
    names.emplace_back("example arm", config.name);
  }
  fs::create_directory(folder);
  for (const fs::directory_entry& entry : fs::directory_iterator(templates)) {
    if (!entry.is_regular_file()) continue;  // __pycache__, which pip writes
    std::string text = read_file(entry.path());
    for (const auto& [from, to] : names) text = replaced(text, from, to);
    write_output((folder / entry.path().filename()).string(), text);
  }
  const std::string start =
      arguments.language == "cpp"
          ? fmt::format(
                "cmake -S {0} -B {0}/build -DCMAKE_PREFIX_PATH=PREFIX && cmake --build "
                "{0}/build\n  {0}/build/{0} {1} 127.0.0.1:4810 --simulated",
                name, device)
          : fmt::format("python3 {}/driver.py --simulated {}", name, options);
  print_out(
      "{0}/ written: a stand-in that runs; put your robot into it (docs/start/own_driver.md). "
      "Next:\n"
      "  {1}\n"
      "  hapticgiant commission --device {2} --device-address 127.0.0.1:4810\n",
      name, start, device);
  return 0;
}

void add_new(Command app, int& exit_code) {
  const auto arguments = std::make_shared<NewArguments>();
  const Command command = app.add_subcommand(
      "new", "Write a first device.yaml or twin.yaml for a URDF, or a driver to fill in.");
  command.require_subcommand(1);
  command.footer(
      "Examples:\n"
      "  hapticgiant new device my_arm.urdf\n"
      "  hapticgiant new twin my_gate.urdf --device my_arm_device.yaml\n"
      "  hapticgiant new driver my_arm --device my_arm_device.yaml");
  const auto add = [&](const char* kind, const char* text, int (*run)(const NewArguments&)) {
    const Command what = command.add_subcommand(kind, text);
    what.add_option("urdf", arguments->part.urdf, "URDF of the robot or mechanism")
        .required()
        .existing_file()
        .check(no_urdf);
    what.add_option("--root-link", arguments->part.root_link,
                    "first link of the part that is taken");
    what.add_option("--tip-link", arguments->part.tip_link, "last link of the part that is taken");
    what.add_option("-o,--out,--output", arguments->output,
                    "file to write; default: URDF name + _device.yaml or _twin.yaml");
    what.add_flag("--force", arguments->may_overwrite, "overwrite the file");
    what.callback([arguments, &exit_code, run] { exit_code = run(*arguments); });
    return what;
  };
  add("device", "the robot whose handle is held", new_device)
      .add_option("--drives", arguments->drives,
                  "how its joints take commands, and how they are simulated: position, torque, or "
                  "ideal (positions, followed exactly)")
      .one_of({"position", "torque", "ideal"});
  add("twin", "the mechanism that is felt", new_twin)
      .add_option("--device", arguments->device,
                  "device.yaml that the twin is placed for, or the name of a shipped device (fr3)");
  const auto driver = std::make_shared<NewDriverArguments>();
  const Command what = command.add_subcommand(
      "driver", "a driver of your own machine, to fill in: docs/start/own_driver.md");
  what.add_option("name", driver->name, "of the driver, and of the folder that is written")
      .required();
  what.add_option("--language", driver->language,
                  "python: over the network, slow and quick to begin with; cpp: 1 kHz")
      .one_of({"python", "cpp"})
      .capture_default_str();
  what.add_option("--device", driver->device,
                  "device.yaml of the machine, or the name of a shipped device");
  what.callback([driver, &exit_code] { exit_code = new_driver(*driver); });
}

}  // namespace hg::apps
