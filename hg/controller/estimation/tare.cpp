#include "hg/controller/estimation/tare.h"

#include <algorithm>
#include <cmath>

namespace hg::estimation {
namespace {

bool has_moved(const TareState& tare, double motion_max, const VectorM& q_m,
               const VectorP& q_p) noexcept {
  return ((q_m - tare.q_m).array().abs() > motion_max).any() ||
         ((q_p - tare.q_p).array().abs() > motion_max).any();
}

bool is_steady(const TareConfig& config, const TareState& tare) noexcept {
  for (int i = 0; i < 6; ++i) {
    const double noise = i < 3 ? config.noise_force : config.noise_torque;
    // both halves are of the same length
    const double drift = 2.0 * std::abs(tare.mean[i] - tare.first_half[i]);
    const double deviation = std::sqrt(tare.square[i] / tare.count);
    if (drift > config.drift_max * noise || deviation > config.deviation_max * noise) return false;
  }
  return true;
}

}  // namespace

void begin(TareState& tare) noexcept {
  tare.status = TareStatus::kUnderWay;
  tare.count = 0;
}

void advance(const TareConfig& config, double dt, const Vector6& w_S, bool is_held,
             const VectorM& q_m, const VectorP& q_p, TareState& tare) noexcept {
  if (tare.status != TareStatus::kUnderWay) return;
  if (is_held) {
    tare.status = TareStatus::kRefusedHeld;
    return;
  }
  if (tare.count == 0) {
    tare.mean = tare.square = tare.first_half = Vector6::Zero();
    tare.q_m = q_m;
    tare.q_p = q_p;
  }
  if (has_moved(tare, config.motion_max, q_m, q_p)) {
    tare.status = TareStatus::kRefusedMoving;
    return;
  }

  // Welford's running mean and sum of squares
  ++tare.count;
  const Vector6 deviation = w_S - tare.mean;
  tare.mean += deviation / tare.count;
  tare.square += deviation.cwiseProduct(w_S - tare.mean);

  const int half = std::max(1, static_cast<int>(std::lround(0.5 * config.duration / dt)));
  if (tare.count == half) tare.first_half = tare.mean;
  if (tare.count < 2 * half) return;
  if (!is_steady(config, tare)) {
    tare.status = TareStatus::kRefusedUnsteady;
    return;
  }
  tare.status = TareStatus::kDone;
  tare.is_valid = true;
  tare.offset = tare.mean;
}

}  // namespace hg::estimation
