#include "bench/law_table.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bench/player.h"
#include "bench/stop_watch.h"

namespace hg::bench {
namespace {

// Looks at every cycle of one play.
class Observer {
 public:
  Observer(const std::string& name, const config::Scenario& scenario)
      : scenario_(scenario), detector_(scenario.events, scenario.limits) {
    run_.scenario = name;
    run_.law = rendering::to_string(scenario.device.rendering.law);
    run_.bounds = rendering::to_string(scenario.device.rendering.bounds);
  }

  LawRun play() {
    Player player(scenario_);
    StopWatch watch;
    bool has_more = true;
    while (has_more) {
      player.begin();
      const Clock::time_point begin = Clock::now();
      watch.run(player);
      const double cycle_us = microseconds_since(begin);
      has_more = player.end();
      if (detector_.observe(player.record())) ++run_.events;
      if (!player.is_running()) continue;
      run_.cycle.add(run_.cycle.count(), cycle_us);
      run_.solver.add(run_.solver.count(), watch.us(Stage::kSolver));
      add(player.record());
    }
    run_.missing = detector_.missing();
    run_.expected_events = run_.events + run_.missing.size();
    run_.fault = player.record().fault.code;
    return std::move(run_);
  }

 private:
  void add(const CycleRecord& record) {
    if (record.solver_status != SolverStatus::kSolved) ++run_.unsolved;
    int changes = 0;
    for (int i = 0; i < record.limit_count; ++i) {
      const LimitReport& limit = record.limits[i];
      const bool is_acting = limit.state != LimitState::kInactive;
      if (is_acting != is_acting_[i]) ++changes;
      is_acting_[i] = is_acting;
      if (limit.excess > run_.worst_violation) {
        run_.worst_violation = limit.excess;
        run_.worst_limit = scenario_.limits[i].name;
        run_.worst_is_angle = scenario_.limits[i].is_angle;
      }
    }
    if (run_.cycles > 0) {
      const double change = (record.a_H - last_acceleration_).norm();
      run_.sum_acceleration_change += change;
      run_.max_acceleration_change = std::max(run_.max_acceleration_change, change);
      run_.changes += changes;
      if (changes > 0) ++run_.changed_cycles;
    }
    last_acceleration_ = record.a_H;
    ++run_.cycles;
    run_.duration_s += scenario_.device.model.dt();
  }

  const config::Scenario& scenario_;
  analysis::EventDetector detector_;
  std::array<bool, kMaxLimits> is_acting_{};
  Eigen::Vector3d last_acceleration_ = Eigen::Vector3d::Zero();
  LawRun run_;
};

}  // namespace

bool LawRun::is_well() const {
  return missing.empty() && fault == FaultCode::kNone && unsolved == 0 && cycles > 0;
}

LawRun play_law(const std::string& name, const config::Scenario& scenario) {
  return Observer(name, scenario).play();
}

}  // namespace hg::bench
