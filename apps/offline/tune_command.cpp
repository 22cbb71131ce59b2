#include "apps/offline/tune_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/subcommand.h"
#include "apps/offline/tune_report.h"
#include "hg/config/device.h"
#include "hg/config/shipped_files.h"
#include "hg/config/torque_loop.h"
#include "hg/scenario/assembly.h"
#include "hg/tune/tuned_device.h"

namespace hg::apps {
namespace {

tune::TuningProblem problem_of(const config::SimulatedDeviceConfig& device,
                               const TuneArguments& arguments) {
  return {.device = tune::device_of(device),
          .noise = tune::noise_of(device),
          .plant = tune::simulated(device),
          .friction = tune::unexpected_friction(device),
          .body = {.mass = arguments.mass},
          .postures = config::random_postures(device.model, arguments.postures, arguments.seed)};
}

std::string command_of(const TuneArguments& arguments) {
  std::string command = fmt::format("hapticgiant tune {}", arguments.device);
  const TuneArguments usual;
  if (arguments.vibration > 0.0) command += fmt::format(" --vibration {:g}", arguments.vibration);
  if (arguments.mass != usual.mass) command += fmt::format(" --mass {:g}", arguments.mass);
  if (arguments.postures != usual.postures) {
    command += fmt::format(" --postures {}", arguments.postures);
  }
  if (arguments.seed != usual.seed) command += fmt::format(" --seed {}", arguments.seed);
  return command + (arguments.has_front ? " --front" : "");
}

}  // namespace

int run_tune(const TuneArguments& arguments) {
  const config::SimulatedDeviceConfig device =
      config::load_simulated_device(config::find_device(arguments.device, {}));
  tune::TuningProblem problem = problem_of(device, arguments);
  const tune::Figures now = tune::figures_of(problem, problem.device);
  problem.friction_most_N = now.friction_N;
  check_report_program();  // before minutes of search
  if (!arguments.only_checks) make_folder(arguments.out);
  print_out("HapticGiant {}  {} {}: {} numbers, {} postures, a body of {:g} kg and {:g} Ns/m\n\n",
            kVersion, arguments.only_checks ? "checks" : "tunes", device.name, tune::knobs().size(),
            problem.postures.size(), arguments.mass, problem.body.damping);
  const double limit = arguments.vibration > 0.0 ? arguments.vibration : now.vibration;
  std::vector<double> limits;
  if (!arguments.only_checks) limits.push_back(limit);
  if (arguments.has_front) {
    for (const double share : {0.75, 0.5, 1.5, 2.0}) limits.push_back(share * limit);
  }
  const tune::TuningResult result = tune::search(
      problem, limits, [](const std::string& what, std::size_t done, std::size_t total) {
        if (const auto report = progress_of(what)) report(done, total);
      });
  const TuneReport report = {.problem = problem,
                             .result = result,
                             .demands = tune::demands_of(problem),
                             .name = device.name,
                             .command = command_of(arguments)};

  const nlohmann::ordered_json results = tune_json(report);
  if (arguments.only_checks) return become_reports({{.results = results}});
  const std::filesystem::path folder = arguments.out;
  write_output((folder / "results.json").string(),
               results.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return become_reports(
      {{.results = results,
        .folder = folder.string(),
        .last_line = fmt::format("\nreport      {}\n", (folder / "report.md").string()),
        .kept = (folder / "results.json").string() + " has the results\n"}});
}

void add_tune(Command app, int& exit_code) {
  const auto arguments = std::make_shared<TuneArguments>();
  const Command command = add_offline(app, "tune");
  command.footer(
      "Examples:\n"
      "  hapticgiant tune models/haptic_giant/device.yaml         report in tune/report.md\n"
      "  hapticgiant tune device.yaml --vibration 0.03 --front    less vibration, and the trade\n"
      "  hapticgiant tune device.yaml --check                     the proof of what is there");
  command.add_option("device", arguments->device, "device.yaml").capture_default_str();
  command.add_option("-o,--out", arguments->out, "folder of the report").capture_default_str();
  command
      .add_option("--vibration", arguments->vibration,
                  "largest above 20 Hz, m/s^2; without: what the device has now")
      .check(number_within(1e-4, 10.0));
  command.add_option("--mass", arguments->mass, "of the body that is rendered, kg")
      .check(number_within(0.1, 100.0))
      .capture_default_str();
  command.add_option("--postures", arguments->postures, "in which it must hold")
      .check(whole_number(1.0, 1000.0))
      .capture_default_str();
  command.add_option("--seed", arguments->seed, "of the postures")
      .check(whole_number(0.0, 4294967295.0))
      .capture_default_str();
  const Option front =
      command.add_flag("--front", arguments->has_front, "also for less and for more vibration");
  command
      .add_flag("--check", arguments->only_checks,
                "figures and proof of what the device has now; searches and writes nothing")
      .excludes(front);
  command.callback([arguments, &exit_code] { exit_code = run_tune(*arguments); });
}

}  // namespace hg::apps
