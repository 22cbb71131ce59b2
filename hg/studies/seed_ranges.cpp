#include "hg/studies/seed_ranges.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "hg/analysis/summary.h"
#include "hg/scenario/assembly.h"
#include "hg/studies/player.h"

namespace hg::studies {
namespace {

SeededRun play(const Trial& trial, std::uint64_t seed) {
  config::Scenario scenario = trial.scenario;
  set_seed(scenario, seed);
  Player player(scenario);
  analysis::Summary summary = scenario::make_summary(scenario);
  analysis::EventDetector detector(scenario.events, scenario.limits);
  for (bool goes_on = true; goes_on; goes_on = player.end()) {
    player.begin();
    player.run();
    summary.add(player.judged_sample());
    (void)detector.observe(player.record());
  }
  const analysis::TruthSummary& truth = summary.truth();
  SeededRun run = {.seed = seed,
                   .fault = summary.fault(),
                   .ended_s = player.record().time_s,
                   .missing = detector.missing().size(),
                   .joint_error = truth.max_joint_error(),
                   .handle_distance = truth.max_hand_distance(),
                   .mean_force = truth.mean_force(),
                   .vibration = truth.vibration()};
  run.has_held = run.fault.code == FaultCode::kNone && summary.limits_held();
  if (truth.max_torque_share().size() > 0) {
    run.torque_share = truth.max_torque_share().maxCoeff();
  }
  for (std::size_t i = 0; i < truth.worst_excess().size(); ++i) {
    const LimitInfo& limit = scenario.limits[i];
    WorstLimit& worst = limit.is_angle ? run.angle : run.length;
    if (truth.worst_excess()[i] > worst.excess) worst = {truth.worst_excess()[i], limit.name};
  }
  return run;
}

// Median and worst of a value over the runs of a trial, in `per` of its unit.
template <typename F>
std::string range_of(const std::vector<const SeededRun*>& runs, int digits, double per, F&& value) {
  std::vector<double> values;
  for (const SeededRun* run : runs) values.push_back(per * value(*run));
  std::ranges::sort(values);
  return fmt::format("{:.{}f} / {:.{}f}", values[values.size() / 2], digits, values.back(), digits);
}

const SeededRun& worst_of(const std::vector<const SeededRun*>& runs, WorstLimit SeededRun::*limit) {
  return **std::ranges::max_element(runs, {},
                                    [&](const SeededRun* run) { return (run->*limit).excess; });
}

using Cells = std::array<std::string, 12>;

const Cells kHead = {"scenario",     "hand",      "held",       "events",
                     "outside mrad", "worst at",  "outside mm", "worst at",
                     "joints mrad",  "handle mm", "torque %",   "vibration m/s^2"};

std::vector<const SeededRun*> of_trial(const std::vector<SeededRun>& runs, std::size_t trial) {
  std::vector<const SeededRun*> found;
  for (const SeededRun& run : runs) {
    if (run.trial == trial) found.push_back(&run);
  }
  return found;
}

Cells cells_of(const Trial& trial, const std::vector<const SeededRun*>& runs) {
  const auto held = std::ranges::count_if(runs, [](const auto* run) { return run->has_held; });
  const auto complete =
      std::ranges::count_if(runs, [](const auto* run) { return run->missing == 0; });
  const auto share = [&](auto count) { return fmt::format("{} of {}", count, runs.size()); };
  const auto name = [&](WorstLimit SeededRun::*limit) {
    const std::string& text = (worst_of(runs, limit).*limit).name;
    return text.empty() ? "-" : text;
  };
  return {trial.name,
          trial.hand.empty() ? "its own" : trial.hand,
          share(held),
          trial.scenario.events.empty() ? "-" : share(complete),
          range_of(runs, 2, 1e3, [](const SeededRun& r) { return r.angle.excess; }),
          name(&SeededRun::angle),
          range_of(runs, 2, 1e3, [](const SeededRun& r) { return r.length.excess; }),
          name(&SeededRun::length),
          range_of(runs, 2, 1e3, [](const SeededRun& r) { return r.joint_error; }),
          range_of(runs, 2, 1e3, [](const SeededRun& r) { return r.handle_distance; }),
          range_of(runs, 0, 100.0, [](const SeededRun& r) { return r.torque_share; }),
          range_of(runs, 3, 1.0, [](const SeededRun& r) { return r.vibration; })};
}

std::vector<Cells> table_of(const std::vector<Trial>& trials, const std::vector<SeededRun>& runs) {
  std::vector<Cells> table = {kHead};
  for (std::size_t i = 0; i < trials.size(); ++i) {
    table.push_back(cells_of(trials[i], of_trial(runs, i)));
  }
  return table;
}

// "- free_space, stiff hand: 111 joint torque exceeded at 12.3 s (seed 4) and in 2 more"
std::string faults_of(const std::vector<Trial>& trials, const std::vector<SeededRun>& runs) {
  std::string text;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    std::map<FaultCode, std::vector<const SeededRun*>> by_code;
    for (const SeededRun* run : of_trial(runs, i)) {
      if (run->fault.code != FaultCode::kNone) by_code[run->fault.code].push_back(run);
    }
    for (const auto& [code, found] : by_code) {
      const std::string hand = trials[i].hand.empty() ? "its own" : trials[i].hand;
      text += fmt::format("- {}, {} hand: {} {} in {} runs, first at {:.2f} s with seed {}\n",
                          trials[i].name, hand, static_cast<int>(code), to_string(code),
                          found.size(), found.front()->ended_s, found.front()->seed);
    }
  }
  return text;
}

}  // namespace

std::vector<SeededRun> play_seeds(const std::vector<Trial>& trials, std::uint64_t first, int count,
                                  const Progress& progress) {
  const auto seeds = static_cast<std::size_t>(count);
  std::vector<SeededRun> runs(trials.size() * seeds);
  do_all(
      runs.size(),
      [&](std::size_t i) {
        runs[i] = play(trials[i / seeds], first + i % seeds);
        runs[i].trial = i / seeds;
      },
      progress);
  return runs;
}

bool have_all_held(const std::vector<SeededRun>& runs) {
  return std::ranges::all_of(runs, &SeededRun::has_held);
}

std::string to_text(const std::vector<Trial>& trials, const std::vector<SeededRun>& runs) {
  const std::vector<Cells> table = table_of(trials, runs);
  std::array<std::size_t, std::tuple_size_v<Cells>> width{};
  for (const Cells& cells : table) {
    for (std::size_t i = 0; i < cells.size(); ++i) width[i] = std::max(width[i], cells[i].size());
  }
  std::string text;
  for (const Cells& cells : table) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += fmt::format("{:<{}}{}", cells[i], width[i], i + 1 < cells.size() ? "  " : "\n");
    }
  }
  return text + "\nmedian / worst over the seeds; held: no fault, and no limit left by more than " +
         "2 mrad or 1 mm in truth\n" + faults_of(trials, runs);
}

std::string to_markdown(const std::vector<Trial>& trials, const std::vector<SeededRun>& runs) {
  std::string text = "# What scenarios show over seeds\n\n";
  bool is_head = true;
  for (const Cells& cells : table_of(trials, runs)) {
    text += fmt::format("| {} |\n", fmt::join(cells, " | "));
    if (!is_head) continue;
    is_head = false;
    for (std::size_t i = 0; i < cells.size(); ++i) text += "| --- ";
    text += "|\n";
  }
  const std::string faults = faults_of(trials, runs);
  return faults.empty() ? text : text + "\n" + faults;
}

nlohmann::ordered_json to_json(const std::vector<Trial>& trials,
                               const std::vector<SeededRun>& runs) {
  nlohmann::ordered_json json = {{"held", have_all_held(runs)}};
  for (const SeededRun& run : runs) {
    const Trial& trial = trials[run.trial];
    const auto excess = [](const WorstLimit& worst) {
      return nlohmann::ordered_json{{"excess", worst.excess}, {"limit", worst.name}};
    };
    json["runs"].push_back({{"scenario", trial.name},
                            {"hand", trial.hand},
                            {"seed", run.seed},
                            {"held", run.has_held},
                            {"fault", static_cast<int>(run.fault.code)},
                            {"ended_s", run.ended_s},
                            {"missing_events", run.missing},
                            {"angle_rad", excess(run.angle)},
                            {"length_m", excess(run.length)},
                            {"joint_error_rad", run.joint_error},
                            {"handle_distance_m", run.handle_distance},
                            {"torque_share", run.torque_share},
                            {"mean_force_N", run.mean_force},
                            {"vibration_m_per_s2", run.vibration}});
  }
  return json;
}

}  // namespace hg::studies
