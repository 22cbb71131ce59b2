#include "hg/controller/safety/shaking.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

namespace hg::safety {
namespace {

constexpr double kHigh_Hz = 30.0, kLow_Hz = 3.0;
constexpr double kMean = 0.2;         // s
constexpr double kLeastTorque = 0.1;  // Nm
constexpr double kRatio = 0.5;        // oscillation torque over intended torque
constexpr double kIntention = 0.05;   // Nm, added to the intended torque
constexpr double kTrip = 0.2;         // s
constexpr double kPause = 0.2;        // s: longer than half a period of 3 Hz
constexpr int kTurns = 3;             // one and a half periods
constexpr double kFastMean = 0.05;    // s
constexpr double kFastForce = 1.0;    // N; strokes and stops of the scenarios: 0.8, impacts more
constexpr double kFastTorque = 0.1;   // Nm; the same: 0.06
constexpr double kFastTrip = 0.5;     // s
constexpr double kTouch = 0.5;        // N
constexpr double kSlow = 0.05;        // m/s: gentler contacts are none
constexpr double kLongest = 2.5;      // s from contact to contact
constexpr int kContacts = 3;
constexpr double kSpeedKept = 0.5;  // of that of the first contact
constexpr double kEnergy = 0.5;     // J

double share_of(double dt, double time) noexcept { return -std::expm1(-dt / time); }

// counts up while the condition holds, down twice as fast
void count(bool is_so, double dt, double trip, double& counter) noexcept {
  counter = std::clamp(counter + (is_so ? dt : -2.0 * dt), 0.0, trip);
}

}  // namespace

ShakingWatch::ShakingWatch(double dt, double mass) noexcept : dt_(dt), mass_(mass) {
  // at most a quarter of the rate, where the tangent is well behaved
  const double cutoff = std::min(kHigh_Hz, 0.25 / dt);
  const double k = std::tan(std::numbers::pi * cutoff * dt);
  const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * k + k * k);
  b_ = norm;
  a1_ = 2.0 * (k * k - 1.0) * norm;
  a2_ = (1.0 - std::numbers::sqrt2 * k + k * k) * norm;
}

double ShakingWatch::check_torque(const Eigen::Vector3d& torque, ShakingState& s) const noexcept {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double slow = share_of(dt_, 1.0 / (kTurn * kLow_Hz)), mean = share_of(dt_, kMean);
  s.x1 += share_of(dt_, 1.0 / (kTurn * kHigh_Hz)) * (torque - s.x1);
  s.x2 += slow * (s.x1 - s.x2);
  s.x3 += slow * (s.x2 - s.x3);
  const Eigen::Vector3d band = s.x1 - s.x2;
  s.high += mean * (band.squaredNorm() - s.high);
  s.low += mean * (s.x3.squaredNorm() - s.low);
  const double high = std::sqrt(s.high);
  s.turns.step(band, 0.5 * high, dt_, kPause);
  const bool shakes = s.turns.count >= kTurns && high > kLeastTorque &&
                      high > kRatio * (std::sqrt(s.low) + kIntention);
  count(shakes, dt_, kTrip, s.torque_s);
  return s.torque_s / kTrip;
}

void ShakingWatch::look_above(const Vector6& w_S, ShakingState& s) const noexcept {
  const Vector6 band = b_ * (w_S - 2.0 * s.in1 + s.in2) - a1_ * s.out1 - a2_ * s.out2;
  s.in2 = s.in1;
  s.in1 = w_S;
  s.out2 = s.out1;
  s.out1 = band;
  const double mean = share_of(dt_, kFastMean);
  s.force += mean * (band.head<3>().squaredNorm() - s.force);
  s.torque += mean * (band.tail<3>().squaredNorm() - s.torque);
  count(s.force > kFastForce * kFastForce, dt_, kFastTrip, s.fast_force_s);
  count(s.torque > kFastTorque * kFastTorque, dt_, kFastTrip, s.fast_torque_s);
}

double ShakingWatch::look_for_bouncing(const ShakingInput& input, ShakingState& s) const noexcept {
  const Eigen::Vector3d& push = input.contact_force;
  const bool touches = push.norm() > kTouch;
  s.since_contact_s += dt_;
  s.given -= dt_ * input.w_H.head<3>().dot(input.v_H);
  if (s.since_contact_s > kLongest) {
    s.contacts = 0;
    s.bounces = false;
  }
  if (touches && !s.touches) {
    const double speed = -push.normalized().dot(input.v_H);
    // a contact at less than half the first speed starts a new series
    if (s.contacts == 0 || speed < kSpeedKept * s.first_speed) {
      s.contacts = 0;
      s.first_speed = speed;
      s.given = 0.0;
    }
    s.contacts = speed < kSlow ? 0 : s.contacts + 1;
    s.bounces =
        s.contacts >= kContacts && s.given > 0.5 * mass_ * s.first_speed * s.first_speed + kEnergy;
    s.since_contact_s = 0.0;
  }
  s.touches = touches;
  return s.bounces ? 1.0 : 0.0;
}

ShakingReport ShakingWatch::step(const ShakingInput& input, ShakingState& state) const noexcept {
  if (!state.is_started) {
    state.x1 = state.x2 = state.x3 = input.w_H.tail<3>();
    state.in1 = state.in2 = input.w_S;
    state.is_started = true;
  }
  const double torque = check_torque(input.w_H.tail<3>(), state);
  look_above(input.w_S, state);
  const double bouncing = look_for_bouncing(input, state);
  ShakingReport report;
  for (const ShakingReport& found :
       {ShakingReport{Shaking::kForce, input.oscillation}, ShakingReport{Shaking::kTorque, torque},
        ShakingReport{Shaking::kFastForce, state.fast_force_s / kFastTrip},
        ShakingReport{Shaking::kFastTorque, state.fast_torque_s / kFastTrip},
        ShakingReport{Shaking::kBouncing, bouncing}}) {
    if (found.index >= 1.0 && found.index > report.index) report = found;
  }
  state.shakes_s = report.what == Shaking::kNone ? 0.0 : state.shakes_s + dt_;
  return report;
}

}  // namespace hg::safety
