#include "apps/hapticgiant/check_command.h"

#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/check_report.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "hg/check/capability_map.h"
#include "hg/core/error.h"

namespace hg::apps {

int run_check(const CheckArguments& arguments) {
  check_writable(arguments.json, kJson);
  check_writable(arguments.map, kSvg);
  const check::CheckReport report = check::check_files(arguments.files);
  print(report);
  const int code = count(report, check::Severity::kFault) > 0 ? 2 : 0;
  if (!arguments.json.empty()) write_output(arguments.json, to_json(report));
  if (!arguments.map.empty()) {
    if (!report.first_device) throw SetupError("--map: needs a device that could be read");
    return become_reports({{.results = check::capability_map(*report.first_device),
                            .files = {{"map.svg", arguments.map}},
                            .exit_code = code}});
  }
  return code;
}

void add_check(Command app, int& exit_code) {
  const auto arguments = std::make_shared<CheckArguments>();
  const Command command = app.add_subcommand(
      "check", "What is wrong with configuration files, and how to fix it; datasheet of a device.");
  command.footer(
      "Examples:\n"
      "  hapticgiant check models/scenarios/door.yaml\n"
      "  hapticgiant check my_device.yaml my_twin.yaml   each, and whether they fit together\n"
      "  hapticgiant check models/haptic_giant/device.yaml --map capability.svg");
  command
      .add_option("files", arguments->files,
                  "device, twin, scenario, tool or script files; the kind follows from their keys")
      .required();
  command.add_option("--json", arguments->json,
                     "write findings and datasheets as JSON to this file");
  command.add_option("--map", arguments->map,
                     "draw the force over the workspace of the first device to this SVG file");
  command.callback([arguments, &exit_code] { exit_code = run_check(*arguments); });
}

}  // namespace hg::apps
