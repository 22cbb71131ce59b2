#include "apps/hapticgiant/experiments/paper_experiment_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/docs_page.h"
#include "apps/hapticgiant/experiments/experiment_report.h"
#include "apps/hapticgiant/experiments/figure_program.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/version.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

// command that repeats the run
std::string command_of(const PaperExperimentArguments& arguments, std::string_view name) {
  std::string command = fmt::format("hapticgiant experiment {}", name);
  if (!arguments.law.empty()) command += " --law " + arguments.law;
  if (!arguments.bounds.empty()) command += " --bounds " + arguments.bounds;
  if (arguments.seed) command += fmt::format(" --seed {}", *arguments.seed);
  if (arguments.duration_s) command += fmt::format(" --duration {:g}", *arguments.duration_s);
  return command;
}

// progress shown on a terminal
SimulatedTime shown_progress(std::string_view name) {
  if (isatty(STDERR_FILENO) == 0) return [](double, double) {};
  return [name](double done_s, double total_s) {
    draw_error(
        fmt::format("{}: {:.0f} of {:.0f} s simulated", name, std::min(done_s, total_s), total_s));
  };
}

void clear_progress() {
  if (isatty(STDERR_FILENO) != 0) draw_error("");
}

void print_result(const ReportedRun& run) {
  for (const EventResult& event : run.result.events) {
    if (!event.found_s) continue;
    print_out(
        fmt::format("{:9.3f} s  {:<18} {}\n", *event.found_s, event.rule->name, event.rule->what));
  }
  for (const std::string& failure : run.result.failures) {
    print_out(fmt::format("  NOT AS EXPECTED: {}\n", failure));
  }
  if (run.result.failures.empty()) {
    print_out(fmt::format("  as expected: {} events, limits held\n", run.result.events.size()));
  }
}

// runs it, and writes what belongs to this one run into `folder`
ReportedRun make_run(const PaperExperiment& experiment, const PaperExperimentArguments& arguments,
                     const std::string& law, const fs::path& folder) {
  RunArguments run;
  run.world.scenario = experiment.scenario;
  run.world.seed = arguments.seed;
  run.world.law = law;
  run.world.bounds = arguments.bounds;
  run.duration_s = arguments.duration_s;
  run.is_fast = true;
  run.recordings = folder.string();
  make_folder(folder);
  ReportedRun made;
  made.result = run_experiment(experiment, run, shown_progress(experiment.name));
  clear_progress();
  made.law = made.result.summary["law"].get<std::string>();
  made.statements = measure(made.result);

  const auto write = [&](const char* name, const std::string& text) {
    write_output((folder / name).string(), text);
  };
  const ExperimentResult& result = made.result;
  write("events.json", events_json(made).dump(2) + "\n");
  write("results.json", results_json(made).dump(2) + "\n");
  write("timing.json", result.timing.dump(2) + "\n");
  write("signals.csv", result.table->to_csv(kFigurePeriod_s));
  write("run.json", figure_data(*result.scenario, *result.table, result.marks(),
                                std::string(experiment.name), run_note(result))
                            .dump(2) +
                        "\n");
  print_out(fmt::format("law {}\n", made.law));
  print_result(made);
  return made;
}

int exit_code(const std::vector<ReportedRun>& runs) {
  int code = 0;
  for (const ReportedRun& run : runs) {
    if (run.result.has_fault) return 3;
    if (!run.result.failures.empty()) code = 1;
  }
  return code;
}

int run_one(const PaperExperiment& experiment, const PaperExperimentArguments& arguments) {
  print_out(fmt::format("\n{} ({})\n", experiment.title, experiment.source));
  const fs::path folder = fs::path(arguments.out) / experiment.name;
  std::vector<ReportedRun> runs;
  std::vector<fs::path> folders;
  if (arguments.law == "both") {
    for (const char* law : {"gauss", "paper"}) folders.push_back(folder / law);
    runs.push_back(make_run(experiment, arguments, "gauss", folders[0]));
    runs.push_back(make_run(experiment, arguments, "paper", folders[1]));
  } else {
    folders.push_back(folder);
    runs.push_back(make_run(experiment, arguments, arguments.law, folder));
  }
  if (const std::string why = draw_figures(folder, folders); !why.empty()) {
    print_out("  " + why + "\n");
  }
  const std::string command = command_of(arguments, experiment.name);
  const fs::path report = folder / "report.html";
  write_output(report.string(), report_html(runs, folder, command));
  if (!arguments.docs.empty()) {
    refresh_page(arguments.docs, std::string(experiment.name), report_markdown(runs, command),
                 folder / "figure.svg");
  }
  print_out(fmt::format("report      {}\n", report.string()));
  return exit_code(runs);
}

}  // namespace

int run_paper_experiments(const PaperExperimentArguments& arguments,
                          const std::vector<std::string>& names) {
  print_out(
      fmt::format("HapticGiant {}  the paper's experiments, on a simulated machine\n", kVersion));
  int code = 0;
  for (const std::string& name : names) {
    code = std::max(code, run_one(paper_experiment(name), arguments));
  }
  return code;
}

}  // namespace hg::apps
