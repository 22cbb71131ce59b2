/// Drift of the force sensor's zero, found while nothing touches the handle: by temperature, by a
/// wrong payload once the tool has turned, by a tare at the wrong moment.
///
/// A hand trembles with 8 to 12 Hz, by 20 mN or more along each axis ([HANDBOOK] 5.1). Where this
/// is missing and the wrench is steady for 1.6 s, nothing touches. Then a twin that only the wrench
/// moves is braked. A hand would push against this, which ends it within milliseconds. Without such
/// an answer the zero follows the steady wrench; once it has met it, only as slowly as sensors
/// drift. A known zero is not given up for a wrench that drift and turning do not explain.
/// Sensors whose own noise hides a tremor never count as untouched.
///
/// Moving drives shake a payload nearly as a relaxed hand does. But a hand has stiffness: over 30
/// mm of travel its force changes. A wrench that stays the same on such a way, without a tremor for
/// 0.4 s, is a weight or a drift that nothing holds.
#pragma once

#include <array>
#include <cstdint>

#include "hg/core/types.h"

namespace hg::estimation {

/// What the watch gets in a cycle.
struct RestInput {
  Vector6 w_S = Vector6::Zero();  ///< Wrench of the user, of which `zero` is not subtracted, in S
  Eigen::Vector3d up_S = Eigen::Vector3d::UnitZ();  ///< Upwards, resolved in S
  /// Inertia of the payload that is still in w_S, by the measured motion, N.
  Eigen::Vector3d inertia_S = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();  ///< Measured velocity of the handle, in B, m/s
  double noise = 0.08;                            ///< Stated, of a force in a sample, rms, N
  double payload_mass = 0.0;                      ///< kg
  double acceleration = 0.0;  ///< Of the handle, whose force on the payload is in w_S, m/s^2
  /// Springs, weight and surfaces neither move nor hold the twin, or the device stands still.
  bool is_free = false;
  bool is_at_limit = false;  ///< A limit holds the twin: it may be braked, but the zero stays
  bool is_slow = false;      ///< The twin is slow, or moves with the energy that the wrench gave it
};

/// Part of the copyable state of a cycle.
struct RestState {
  static constexpr int kBlocks = 16;
  double watched_s = 0.0;  ///< Since the watch began
  /// Two band-passes of the force, one after the other; states of each.
  std::array<std::array<Eigen::Vector3d, 2>, 2> band = {
      {{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
       {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}}};
  std::array<double, kBlocks> blocks{};  ///< Mean square of the band in each tenth of a second
  double tremor = 0.0;                   ///< Mean of them without the largest
  double sum = 0.0;                      ///< Squares of the present tenth
  int samples = 0;                       ///< Samples in it
  int steady = 0;                        ///< Samples for which the wrench has been steady
  Eigen::Vector3d v_H = Eigen::Vector3d::Zero();           ///< Of the last sample
  Vector6 fast = Vector6::Zero(), mean = Vector6::Zero();  ///< Wrench by two low-passes
  Vector6 last = Vector6::Zero();                          ///< Wrench of the last sample
  Vector6 carried = Vector6::Zero();                       ///< Wrench that the travel began with
  Eigen::Vector3d carried_up = Eigen::Vector3d::Zero();    ///< Upwards at that time, in S
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();        ///< With that wrench, in B, m
  double jumps = 0.0;     ///< Mean square of a force's change from sample to sample, N^2
  double changing = 1.0;  ///< Share of the periods that bring a new sample
  bool is_untouched = false;
  double braked_s = 0.0;                               ///< How long the twin has been braked
  bool is_known = false;                               ///< The zero has met a steady wrench
  Eigen::Vector3d known_up = Eigen::Vector3d::Zero();  ///< Upwards at that time, in S
  double known_s = 0.0;                                ///< Time since then
  Vector6 zero = Vector6::Zero();                      ///< Drift of the zero since the tare, in S
};

/// Words of the state hash. Filters, and all while the watch does not act, are left out.
void hashed(auto& hash, const RestState& state) {
  const auto& [watched_s, band, blocks, tremor, sum, samples, steady, v_H, fast, mean, last,
               carried, carried_up, travel, jumps, changing, is_untouched, braked_s, is_known,
               known_up, known_s, zero] = state;
  if (is_known || braked_s > 0.0) hash.mix(is_untouched, braked_s, known_s, zero);
}

/// Measures the sensor's noise from what its samples differ by; `w_S`: as they are, before any
/// low-pass. Values that are read again do not count.
void see_noise(double dt, const Vector6& w_S, RestState& rest) noexcept;

/// Advances by one period.
void advance(double dt, const RestInput& input, RestState& rest) noexcept;

/// Whether a hand has trembled in the last 0.4 s, as far as noise of the sensor lets it be seen;
/// `stated`: noise of a force in a sample, rms, N.
bool trembles(double dt, double stated, const RestState& rest) noexcept;

/// Rate at which the twin is braked, 1/s.
double braking_rate(const RestState& rest) noexcept;

}  // namespace hg::estimation
