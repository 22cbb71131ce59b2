/// Plays a scenario without threads: the same cycle and simulated device as the program, in a loop.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/analysis/events.h"
#include "hg/analysis/summary.h"
#include "hg/config/simulation/scenario.h"
#include "hg/core/allocation_counter.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/options.h"
#include "hg/scenario/session.h"

namespace hg {

/// A scenario that ships with the program, to be played as it is or changed first.
inline config::Scenario shipped(const std::string& name, std::optional<double> rate_Hz = {}) {
  return scenario::load({.scenario = name, .rate_Hz = rate_Hz});
}

/// Leaves the law alone: drives and sensors are perfect, but for the gantry and the filters.
inline config::Scenario with_ideal_device(config::Scenario scenario) {
  scenario.device.control.method = tracking::Method::kDrives;
  scenario.device.model.actuators.clear();
  config::settle_law(scenario);
  scenario.device.simulation.sensors = simulator::ideal_sensors();
  scenario.device.estimation.wrench.tare.noise_force = 1.0;  // N: whether a hand trembles is hidden
  return scenario;
}
inline config::Scenario law_alone(const std::string& name, std::optional<double> rate_Hz = {}) {
  return with_ideal_device(shipped(name, rate_Hz));
}

/// What must hold in every cycle of every run, collected over the cycles that render.
struct Quality {
  int cycles = 0;
  int unsolved = 0;
  int changes = 0;                     ///< cycles in which a limit begins or ceases to act
  double sum_acceleration_change = 0;  ///< of the hand, m/s^2
  double worst_budget = 0;             ///< see budget_error
  double largest_reaction = 0;         ///< of any limit, N or Nm
  std::uint64_t allocations = 0;       ///< in Cycle::step

  double mean_acceleration_change() const { return sum_acceleration_change / cycles; }
};

/// How far the parts of the budget are from adding up to tau_a, relative to the largest part.
inline double budget_error(const CycleRecord& record) {
  const Budget& b = record.budget;
  double scale = 1.0;  // Nm or N
  VectorA rest = record.tau_a;
  for (const VectorA* part :
       {&b.inertia, &b.damping, &b.friction, &b.spring, &b.surface, &b.limits, &b.conflict}) {
    rest -= *part;
    scale = std::max(scale, part->lpNorm<Eigen::Infinity>());
  }
  return rest.lpNorm<Eigen::Infinity>() / scale;
}

class ScenarioRun {
 public:
  explicit ScenarioRun(const std::string& name) : ScenarioRun(shipped(name)) {}

  explicit ScenarioRun(const config::Scenario& scenario)
      : ScenarioRun(scenario, scenario::make_simulated_device(scenario)) {}

  ScenarioRun(config::Scenario scenario, std::unique_ptr<device::Device> device)
      : scenario_(std::move(scenario)),
        session_(scenario_, std::move(device)),
        detector_(scenario_.events, scenario_.limits),
        summary_(scenario::make_summary(scenario_)) {}

  /// Plays until the script has played, or `seconds` of it; `look` sees every sample.
  void play(const std::function<void(const Sample&)>& look = {}, double seconds = 1e9) {
    const Sample& sample = session_.sample();
    const double end = std::min(seconds, scenario::planned_duration_s(scenario_));
    do {
      session_.read();
      {
        const AllocationCounter counter;
        session_.step();
        quality_.allocations += counter.count();
      }
      session_.write();
      summary_.add(sample);
      if (const auto event = detector_.observe(sample.record)) summary_.add(*event);
      if (sample.record.mode == Mode::kRunning) add_quality(sample.record);
      if (look) look(sample);
    } while (sample.record.time_s < end && !session_.is_over());
  }

  /// Asks for a mode in the next cycle, as an operator does.
  void request(ModeRequest request) { session_.request(request); }

  const config::Scenario& scenario() const { return scenario_; }
  const analysis::Summary& summary() const { return summary_; }
  const Quality& quality() const { return quality_; }
  std::vector<std::string> missing() const { return detector_.missing(); }

  /// Time of an event; -1 if it did not happen.
  double time_of(const std::string& name) const {
    for (const analysis::RunEvent& event : summary_.events()) {
      if (event.name == name) return event.time_s;
    }
    return -1.0;
  }

  /// Index of a limit in the catalogue; -1 if there is none of that name.
  int limit(const std::string& name) const {
    for (std::size_t i = 0; i < scenario_.limits.size(); ++i) {
      if (scenario_.limits[i].name == name) return static_cast<int>(i);
    }
    return -1;
  }

 private:
  void add_quality(const CycleRecord& record) {
    ++quality_.cycles;
    if (record.solver_status != SolverStatus::kSolved) ++quality_.unsolved;
    if (quality_.cycles > 1) {
      quality_.sum_acceleration_change += (record.a_H - last_acceleration_).norm();
    }
    last_acceleration_ = record.a_H;
    bool has_changed = false;
    for (std::size_t i = 0; i < is_acting_.size(); ++i) {
      quality_.largest_reaction =
          std::max(quality_.largest_reaction, std::abs(record.limits[i].reaction));
      const bool is_acting = record.limits[i].state != LimitState::kInactive;
      if (is_acting != is_acting_[i]) has_changed = true;
      is_acting_[i] = is_acting;
    }
    if (has_changed) ++quality_.changes;
    quality_.worst_budget = std::max(quality_.worst_budget, budget_error(record));
  }

  config::Scenario scenario_;
  scenario::Session session_;
  analysis::EventDetector detector_;
  analysis::Summary summary_;
  Quality quality_;
  std::array<bool, kMaxLimits> is_acting_{};
  Eigen::Vector3d last_acceleration_ = Eigen::Vector3d::Zero();
};

}  // namespace hg
