#include "hg/experiments/seed_ranges.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hg/analysis/summary.h"
#include "hg/experiments/player.h"
#include "hg/scenario/assembly.h"

namespace hg::experiments {
namespace {

constexpr double kLongestStop = 3.0;  // s; the monitor ends one that lasts longer

SeededRun play(const Trial& trial, std::uint64_t seed) {
  config::Scenario scenario = trial.scenario;
  set_seed(scenario, seed);
  Player player(scenario);
  analysis::Summary summary = scenario::make_summary(scenario);
  analysis::EventDetector detector(scenario.events, scenario.limits);
  const auto advance = [&] {
    player.begin();
    player.run();
    summary.add(player.sample());
    (void)detector.observe(player.record());
    return player.end();
  };
  while (advance()) {
  }
  if (player.record().fault.code == FaultCode::kNone) {  // it ends with an ordinary stop
    const double end_s = player.record().time_s + kLongestStop;
    player.stop();
    while (player.record().time_s < end_s && advance()) {
    }
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

nlohmann::ordered_json to_json(const std::vector<Trial>& trials,
                               const std::vector<SeededRun>& runs) {
  nlohmann::ordered_json json = {{"held", have_all_held(runs)}};
  for (const SeededRun& run : runs) {
    const Trial& trial = trials[run.trial];
    const auto excess = [](const WorstLimit& worst) {
      return nlohmann::ordered_json{{"excess", worst.excess}, {"limit", worst.name}};
    };
    json["runs"].push_back({{"trial", run.trial},
                            {"scenario", trial.name},
                            {"hand", trial.hand},
                            {"seed", run.seed},
                            {"held", run.has_held},
                            {"fault", static_cast<int>(run.fault.code)},
                            {"fault_text", to_string(run.fault.code)},
                            {"ended_s", run.ended_s},
                            {"expected_events", trial.scenario.events.size()},
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

}  // namespace hg::experiments
