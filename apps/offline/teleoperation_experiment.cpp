#include "apps/offline/teleoperation_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/config/simulation/hand_schema.h"
#include "hg/config/simulation/teleoperation_schema.h"
#include "hg/core/enumerators.h"
#include "hg/core/interval.h"
#include "hg/teleoperation/grid.h"

namespace hg::apps {
namespace {

using teleoperation::GridCase;
using teleoperation::MethodKind;

struct TeleoperationArguments {
  bool is_full = false;
  std::vector<std::string> methods, hands;
  std::vector<double> delays_ms, jitters_ms, losses_percent, walls;
  std::uint64_t seed = 1;
  double press = teleoperation::Grid{}.press, hold = teleoperation::Grid{}.hold;
  std::string csv;  ///< file for all trials; empty = none
};

std::string row_of(const GridCase& one) {
  const teleoperation::TrialResult& result = one.result;
  return fmt::format(
      "{},{},{},{},{},{},{},{:.3f},{:.4f},{:.4f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f},{:.3f},{"
      ":.4f},{:.4f},{:.4f}\n",
      words_of(one.method), words_of(one.hand), 1e3 * one.delay, 1e3 * one.jitter, 100.0 * one.loss,
      one.wall, result.is_stable ? 1 : 0, 1e3 * result.vibration,
      1e3 * result.created / result.duration_s, 1e3 * result.created_leader / result.duration_s,
      result.peak_hand, one.peak_ratio, result.peak_wall, 1e3 * result.first_offset,
      1e3 * result.rest_offset, result.rest_force_error, 1e3 * result.position_rms,
      result.force_rms, result.regulation_rms, one.regulation_ratio());
}

constexpr const char* kHeader =
    "method,hand,delay_ms,jitter_ms,loss_percent,wall_N_per_m,is_calm,vibration_mm_per_s,"
    "created_mJ_per_s,created_leader_mJ_per_s,peak_hand_N,peak_ratio,peak_wall_N,first_offset_mm,"
    "rest_offset_mm,rest_force_error_N,position_rms_mm,force_rms_N,"
    "regulation_rms_N,regulation_ratio\n";

// The worst of the trials of a method with a delay.
struct Worst {
  int trials = 0, calm = 0;
  double created = 0.0, offset = 0.0, ratio = 0.0, force = 0.0, regulation = 0.0;

  void add(const GridCase& one) {
    const teleoperation::TrialResult& result = one.result;
    ++trials;
    calm += result.is_stable ? 1 : 0;
    created = std::max(created, 1e3 * result.created_leader / result.duration_s);
    offset = std::max(offset, 1e3 * result.rest_offset);
    ratio = std::max(ratio, one.peak_ratio);
    force = std::max(force, result.rest_force_error);
    regulation = std::max(regulation, result.regulation_rms);
  }
};

// Replaces values of the grid by those that are given; `scale` is the unit of the option.
void choose(const std::vector<double>& given, double scale, std::vector<double>& values) {
  if (given.empty()) return;
  values.clear();
  for (const double value : given) values.push_back(scale * value);
}
template <typename E>
void choose(const std::vector<std::string>& given, config::Choices<E> choices,
            std::vector<E>& values) {
  if (given.empty()) return;
  values.clear();
  for (const std::string& name : given) {
    values.push_back(std::ranges::find(choices, name, &config::Choice<E>::name)->value);
  }
}

teleoperation::Grid grid_of(const TeleoperationArguments& arguments) {
  teleoperation::Grid grid = arguments.is_full ? teleoperation::full_grid() : teleoperation::Grid{};
  grid.seed = arguments.seed;
  grid.press = arguments.press;
  grid.hold = arguments.hold;
  choose<MethodKind>(arguments.methods, config::kTeleoperationMethods, grid.methods);
  choose<person::HandPreset>(arguments.hands, config::kHandPresets, grid.hands);
  choose(arguments.delays_ms, 1e-3, grid.delays);
  choose(arguments.jitters_ms, 1e-3, grid.jitters);
  choose(arguments.losses_percent, 1e-2, grid.losses);
  choose(arguments.walls, 1.0, grid.walls);
  return grid;
}

int experiment_teleoperation(const TeleoperationArguments& arguments) {
  const teleoperation::Grid grid = grid_of(arguments);
  const std::size_t total = grid.methods.size() * grid.delays.size() * grid.jitters.size() *
                            grid.losses.size() * grid.walls.size() * grid.hands.size();
  const Progress progress = progress_of("trials");
  std::size_t done = 0;
  const std::vector<GridCase> cases = teleoperation::play_grid(grid, [&](const GridCase&) {
    if (progress) progress(++done, total);
  });
  std::map<std::pair<MethodKind, double>, Worst> worst;
  std::string csv = kHeader;
  std::pair unfelt = {kInfinity, 0.0};
  for (const GridCase& one : cases) {
    unfelt = {std::min(unfelt.first, one.unfelt_rms), std::max(unfelt.second, one.unfelt_rms)};
    worst[{one.method, one.delay}].add(one);
    csv += row_of(one);
  }
  if (!arguments.csv.empty()) write_output(arguments.csv, csv);
  print_out("{} trials; the worst of each method and delay, each way:\n\n", cases.size());
  print_out("{:20} {:>6} {:>9} {:>12} {:>10} {:>10} {:>10} {:>10}\n", "method", "delay", "calm",
            "gives", "apart", "force off", "peak", "holds");
  for (const auto& [key, value] : worst) {
    print_out(
        "{:20} {:3.0f} ms {:4} of {:3} {:7.2f} mJ/s {:7.1f} mm {:8.2f} N {:8.2f} x {:8.2f} N\n",
        words_of(key.first), 1e3 * key.second, value.calm, value.trials, value.created,
        value.offset, value.force, value.ratio, value.regulation);
  }
  print_out(
      "\ncalm: slower than 2 mm/s rms in the last second of both presses. gives: energy that the\n"
      "hand gets beyond what it gave. apart, force off: hand and remote machine, felt and "
      "measured\n"
      "force at rest. peak: largest force of the hand over that of position force without "
      "delay.\n"
      "holds: rms of the wall's force against the wanted one while the wall moves; of a hand that\n"
      "feels nothing {:.1f} to {:.1f} N.\n",
      unfelt.first, unfelt.second);
  return 0;
}

}  // namespace

void add_teleoperation(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<TeleoperationArguments>();
  const Command command = experiment.add_subcommand(
      "teleoperation", "methods of bilateral control, with delay, jitter and loss, at walls");
  command.add_flag("--full", arguments->is_full, "the whole grid, some minutes");
  const auto list = [&](const char* name, auto& values, const char* help) {
    return command.add_option(name, values, help).delimiter(',').allow_extra_args(false);
  };
  list("--methods", arguments->methods, "only these, separated by commas")
      .one_of(names_of(config::kTeleoperationMethods));
  list("--hands", arguments->hands, "only these, separated by commas")
      .one_of(names_of(config::kHandPresets));
  const OptionCheck time = number_within(0.0, 1e4);
  list("--delays", arguments->delays_ms, "each way, ms").check(time);
  list("--jitters", arguments->jitters_ms, "largest further delay, ms").check(time);
  list("--losses", arguments->losses_percent, "lost packets, percent")
      .check(number_within(0.0, 100.0));
  list("--walls", arguments->walls, "stiffness, N/m").check(number_within(1.0, 1e5));
  command.add_option("--press", arguments->press, "force of the hand at rest, N")
      .check(number_within(0.1, 1e3))
      .capture_default_str();
  command.add_option("--hold", arguments->hold, "time of each press, s")
      .check(number_within(1.0, 600.0))
      .capture_default_str();
  command.add_option("--seed", arguments->seed, "of jitter and loss").capture_default_str();
  command.add_option("--csv", arguments->csv, "write all trials to this file");
  command.callback([arguments, &exit_code] { exit_code = experiment_teleoperation(*arguments); });
}

}  // namespace hg::apps
