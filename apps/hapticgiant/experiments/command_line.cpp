#include "apps/hapticgiant/experiments/command_line.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "apps/hapticgiant/experiments/compare_command.h"
#include "apps/hapticgiant/experiments/paper_experiment_command.h"
#include "apps/hapticgiant/experiments/paper_experiments.h"
#include "apps/hapticgiant/experiments/plot_command.h"
#include "apps/hapticgiant/option_checks.h"

namespace hg::apps {
namespace {

void add_options(CLI::App& command, PaperExperimentArguments& arguments) {
  command.add_option("--law", arguments.law, "gauss, paper or both; default: the device's")
      ->check(CLI::IsMember({"gauss", "paper", "both"}));
  command.add_option("--bounds", arguments.bounds, "recoverable or paper; default: the device's")
      ->check(CLI::IsMember({"recoverable", "paper"}));
  command
      .add_option("--seed", arguments.seed, "of noise and tremor: the same seed, the same files")
      ->check(whole_number(0.0));
  command.add_option("--out", arguments.out, "folder; one per experiment is made in it")
      ->capture_default_str();
  command
      .add_option("--duration", arguments.duration_s,
                  "seconds, to cut it short; default: until the script has played")
      ->check(number_that("more than 0", [](double value) { return value > 0.0; }));
  command.add_option("--docs", arguments.docs,
                     "refresh the figures in the pages of this folder (make experiments)");
}

}  // namespace

void add_paper_experiments(CLI::App& experiment, int& exit_code) {
  const auto arguments = std::make_shared<PaperExperimentArguments>();
  std::vector<std::string> all;
  const auto add = [&](const std::string& name, const std::string& text,
                       const std::vector<std::string>& names) {
    CLI::App* command = experiment.add_subcommand(name, text);
    add_options(*command, *arguments);
    command->callback(
        [arguments, &exit_code, names] { exit_code = run_paper_experiments(*arguments, names); });
  };
  for (const PaperExperiment& each : paper_experiments()) {
    const std::string name(each.name);
    add(name, std::string(each.title) + " of the paper, " + std::string(each.source), {name});
    all.push_back(name);
  }
  add("all", "these four, one after the other", all);
  CLI::App* timing = experiment.add_subcommand(
      "timing", "computing time of a cycle beside the paper's, section VII-A; minutes");
  add_options(*timing, *arguments);
  timing->add_option("--rates", arguments->rates_Hz, "control rates, Hz")
      ->delimiter(',')
      ->capture_default_str();
  timing->callback([arguments, &exit_code] { exit_code = timing_experiment(*arguments); });
}

void add_plot_and_compare(CLI::App& app, int& exit_code) {
  const auto plotted = std::make_shared<PlotArguments>();
  CLI::App* plot = app.add_subcommand("plot", "Figures of recordings, several over each other.");
  plot->footer(
      "Examples:\n"
      "  hapticgiant plot recordings/latest.mcap\n"
      "  hapticgiant plot one.mcap two.mcap --out figures");
  plot->add_option("files", plotted->files, "recordings, one to four")
      ->required()
      ->expected(1, 4)
      ->check(CLI::ExistingFile);
  plot->add_option("--out", plotted->out, "folder for figure.svg, figure.png and signals")
      ->capture_default_str();
  plot->callback([plotted, &exit_code] { exit_code = hg::apps::plot(*plotted); });

  const auto compared = std::make_shared<CompareArguments>();
  CLI::App* compare = app.add_subcommand(
      "compare", "Tells what is different in two recordings: events, forces, limits, timing.");
  compare->footer("Example:\n  hapticgiant compare before.mcap after.mcap");
  compare->add_option("a", compared->a, "recording")->required()->check(CLI::ExistingFile);
  compare->add_option("b", compared->b, "recording")->required()->check(CLI::ExistingFile);
  compare->callback([compared, &exit_code] { exit_code = hg::apps::compare(*compared); });
}

}  // namespace hg::apps
