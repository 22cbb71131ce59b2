#include "hg/controller/safety/passivity/passivity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::passivity {
namespace {

constexpr double kHigh_Hz = 30.0, kLow_Hz = 3.0;
constexpr double kMean = 0.2;        // s
constexpr double kLeast = 1.0;       // N: less is noise
constexpr double kRatio = 0.5;       // oscillation force over intended force
constexpr double kIntention = 0.5;   // N, added to the intended force
constexpr double kViolent = 15.0;    // N
constexpr double kAfterPush = 0.4;   // s: twice the mean
constexpr double kPause = 0.2;       // s: longer than half a period of 3 Hz
constexpr int kTurns = 2;            // a whole period
constexpr int kTurnsPushed = 6;      // three periods: an impact rings
constexpr double kTremor_Hz = 10.0;  // with half its width: 8 to 12 Hz pass
constexpr double kTremor = 5.0;      // N: 2 N along each axis ([HANDBOOK] 5.1 has 0.05 N), and the
                                     // arm that swings along
constexpr double kDampingRise = 0.02;  // s
constexpr double kInertiaRise = 0.05;  // s
constexpr double kHold = 2.0;          // s
constexpr double kReturn = 1.0;        // s
constexpr double kMostInertia = 10.0;  // times that of the twin
constexpr double kPatience = 3.0;      // s

double share_of(double dt, double time) noexcept { return -std::expm1(-dt / time); }
double share_of_Hz(double dt, double frequency) noexcept {
  return share_of(dt, 1.0 / (2.0 * std::numbers::pi * frequency));
}

// Mean square of the force that may be a person's tremor.
double tremor_part(double dt, const Eigen::Vector3d& f, PassivityState& s) noexcept {
  const double k = std::numbers::pi * kTremor_Hz * dt;
  const double scale = 1.0 / (1.0 + k + k * k);
  const Eigen::Vector3d band =
      scale * (k * (f - s.in2) - 2.0 * (k * k - 1.0) * s.tremor1 - (1.0 - k + k * k) * s.tremor2);
  s.in2 = s.in1;
  s.in1 = f;
  s.tremor2 = s.tremor1;
  s.tremor1 = band;
  s.tremor += share_of(dt, kMean) * (band.squaredNorm() - s.tremor);
  return std::min(s.tremor, kTremor * kTremor);
}

// Index of oscillation; 1 = detected.
double look_for_oscillation(const PassivityConfig& config, double dt, const PassivityInput& input,
                            PassivityState& s) noexcept {
  if (!s.is_started) {
    s.x1 = s.x2 = s.x3 = s.in1 = s.in2 = input.f;
    s.since_pushed_s = kAfterPush;
  }
  s.x1 += share_of_Hz(dt, kHigh_Hz) * (input.f - s.x1);
  s.x2 += share_of_Hz(dt, kLow_Hz) * (s.x1 - s.x2);
  s.x3 += share_of_Hz(dt, kLow_Hz) * (s.x2 - s.x3);
  const double share = share_of(dt, kMean);
  s.high += share * ((s.x1 - s.x2).squaredNorm() - s.high);
  s.low += share * (s.x3.squaredNorm() - s.low);

  s.since_pushed_s = input.is_pushed_back ? 0.0 : s.since_pushed_s + dt;
  const double high = std::sqrt(std::max(0.0, s.high - tremor_part(dt, input.f, s)));
  const double low = std::sqrt(s.low);
  s.turns.step(s.x1 - s.x2, 0.5 * std::sqrt(s.high), dt, kPause);
  const bool counts = s.turns.count >= (s.since_pushed_s > kAfterPush ? kTurns : kTurnsPushed);
  const bool oscillates = counts && high > kLeast && high > kRatio * (low + kIntention);
  s.oscillates_s =
      std::clamp(s.oscillates_s + (oscillates ? dt : -2.0 * dt), 0.0, config.trip_time);
  return std::max(s.oscillates_s / config.trip_time, counts ? high / kViolent : 0.0);
}

void add_impedance(const PassivityConfig& config, double dt, const PassivityInput& input,
                   bool is_detected, PassivityState& s) noexcept {
  s.hold_s = is_detected ? kHold : std::max(0.0, s.hold_s - dt);
  const bool is_full = s.added.damping >= 0.99 * config.damping;
  s.restless_s = is_detected && is_full ? s.restless_s + dt : 0.0;

  const double wanted = std::clamp(config.least_mass / input.mass, 1.0, kMostInertia);
  if (s.hold_s <= 0.0) {
    s.added.damping = std::max(0.0, s.added.damping - dt / kReturn * config.damping);
    s.added.inertia = std::max(1.0, s.added.inertia - dt / kReturn * std::max(1.0, wanted - 1.0));
    return;
  }
  s.added.damping += share_of(dt, kDampingRise) * (config.damping - s.added.damping);
  if (s.tank < config.tank_least) return;
  const double allowed = 2.0 * s.added.damping / input.mass * dt;
  const double rise = share_of(dt, kInertiaRise) * (wanted - s.added.inertia);
  s.added.inertia += std::clamp(rise, 0.0, allowed);
}

}  // namespace

PassivityReport observe_energy(const PassivityConfig& config, double dt,
                               const PassivityInput& input, PassivityState& state) noexcept {
  if (config.reaction == Reaction::kOff) return {};
  if (!state.is_started) state.tank = config.tank_start;
  PassivityReport report;
  report.oscillation = look_for_oscillation(config, dt, input, state);
  state.is_started = true;

  const double inertia_before = state.added.inertia;
  if (config.reaction == Reaction::kAct) {
    add_impedance(config, dt, input, report.oscillation >= 1.0, state);
  }
  const double growth = std::max(0.0, state.added.inertia - inertia_before);
  state.tank += dt * (input.dissipation + input.power_measured - input.power_rendered) -
                0.5 * growth * input.mass * input.speed * input.speed;
  state.tank = std::min(state.tank, config.tank_max);
  state.energy = std::max(0.0, state.energy - dt * input.power_measured);
  report.tank = state.tank;
  report.energy = state.energy;
  report.damping = state.added.damping;
  report.inertia = state.added.inertia;
  return report;
}

Fault passivity_fault(const PassivityConfig& config, const PassivityReport& report,
                      const PassivityState& state) noexcept {
  if (config.reaction != Reaction::kAct) return {};
  if (state.restless_s > kPatience) {
    return {.code = FaultCode::kOscillation, .value = report.oscillation, .limit = 1.0};
  }
  if (state.is_started && report.tank < 0.0) {
    return {.code = FaultCode::kEnergy, .value = report.tank, .limit = 0.0};
  }
  return {};
}

}  // namespace hg::passivity
