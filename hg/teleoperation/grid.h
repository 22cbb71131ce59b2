/// Trials of all methods over delay, jitter, loss, walls and hands.
#pragma once

#include <functional>
#include <vector>

#include "hg/simulator/person/hand.h"
#include "hg/teleoperation/trial.h"

namespace hg::teleoperation {

/// Values that are combined with each other.
struct Grid {
  std::vector<MethodKind> methods = {MethodKind::kPositionForce, MethodKind::kFourChannel,
                                     MethodKind::kWaveVariables, MethodKind::kPassivityControl,
                                     MethodKind::kModelMediated};
  std::vector<double> delays = {0.0, 0.05, 0.4};  ///< each way, s
  std::vector<double> jitters = {0.0};            ///< s
  std::vector<double> losses = {0.0, 0.1};
  std::vector<double> walls = {1e3, 5e3};  ///< N/m
  std::vector<person::HandPreset> hands = {person::HandPreset::kRelaxed,
                                           person::HandPreset::kNormal, person::HandPreset::kStiff};
  double press = 10.0;  ///< N, as of TrialConfig
  double hold = 4.0;    ///< s
  std::uint64_t seed = 1;
  /// Halves of a method of others, as of TrialConfig, in place of those of `methods`.
  decltype(TrialConfig::make_leader) make_leader;
  decltype(TrialConfig::make_remote) make_remote;
};

/// The grid of the benchmark: frozen, so that results can be compared.
Grid full_grid();

struct GridCase {
  MethodKind method = MethodKind::kModelMediated;
  double delay = 0.0, jitter = 0.0, loss = 0.0, wall = 0.0;
  person::HandPreset hand = person::HandPreset::kNormal;
  TrialResult result;
  double peak_ratio = 0.0;  ///< Largest force of the hand over that of position-force without delay
  double unfelt_rms = 0.0;  ///< regulation_rms of a hand that feels nothing, N

  double regulation_ratio() const noexcept { return result.regulation_rms / unfelt_rms; }
};

/// Plays all trials, in a fixed order. `played` gets each result and may throw.
std::vector<GridCase> play_grid(const Grid& grid,
                                const std::function<void(const GridCase&)>& played = {});

}  // namespace hg::teleoperation
