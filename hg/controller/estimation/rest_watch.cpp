#include "hg/controller/estimation/rest_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::estimation {
namespace {

constexpr double kTremor = 0.009;      // N, rms of an axis, besides the sensor's noise
constexpr double kHand = 0.015;        // N, the same, of what is certainly a hand
constexpr double kMostNoise = 0.016;   // N, in the band: more hides a tremor
constexpr double kBlock = 0.1;         // s
constexpr int kLeftOut = 4;            // blocks in which the arm itself jerks
constexpr double kForce = 0.5;         // N, change of the wrench that is a touch
constexpr double kLever = 0.08;        // m, of its torque
constexpr double kMostOff = 15.0;      // N, of a first zero: more is a push
constexpr double kMet = 0.05;          // N, between a zero and the wrench that it has met
constexpr double kSame = 0.15;         // N, change of a force that stays the same
constexpr double kTravel = 0.03;       // m, on which the force of a hand changes by more
constexpr double kTurned = 0.5;        // of up, as a unit vector: turning explains no more than so
constexpr double kMoving = 0.018;      // N, rms of an axis, by which moving drives shake a payload
constexpr int kNewest = 4;             // blocks in which a moving tool has no tremor
constexpr double kFast = 0.008;        // s, low-pass of what touches
constexpr double kMean = 1.6;          // s, low-pass of what is steady
constexpr double kFollow = 0.3;        // s, in which the zero follows it
constexpr double kNoise = 0.2;         // s, low-pass of the noise that is seen
constexpr double kShortest = 1e-3;     // s, between two samples of a sensor
constexpr double kHertz = 10.0;        // of the band
constexpr double kQuality = 1.5;       // of each of its two band-passes
constexpr double kBand = 4.1;          // Hz, of noise in the band without the blocks left out
constexpr double kDrift = 0.02;        // N/s, of a sensor: 10 N in 10 minutes
constexpr double kFastestStep = 0.05;  // N/s, of a zero that follows
constexpr double kRamp = 60.0;         // 1/s^2, of the braking rate
constexpr double kFullRate = 60.0;     // 1/s
constexpr double kAnswer = 1.0;        // s of braking that a hand would answer

// Force of a payload whose mass may be wrong by as much as itself, or by a kilogram.
double payload_force(const RestInput& input, double acceleration) noexcept {
  return std::max(1.0, 2.0 * input.payload_mass) * acceleration;
}

bool is_within(const Vector6& w, double force) noexcept {
  const bool is_small = w.head<3>().lpNorm<Eigen::Infinity>() <= force;
  return is_small && w.tail<3>().lpNorm<Eigen::Infinity>() <= kLever * force;
}

// A band-pass by the bilinear transformation, with 1 at kHertz.
struct BandPass {
  explicit BandPass(double dt) noexcept {
    const double omega = 2.0 * std::numbers::pi * kHertz * dt;
    const double alpha = std::sin(omega) / (2.0 * kQuality);
    through = alpha / (1.0 + alpha);
    back = 2.0 * std::cos(omega) / (1.0 + alpha);
    far_back = (1.0 - alpha) / (1.0 + alpha);
  }
  Eigen::Vector3d passed(const Eigen::Vector3d& x,
                         std::array<Eigen::Vector3d, 2>& state) const noexcept {
    const Eigen::Vector3d y = through * x + state[0];
    state[0] = state[1] + back * y;
    state[1] = -through * x - far_back * y;
    return y;
  }

  double through, back, far_back;
};

// Mean square of an axis over all blocks but the largest.
double mean_of_blocks(std::array<double, RestState::kBlocks> blocks) noexcept {
  std::sort(blocks.begin(), blocks.end());
  constexpr int kCount = RestState::kBlocks - kLeftOut;
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) sum += blocks[i];
  return sum / kCount;
}

// Square of the sensor's noise in a band of `width`, Hz. Sensors give a new sample at most every
// millisecond: what a faster loop reads between is no other noise.
double noise_in(double width, double dt, double noise) noexcept {
  return 2.0 * width * std::max(dt, kShortest) * noise * noise;
}

// Square of a tremor of `least` in the band with the sensor's noise; 0: noise hides it.
double tremor_limit(double dt, double noise, double least) noexcept {
  const double hidden = noise_in(kBand, dt, noise);
  return hidden < kMostNoise * kMostNoise ? least * least + hidden : 0.0;
}

// Whether the zero has met the steady wrench since the twin is braked.
bool is_met(const RestState& rest) noexcept {
  return rest.is_known && rest.known_s < rest.braked_s - kAnswer;
}

// Noise of a force, as of samples of that period, N: as stated, or more where a sample differs more
// from the one before. Tremor changes far less from one to the next.
double noise_of(double dt, double stated, const RestState& rest) noexcept {
  const double period = dt / std::max(rest.changing, 0.01);  // of the sensor
  const double seen = 0.5 * rest.jumps * period / std::max(dt, kShortest);
  return std::max(stated, std::sqrt(seen));
}

// Whether the handle has travelled with the same wrench, as far as turning explains a change, and
// without a tremor. Advances the travel.
bool is_carried(double dt, const RestInput& input, RestState& rest) noexcept {
  const double turned = (input.up_S - rest.carried_up).norm();
  rest.travel += dt * input.v_H;
  const double same = kSame + payload_force(input, 9.81 * turned);
  if (!(turned < kTurned) || !is_within(rest.fast - rest.carried, same)) {
    rest.carried = rest.fast;
    rest.carried_up = input.up_S;
    rest.travel.setZero();
  }
  if (!(rest.travel.norm() >= kTravel) || rest.watched_s < RestState::kBlocks * kBlock)
    return false;
  double sum = 0.0;
  for (int i = 0; i < kNewest; ++i) sum += rest.blocks[i];
  return sum / kNewest < tremor_limit(dt, noise_of(dt, input.noise, rest), kMoving);
}

// Whether the wrench stays and nothing trembles.
void look(double dt, const RestInput& input, RestState& rest) noexcept {
  const Eigen::Vector3d f = input.w_S.head<3>() - input.inertia_S;
  const BandPass pass(dt);
  if (rest.watched_s == 0.0) rest.fast = rest.mean = input.w_S;
  const bool is_new = rest.watched_s < 0.5 * kBlock;
  rest.watched_s += dt;
  rest.fast += std::min(1.0, dt / kFast) * (input.w_S - rest.fast);
  rest.mean += std::min(1.0, dt / kMean) * (input.w_S - rest.mean);
  const Eigen::Vector3d x = is_new ? rest.fast.head<3>() - input.inertia_S : f;
  // as if the band had always seen this wrench: a first sample's noise would be a step
  if (is_new) rest.band[0].fill(-pass.through * x);
  const Eigen::Vector3d y = pass.passed(pass.passed(x, rest.band[0]), rest.band[1]);
  rest.sum += y.squaredNorm() / 3.0;
  if (++rest.samples * dt >= kBlock) {
    std::shift_right(rest.blocks.begin(), rest.blocks.end(), 1);
    rest.blocks[0] = rest.sum / rest.samples;
    rest.tremor = mean_of_blocks(rest.blocks);
    rest.sum = 0.0;
    rest.samples = 0;
  }
  const Vector6 change = rest.fast - (is_met(rest) ? rest.zero : rest.mean);
  // braking shakes the payload, and is ended early only by a touch
  const bool is_braking = rest.braked_s > 0.0 && rest.braked_s < kAnswer;
  double inertia = payload_force(input, input.acceleration);
  // a hand that pushes a light twin off accelerates the payload, too: at least half is a touch
  if (!is_braking) inertia = std::min(inertia, 0.5 * change.head<3>().lpNorm<Eigen::Infinity>());
  const bool is_steady = is_within(change, kForce + inertia);
  rest.steady = is_steady ? std::min(rest.steady + 1, 1 << 20) : 0;
  if (!is_steady) rest.mean = rest.fast;
  const bool is_weight = is_carried(dt, input, rest);
  const bool is_calm = is_braking || is_weight ||
                       rest.tremor < tremor_limit(dt, noise_of(dt, input.noise, rest), kTremor);
  const int blocks = is_weight || rest.braked_s > 0.0 ? kNewest : RestState::kBlocks;
  rest.is_untouched = is_calm && rest.steady * dt >= blocks * kBlock;
}

// Whether time and turning explain how far the steady wrench is from the zero.
bool is_explained(const RestInput& input, const RestState& rest) noexcept {
  if (!rest.is_known) return is_within(rest.mean, kMostOff);
  const double turned = (input.up_S - rest.known_up).norm();
  const double force = kForce + kDrift * rest.known_s + payload_force(input, 9.81 * turned);
  return is_within(rest.mean - rest.zero, force);
}

void follow(double dt, const RestInput& input, RestState& rest) noexcept {
  const Vector6 off = rest.mean - rest.zero;
  Vector6 step = std::min(1.0, dt / kFollow) * off;
  if (is_met(rest)) {
    const double most = kFastestStep * dt;
    step.head<3>() = step.head<3>().cwiseMax(-most).cwiseMin(most);
    step.tail<3>() = step.tail<3>().cwiseMax(-kLever * most).cwiseMin(kLever * most);
  }
  rest.zero += step;
  if (!is_within(off, kMet)) return;
  rest.is_known = true;
  rest.known_up = input.up_S;
  rest.known_s = 0.0;
}

}  // namespace

void see_noise(double dt, const Vector6& w_S, RestState& rest) noexcept {
  const double jump = (w_S - rest.last).head<3>().squaredNorm() / 3.0;
  const bool is_first = rest.last.isZero(0.0);
  const double share = std::min(1.0, dt / kNoise);
  rest.last = w_S;
  if (is_first || !std::isfinite(jump)) return;
  rest.changing += share * ((jump > 0.0 ? 1.0 : 0.0) - rest.changing);
  if (jump > 0.0) rest.jumps += share * (jump - rest.jumps);
}

void advance(double dt, const RestInput& input, RestState& rest) noexcept {
  look(dt, input, rest);
  rest.known_s += dt;
  const bool may_act = rest.is_untouched && input.is_free && is_explained(input, rest);
  if (!may_act || !(input.is_slow || rest.braked_s > 0.0)) {
    rest.braked_s = 0.0;
    return;
  }
  rest.braked_s += dt;
  if (rest.braked_s > kAnswer && !input.is_at_limit) follow(dt, input, rest);
}

bool trembles(double dt, double stated, const RestState& rest) noexcept {
  constexpr int kNewest = 4;
  constexpr double kWhole = 5.2, kCertain = 3.0;  // Hz, of noise in the band; times
  const double noise = noise_of(dt, stated, rest);
  double sum = 0.0;
  for (int i = 0; i < kNewest; ++i) sum += rest.blocks[i];
  const double hidden = noise_in(kWhole, dt, noise);
  const double limit = tremor_limit(dt, noise, kHand);
  return limit > 0.0 && (sum > kNewest * kCertain * hidden || rest.tremor > limit);
}

double braking_rate(const RestState& rest) noexcept {
  return std::min(kFullRate, kRamp * rest.braked_s);
}

}  // namespace hg::estimation
