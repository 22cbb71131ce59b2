/// The program `hapticgiant`: parses the command line and hands over to one subcommand.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <string>

#include "apps/hapticgiant/hqp_solve.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"

namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

// ranges let "nan" through
std::string finite_number(const std::string& text) {
  double value = 0.0;
  const bool is_finite = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
  return is_finite ? "" : "expected a number, got '" + text + "'";
}

void add_run(CLI::App& app, hg::apps::RunArguments& run) {
  CLI::App* command =
      app.add_subcommand("run", "A person at the device feels the twin (the main job).");
  command->footer(
      "Examples:\n"
      "  hapticgiant run                          the door, scripted hand, page in the browser\n"
      "  hapticgiant run excavator --fast --summary out.json\n"
      "  hapticgiant run door --user mouse        drag the handle in the page");
  command->add_option("scenario", run.scenario, "scenario file, or door, excavator, free_space")
      ->capture_default_str();
  command->add_option("--device", run.device, "device.yaml instead of the scenario's");
  command->add_option("--twin", run.twin, "twin.yaml instead of the scenario's");
  command->add_option("--user", run.user, "script file, mouse or none");
  command->add_option("--duration", run.duration_s, "seconds; default: until the script has played")
      ->check(finite_number)
      ->check(CLI::PositiveNumber);
  command->add_flag("--fast", run.is_fast, "as fast as it can instead of in real time");
  command->add_option("--rate-hz", run.rate_Hz, "control rate, 100..20000; default: the device's")
      ->check(finite_number)
      ->check(CLI::Range(100.0, 20000.0));
  command->add_option("--summary", run.summary, "write the closing summary as JSON to this file");
  command->add_flag("!--no-viewer", run.has_viewer, "without the page");
  command->add_option("--port", run.port, "port of the page; default: any free one");
  command->add_option("--recordings", run.recordings, "folder of the recordings")
      ->capture_default_str();
  command->add_flag("!--no-recording", run.has_recording, "without a recording");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("HapticGiant: feel the digital twin of any serial chain.", "hapticgiant");
  app.set_version_flag("--version", hg::apps::kVersion);
  app.require_subcommand(1);

  hg::apps::RunArguments run;
  add_run(app, run);
  CLI::App* hqp = app.add_subcommand("hqp", "The lexicographic QP solver on its own.");
  hqp->require_subcommand(1);
  std::string problem_file;
  bool has_timing = false;
  CLI::App* solve = hqp->add_subcommand("solve", "Solve the problems of a file (plain or .gz).");
  solve->footer("Example:\n  hapticgiant hqp solve tests/reference/exc_two.hqp.gz --timing");
  solve->add_option("file", problem_file, "problem file, format in docs/hqp.md")->required();
  solve->add_flag("--timing", has_timing, "microseconds, cold and warm");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadInput;
  }
  try {
    if (app.got_subcommand("run")) return hg::apps::run(run);
    return hg::apps::run_hqp_solve(problem_file, has_timing);
  } catch (const hg::SetupError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
    return kInternalError;
  }
}
