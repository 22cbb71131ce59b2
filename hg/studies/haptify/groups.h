/// The groups of measurements of benchmark.h; each adds its figures, tables and failures.
#pragma once

#include <string>
#include <vector>

#include "hg/config/scenario.h"
#include "hg/studies/free_twin.h"
#include "hg/studies/haptify/benchmark.h"
#include "hg/studies/haptify/figures.h"
#include "hg/studies/haptify/free_space.h"
#include "hg/studies/workers.h"

namespace hg::haptify {

/// A lighter body than the shipped one, for comparison; [C] 4.
inline constexpr studies::FreeTwin kLightBody = {.mass = 3.0, .damping = 2.0};

struct Group {
  const config::Scenario& scenario;
  const HaptifyOptions& options;
  const Told& told;
  Benchmark& out;

  /// Calls measure(i) for every i < count, on all cores.
  template <typename Measure>
  auto measure_all(const std::string& what, std::size_t count, const Measure& measure) const {
    std::vector<decltype(measure(std::size_t{}))> results(count);
    studies::do_all(
        count, [&](std::size_t i) { results[i] = measure(i); },
        [&](std::size_t done, std::size_t total) {
          if (told) told(what, done, total);
        });
    return results;
  }
  std::size_t repetitions() const { return static_cast<std::size_t>(options.repetitions); }
  std::uint64_t seed(std::size_t repetition) const { return options.seed + repetition; }
  /// False when a measurement has failed; the failure is reported and its numbers are invalid.
  bool has_worked(const std::string& what, const std::string& failure) const {
    if (failure.empty()) return true;
    out.failures.push_back(what + ": " + failure);
    return false;
  }
};

/// The spectrum of a vibration as a curve, from kVibrationBand to 500 Hz.
Curve vibration_curve(const std::string& id, const std::string& name, const FreeSpace& measured);

void add_workspace(const Group& group);
void add_free_space(const Group& group);
/// Adds the imperfections that cause the vibration; call it after add_free_space().
void add_sources(const Group& group);
void add_dynamics(const Group& group);
void add_sliding(const Group& group);
void add_stiffness(const Group& group);
void add_peak(const Group& group);
void add_z_width(const Group& group);
void add_transparency(const Group& group);
void add_force_response(const Group& group);
void add_latency(const Group& group);
void add_impacts(const Group& group);
void add_felt_mass(const Group& group);
void add_rotation(const Group& group);
void add_springs(const Group& group);

}  // namespace hg::haptify
