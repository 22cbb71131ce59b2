#include "apps/offline/remote_experiment.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/config/shipped_files.h"
#include "hg/config/simulation/scenario.h"
#include "hg/experiments/remote_operation.h"

namespace hg::apps {
namespace {

struct RemoteArguments {
  std::vector<std::string> scenarios = {"fr3/remote", "ur5e/remote", "xarm7/remote"};
  experiments::RemoteOperation operation;
  int count = 4;
  std::uint64_t seed = 1;
};

int experiment_remote(const RemoteArguments& arguments) {
  print_out("{:14} {:>9} {:>6} {:>6} {:>6} {:>10} {:>10} {:>11} {:>10} {:>10} {:>9}\n", "arm",
            "coupled", "stops", "faults", "ends", "too early", "too late", "arm beyond",
            "arm speed", "arm behind", "held back");
  bool is_all_good = true;
  for (const std::string& name : arguments.scenarios) {
    const config::Scenario scenario = config::load_scenario(config::find_scenario(name));
    experiments::RemoteOperationFigures all;
    for (const experiments::RemoteOperationFigures& run :
         experiments::operate_at_random(scenario, arguments.operation, arguments.seed,
                                        arguments.count, progress_of(name.c_str()))) {
      all.add(run);
    }
    is_all_good = is_all_good && is_good(all);
    print_out(
        "{:14} {:7.0f} s {:6} {:6} {:6} {:7.2f} mm {:7.2f} mm {:6.2f} mrad {:4.2f} rad/s {:5.1f} "
        "mrad {:7.2f} s\n",
        name, all.engaged_s, all.stops, all.faults, all.ends, 1e3 * all.felt_early,
        1e3 * all.felt_late, 1e3 * all.arm_beyond, all.arm_speed, 1e3 * all.largest_lag,
        all.held_back_s);
    for (const std::string& text : all.notes) print_out("  {}\n", text);
  }
  print_out(
      "\nstops: times that the arm held, also by a protective stop. ends: times that a hand "
      "pressed an\n"
      "end of a joint with more than 3 N, at rest; too early, too late: way of the tool from "
      "where\n"
      "it was felt to the arm's end. held back: time in which the arm's own limits slowed it.\n");
  return is_all_good ? 0 : 1;
}

}  // namespace

void add_remote_operation(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<RemoteArguments>();
  const Command command = experiment.add_subcommand(
      "remote", "random operation of arms far away, whose models are the twin");
  command.add_option("scenarios", arguments->scenarios, "teleoperations that lead joints");
  command.add_option("--count", arguments->count, "runs of each, each with a hand of its own")
      .check(whole_number(1.0, 1e5))
      .capture_default_str();
  command.add_option("--duration", arguments->operation.duration_s, "of each run, s")
      .check(number_within(2.0, 3600.0))
      .capture_default_str();
  command.add_option("--force", arguments->operation.force, "largest pull of a hand, N")
      .check(number_within(1.0, 500.0))
      .capture_default_str();
  command.add_option("--seed", arguments->seed, "of the first run").capture_default_str();
  command.callback([arguments, &exit_code] { exit_code = experiment_remote(*arguments); });
}

}  // namespace hg::apps
