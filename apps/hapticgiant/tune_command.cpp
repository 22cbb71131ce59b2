#include "apps/hapticgiant/tune_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "apps/hapticgiant/experiments/figure_program.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/tune_report.h"
#include "apps/hapticgiant/version.h"
#include "hg/config/device.h"
#include "hg/scenario/assembly.h"
#include "hg/studies/tuning/tuned_device.h"

namespace hg::apps {
namespace {

tuning::TuningProblem problem_of(const config::Device& device, const TuneArguments& arguments) {
  return {.device = tuning::device_of(device),
          .noise = tuning::noise_of(device),
          .plant = tuning::simulated(device),
          .friction = tuning::unexpected_friction(device),
          .body = {.mass = arguments.mass, .damping = arguments.damping},
          .postures = scenario::random_postures(device.model, arguments.postures, arguments.seed)};
}

std::string command_of(const TuneArguments& arguments) {
  std::string command = fmt::format("hapticgiant tune {}", arguments.device);
  const TuneArguments usual;
  if (arguments.vibration > 0.0) command += fmt::format(" --vibration {:g}", arguments.vibration);
  if (arguments.mass != usual.mass) command += fmt::format(" --mass {:g}", arguments.mass);
  if (arguments.damping != usual.damping) {
    command += fmt::format(" --damping {:g}", arguments.damping);
  }
  if (arguments.postures != usual.postures) {
    command += fmt::format(" --postures {}", arguments.postures);
  }
  if (arguments.seed != usual.seed) command += fmt::format(" --seed {}", arguments.seed);
  return command + (arguments.has_front ? " --front" : "");
}

}  // namespace

int run_tune(const TuneArguments& arguments) {
  const config::Device device = config::load_device(find_device(arguments.device));
  tuning::TuningProblem problem = problem_of(device, arguments);
  const tuning::Figures now = tuning::figures_of(problem, problem.device);
  problem.friction_most_N = now.friction_N;
  if (!arguments.only_checks) make_folder(arguments.out);
  print_out("HapticGiant {}  {} {}: {} numbers, {} postures, a body of {:g} kg and {:g} Ns/m\n\n",
            kVersion, arguments.only_checks ? "checks" : "tunes", device.name,
            tuning::knobs().size(), problem.postures.size(), arguments.mass, arguments.damping);
  const double limit = arguments.vibration > 0.0 ? arguments.vibration : now.vibration;
  std::vector<double> limits;
  if (!arguments.only_checks) limits.push_back(limit);
  if (arguments.has_front) {
    for (const double share : {0.75, 0.5, 1.5, 2.0}) limits.push_back(share * limit);
  }
  const tuning::TuningResult result = tuning::search(
      problem, limits, [](const std::string& what, std::size_t done, std::size_t total) {
        if (const auto tell = progress_of(what)) tell(done, total);
      });
  const TuneReport report = {.problem = problem,
                             .result = result,
                             .demands = tuning::demands_of(problem),
                             .name = device.name,
                             .command = command_of(arguments)};

  if (arguments.only_checks) {
    print_out(tune_check_text(report));
    return result.proof_before.holds() ? 0 : 1;
  }
  print_out(tune_text(report));
  print_out(fmt::format("\nfor device.yaml:\n{}", tune_yaml(report)));
  const std::filesystem::path folder = arguments.out;
  const auto write = [&](const char* name, const std::string& text) {
    write_output((folder / name).string(), text);
  };
  write("report.md", tune_markdown(report));
  write("front.csv", tune_csv(report));
  write("run.json", tune_figure(report));
  if (const std::string why = draw_figures(folder, {folder}); !why.empty()) {
    print_error("{}\n", why);
  }
  print_out(fmt::format("\nreport      {}\n", (folder / "report.md").string()));
  const tuning::Figures& found = result.front.front().figures;
  constexpr double kTolerated = 1.01;  // of limits that the search approaches from both sides
  if (!result.proofs.front().holds()) {
    print_error(
        "not proven: do not use these lines; more vibration (--vibration) leaves more room\n");
    return 1;
  }
  if (found.vibration > kTolerated * limit ||
      found.friction_N > kTolerated * problem.friction_most_N) {
    print_error(
        "missed: vibration {:.4f} m/s^2, at most {:.4f}; unexpected friction {:.3f} N, at most "
        "{:.3f}\n",
        found.vibration, limit, found.friction_N, problem.friction_most_N);
    return 1;
  }
  return 0;
}

}  // namespace hg::apps
