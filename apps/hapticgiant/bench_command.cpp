#include "apps/hapticgiant/bench_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "hg/assembly/assembly.h"
#include "hg/core/error.h"
#include "hg/evaluation/summary.h"
#include "hg/hqp/solver.h"
#include "hg/runtime/requests.h"

namespace hg::apps {
namespace {

using Clock = std::chrono::steady_clock;
using rendering::Bounds;
using rendering::Law;

constexpr std::array<std::pair<Law, Bounds>, 4> kVariants = {{{Law::kGauss, Bounds::kRecoverable},
                                                              {Law::kPaper, Bounds::kRecoverable},
                                                              {Law::kGauss, Bounds::kPaper},
                                                              {Law::kPaper, Bounds::kPaper}}};

double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

/// One line of the table; times in us, accelerations of the hand in m/s^2.
struct Measured {
  std::string scenario, law, bounds;
  std::size_t events = 0, expected_events = 0;
  std::vector<std::string> missing;
  FaultCode fault = FaultCode::kNone;
  int cycles = 0;  ///< that render
  int unsolved = 0;
  double duration_s = 0.0;
  int changes = 0;         ///< limits that begin or cease to act
  int changed_cycles = 0;  ///< cycles in which one does
  double sum_acceleration_change = 0.0, max_acceleration_change = 0.0;
  double worst_violation = 0.0;  ///< rad or m
  bool worst_is_angle = false;
  std::string worst_limit = "none";
  evaluation::Histogram solver_us, cycle_us;
};

/// Plays one scenario and looks at every cycle.
class Player {
 public:
  explicit Player(const config::Scenario& scenario)
      : scenario_(scenario),
        cycle_(assembly::make_cycle(scenario)),
        device_(assembly::make_simulated_device(scenario)),
        detector_(scenario.events, scenario.limits),
        changes_(scenario.changes) {}

  Measured play() {
    const double end = assembly::planned_duration_s(scenario_);
    std::uint64_t played = 0;
    do {
      device_.read(sample_->sensors);
      sample_->operator_input.change =
          changes_.due(static_cast<double>(played++) / scenario_.device.rate_Hz);
      const hqp::ActiveSet before = cycle_.state().rendering.active_set;
      const auto begin = Clock::now();
      cycle_.step(sample_->sensors, sample_->operator_input, sample_->command, sample_->record);
      const double cycle_us = microseconds_since(begin);
      device_.write(sample_->command);
      const CycleRecord& record = sample_->record;
      sample_->operator_input.request =
          runtime::next_request(record.mode, cycle_.is_held(sample_->sensors), false);
      if (detector_.observe(record)) ++measured_.events;
      if (record.mode == Mode::kRunning) {
        measured_.cycle_us.add(cycle_us);
        time_solver(before);
        add(record);
      }
    } while (sample_->record.time_s < end && sample_->record.mode != Mode::kFault);
    measured_.missing = detector_.missing();
    measured_.expected_events = measured_.events + measured_.missing.size();
    measured_.fault = sample_->record.fault.code;
    return std::move(measured_);
  }

 private:
  void time_solver(hqp::ActiveSet active) {
    if (!solver_) {
      solver_ = std::make_unique<hqp::Solver>(cycle_.problem().capacity());
      solution_ = std::make_unique<hqp::Solution>(cycle_.problem().capacity());
    }
    const auto begin = Clock::now();
    solver_->solve(cycle_.problem(), {}, active, *solution_);
    measured_.solver_us.add(microseconds_since(begin));
  }

  void add(const CycleRecord& record) {
    if (record.solver_status != SolverStatus::kSolved) ++measured_.unsolved;
    int changes = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(record.limit_count); ++i) {
      const LimitReport& limit = record.limits[i];
      const bool is_acting = limit.state != LimitState::kInactive;
      if (is_acting != is_acting_[i]) ++changes;
      is_acting_[i] = is_acting;
      if (limit.excess > measured_.worst_violation) {
        measured_.worst_violation = limit.excess;
        measured_.worst_limit = scenario_.limits[i].name;
        measured_.worst_is_angle = scenario_.limits[i].is_angle;
      }
    }
    if (measured_.cycles > 0) {
      const double change = (record.a_H - last_acceleration_).norm();
      measured_.sum_acceleration_change += change;
      measured_.max_acceleration_change = std::max(measured_.max_acceleration_change, change);
      measured_.changes += changes;
      if (changes > 0) ++measured_.changed_cycles;
    }
    last_acceleration_ = record.a_H;
    ++measured_.cycles;
    measured_.duration_s += scenario_.device.rendering.dt;
  }

  const config::Scenario& scenario_;
  cycle::Cycle cycle_;
  device::SimulatedDevice device_;
  evaluation::EventDetector detector_;
  TimedChanges changes_;
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
  std::unique_ptr<hqp::Solver> solver_;
  std::unique_ptr<hqp::Solution> solution_;
  std::array<bool, kMaxLimits> is_acting_{};
  Eigen::Vector3d last_acceleration_ = Eigen::Vector3d::Zero();
  Measured measured_;
};

config::Scenario load(const std::string& name) {
  config::Scenario scenario = make_scenario({.scenario = name});
  if (assembly::planned_duration_s(scenario) == 0.0) {
    throw SetupError(name + ": bench needs a scenario with a script");
  }
  return scenario;
}

Measured measure(const std::string& name, config::Scenario scenario, Law law, Bounds bounds) {
  scenario.device.rendering.law = law;
  scenario.device.rendering.bounds = bounds;
  Measured measured = Player(scenario).play();
  measured.scenario = name;
  measured.law = rendering::to_string(law);
  measured.bounds = rendering::to_string(bounds);
  return measured;
}

bool is_well(const Measured& m) {
  return m.missing.empty() && m.fault == FaultCode::kNone && m.unsolved == 0 && m.cycles > 0;
}

double per_cycle(double sum, const Measured& measured) {
  return sum / std::max(1, measured.cycles - 1);
}

std::string to_text(const evaluation::Distribution& d) {
  return fmt::format("{:.1f} / {:.1f} / {:.0f}", d.median, d.p99_9, d.max);
}

std::string violation(const Measured& m) {
  if (m.worst_violation == 0.0) return "none";
  return fmt::format("{:.2f} {} {}", 1e3 * m.worst_violation, m.worst_is_angle ? "mrad" : "mm",
                     m.worst_limit);
}

constexpr const char* kLine =
    "{:<11} {:<6} {:<12} {:>6} {:>9} {:>9} {:>8} {:>8}  {:<19} {:<20} {}\n";

std::string header() {
  std::string text = "us: median / 99.9 % / max; change of acceleration: of the hand per cycle\n\n";
  text += fmt::format(kLine, "scenario", "law", "bounds", "events", "changes/s", "cycles", "mean",
                      "max", "worst violation", "solver us", "cycle us");
  return text + fmt::format(kLine, "", "", "", "", "", "changed", "m/s^2", "m/s^2", "", "", "");
}

std::string to_text(const Measured& m) {
  std::string text = fmt::format(
      kLine, m.scenario, m.law, m.bounds, fmt::format("{}/{}", m.events, m.expected_events),
      fmt::format("{:.1f}", m.changes / std::max(m.duration_s, 1e-9)),
      fmt::format("{:.2f} %", 100.0 * per_cycle(m.changed_cycles, m)),
      fmt::format("{:.4f}", per_cycle(m.sum_acceleration_change, m)),
      fmt::format("{:.1f}", m.max_acceleration_change), violation(m),
      to_text(m.solver_us.distribution()), to_text(m.cycle_us.distribution()));
  if (!m.missing.empty()) text += fmt::format("  missing: {}\n", fmt::join(m.missing, ", "));
  if (m.fault != FaultCode::kNone) text += fmt::format("  fault: {}\n", to_string(m.fault));
  if (m.unsolved > 0) text += fmt::format("  {} cycles not solved\n", m.unsolved);
  return text;
}

nlohmann::ordered_json to_json(const evaluation::Distribution& d) {
  return {{"median", d.median}, {"p99_9", d.p99_9}, {"max", d.max}};
}

nlohmann::ordered_json to_json(const Measured& m) {
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
          {"solver_us", to_json(m.solver_us.distribution())},
          {"cycle_us", to_json(m.cycle_us.distribution())}};
}

}  // namespace

int bench(const BenchArguments& arguments) {
  check_writable(arguments.json);
  std::vector<config::Scenario> scenarios;
  for (const std::string& name : arguments.scenarios) scenarios.push_back(load(name));

  nlohmann::ordered_json json{{"version", kVersion}, {"runs", nlohmann::ordered_json::array()}};
  bool all_well = true;
  fmt::print("{}", header());
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    for (const auto& [law, bounds] : kVariants) {
      if (law == Law::kPaper && scenarios[i].device.model.n_m != 6) {
        fmt::print("{:<11} paper  needs six manipulator joints\n", arguments.scenarios[i]);
        continue;
      }
      const Measured measured = measure(arguments.scenarios[i], scenarios[i], law, bounds);
      all_well = all_well && is_well(measured);
      fmt::print("{}", to_text(measured));
      std::fflush(stdout);
      json["runs"].push_back(to_json(measured));
    }
  }
  if (!arguments.json.empty()) write_output(arguments.json, json.dump(2) + "\n");
  return all_well ? 0 : 1;
}

}  // namespace hg::apps
