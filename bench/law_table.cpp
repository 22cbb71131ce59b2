#include "bench/law_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bench/player.h"
#include "bench/stop_watch.h"
#include "bench/times.h"

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
    bool goes_on = true;
    while (goes_on) {
      player.begin();
      const Clock::time_point begin = Clock::now();
      watch.run(player);
      const double cycle_us = microseconds_since(begin);
      goes_on = player.end();
      if (detector_.observe(player.record())) ++run_.events;
      if (!player.is_running()) continue;
      run_.cycle_us.add(cycle_us);
      run_.solver_us.add(watch.us(Stage::kSolver));
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
    for (std::size_t i = 0; i < static_cast<std::size_t>(record.limit_count); ++i) {
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

double per_cycle(double sum, const LawRun& run) { return sum / std::max(1, run.cycles - 1); }

std::string to_text(const analysis::Distribution& d) {
  return fmt::format("{:.1f} / {} / {:.0f}", d.median, bench::to_text(d.p99_9, 1), d.max);
}

analysis::Distribution distribution(const analysis::Histogram& times, int cycles) {
  analysis::Distribution d = times.distribution();
  if (static_cast<std::size_t>(cycles) < kEnoughForTail) d.p99_9 = std::nan("");
  return d;
}

std::string violation(const LawRun& m) {
  if (m.worst_violation == 0.0) return "none";
  return fmt::format("{:.2f} {} {}", 1e3 * m.worst_violation, m.worst_is_angle ? "mrad" : "mm",
                     m.worst_limit);
}

constexpr const char* kLine =
    "{:<11} {:<6} {:<12} {:>6} {:>9} {:>9} {:>8} {:>8}  {:<19} {:<20} {}\n";

nlohmann::ordered_json to_json(const analysis::Distribution& d) {
  return {{"median", d.median}, {"p99_9", bench::to_json(d.p99_9)}, {"max", d.max}};
}

}  // namespace

bool LawRun::is_well() const {
  return missing.empty() && fault == FaultCode::kNone && unsolved == 0 && cycles > 0;
}

LawRun play_law(const std::string& name, const config::Scenario& scenario) {
  return Observer(name, scenario).play();
}

std::string law_header() {
  const std::string text =
      fmt::format(kLine, "scenario", "law", "bounds", "events", "changes/s", "cycles", "mean",
                  "max", "worst violation", "solver us", "cycle us");
  return text + fmt::format(kLine, "", "", "", "", "", "changed", "m/s^2", "m/s^2", "", "", "");
}

std::string to_text(const LawRun& m) {
  std::string text = fmt::format(
      kLine, m.scenario, m.law, m.bounds, fmt::format("{}/{}", m.events, m.expected_events),
      fmt::format("{:.1f}", m.changes / std::max(m.duration_s, 1e-9)),
      fmt::format("{:.2f} %", 100.0 * per_cycle(m.changed_cycles, m)),
      fmt::format("{:.4f}", per_cycle(m.sum_acceleration_change, m)),
      fmt::format("{:.1f}", m.max_acceleration_change), violation(m),
      to_text(distribution(m.solver_us, m.cycles)), to_text(distribution(m.cycle_us, m.cycles)));
  if (!m.missing.empty()) text += fmt::format("  missing: {}\n", fmt::join(m.missing, ", "));
  if (m.fault != FaultCode::kNone) text += fmt::format("  fault: {}\n", to_string(m.fault));
  if (m.unsolved > 0) text += fmt::format("  {} cycles not solved\n", m.unsolved);
  return text;
}

nlohmann::ordered_json to_json(const LawRun& m) {
  return {{"scenario", m.scenario},
          {"law", m.law},
          {"bounds", m.bounds},
          {"events", m.events},
          {"missing_events", m.missing},
          {"fault", std::string(to_string(m.fault))},
          {"cycles", m.cycles},
          {"unsolved", m.unsolved},
          {"active_set_changes_per_second", m.changes / std::max(m.duration_s, 1e-9)},
          {"share_of_cycles_with_a_change", per_cycle(m.changed_cycles, m)},
          {"acceleration_change_per_cycle",
           {{"mean", per_cycle(m.sum_acceleration_change, m)},
            {"max", m.max_acceleration_change},
            {"unit", "m/s^2"}}},
          {"worst_violation",
           {{"limit", m.worst_limit},
            {"value", m.worst_violation},
            {"unit", m.worst_is_angle ? "rad" : "m"}}},
          {"solver_us", to_json(distribution(m.solver_us, m.cycles))},
          {"cycle_us", to_json(distribution(m.cycle_us, m.cycles))}};
}

}  // namespace hg::bench
