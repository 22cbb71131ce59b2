#include "apps/offline/hands_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/whole_file.h"
#include "hg/experiments/hand_search.h"

namespace hg::apps {
namespace {

struct HandsArguments {
  experiments::HandSearch search;
  std::string folder = "hands";
  int shown = 10;
};

int experiment_hands(HandsArguments arguments) {
  experiments::HandSearch& search = arguments.search;
  search.folder = arguments.folder;
  check_report_program();  // before minutes of runs
  make_folder(arguments.folder);
  print_out(fmt::format("HapticGiant {}  {} hands of up to {:g} N, seed {}\n\n", kVersion,
                        search.count, search.force, search.seed));
  const std::vector<experiments::TriedHand> tried =
      experiments::search_hands(search, progress_of("hands"));
  const auto held = std::ranges::count_if(
      tried, [](const experiments::TriedHand& hand) { return hand.run.has_held; });
  const std::size_t shown =
      std::min(tried.size(), static_cast<std::size_t>(std::max(arguments.shown, 1)));
  std::vector<experiments::Trial> trials;
  std::vector<experiments::SeededRun> runs;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    if (i >= shown) {
      remove_files(search, tried[i]);
      continue;
    }
    trials.push_back({.name = tried[i].name, .hand = "", .scenario = tried[i].scenario});
    runs.push_back(tried[i].run);
    runs.back().trial = i;
  }
  print_out(
      fmt::format("{} of {} hands: no fault, and no limit left. The worst {}, kept in {}:\n\n",
                  held, tried.size(), shown, search.folder.string()));
  nlohmann::ordered_json results = experiments::to_json(trials, runs);
  results["kind"] = "seeds";
  return become_reports(
      {{.results = results, .kept = search.folder.string() + " has the hands\n"}});
}

}  // namespace

void add_hands(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<HandsArguments>();
  experiments::HandSearch& search = arguments->search;
  search.world.scenario = "free_space";
  const Command command = experiment.add_subcommand(
      "hands", "looks for hands that bring the device out of its limits, and keeps the worst");
  command.add_option("scenario", search.world.scenario, "gives device and twin: a file or a name")
      .capture_default_str();
  command.add_option("--count", search.count, "hands; half of them are variations of the worst")
      .check(whole_number(1.0, 1e5))
      .capture_default_str();
  command.add_option("--force", search.force, "largest pull of a hand, N")
      .check(number_within(1.0, 500.0))
      .capture_default_str();
  command.add_option("--seed", search.seed, "of the hands").capture_default_str();
  command.add_option("--show", arguments->shown, "worst hands that are kept and shown")
      .check(whole_number(1.0, 1e5))
      .capture_default_str();
  command.add_option("-o,--out", arguments->folder, "folder of their scenarios")
      .capture_default_str();
  add_law_option(command, search.world.law);
  command.callback([arguments, &exit_code] { exit_code = experiment_hands(*arguments); });
}

}  // namespace hg::apps
