/// Joint accelerations, and bending of links and gantry, from inertial units on the links.
///
/// Encoders measure joint positions; accelerations are known from the reference (which the joints
/// do not follow exactly) or by differences (which are noise). Units on the links measure
/// accelerations directly, and also the bending of the structure, which no encoder shows. In each
/// period the accelerations of all joints and those of a bent root are the most likely ones (ridge
/// regression) given the readings of the units, with the reference as prior. The usual deviations
/// of joints and structure from it, and the mounting of the units (unit_calibration.h), are learnt
/// while the device moves. Works with any number of units anywhere; a unit that shows nothing new,
/// nonsense, or what nothing explains, is ignored.
///
/// "pm" are all joints, the gantry's first. The root is the origin of the first unit's link, to
/// which all bending is attributed. No allocation, noexcept after set-up.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hg/controller/estimation/estimation_config.h"
#include "hg/controller/estimation/unit_calibration.h"
#include "hg/core/stacked.h"
#include "hg/core/types.h"
#include "hg/model/chain_data.h"
#include "hg/signals/state.h"

namespace hg::estimation {

/// Joints by encoders alone.
struct EncoderSample {
  VectorPM measured;      ///< Encoder positions, unwrapped
  VectorPM q, dq;         ///< Positions and speeds by the encoders' observers
  VectorPM ddq_expected;  ///< Acceleration since the last sample, by reference and drive model
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const EncoderSample& sample) {
  const auto& [measured, q, dq, ddq_expected] = sample;
  hash.mix(measured, q, dq, ddq_expected);
}

struct InertialUnitsState {
  static constexpr int kPast = 16;  ///< Number of stored periods

  bool is_started = false;
  UnitCalibrations units;
  std::array<UnitReading, kMaxInertialUnits> last;  ///< Readings of the last period
  std::array<int, kMaxInertialUnits> same{};  ///< Periods for which each reading has not changed
  VectorUpTo<kMaxInertialUnits> trust;        ///< Share with which each unit takes part, 0..1
  std::array<EncoderSample, kPast> past;      ///< Ring buffer of the last periods
  std::size_t newest = 0;
  int seen = 0;          ///< Periods since the start, up to kPast
  std::size_t turn = 0;  ///< Index of the unit whose calibration is solved next
  /// Accelerations beyond the expected: joints, root.
  VectorUpTo<kMaxGantry + kMaxManipulator + 6> found;
  /// Part of a unit that dropped out, fading.
  VectorUpTo<kMaxGantry + kMaxManipulator + 6> carried;
  VectorUpTo<kMaxGantry + kMaxManipulator + 6> variance;  ///< Usual variances of `found`
  VectorUpTo<kMaxInertialUnits> error;  ///< Mean square of what remains unexplained, (m/s^2)^2
  VectorPM unseen;                      ///< Remaining variance of each joint's acceleration, 0..1
  VectorPM q, dq;                       ///< Joints at the time of the readings
  Vector6 bend_rate = Vector6::Zero(), bend = Vector6::Zero();
  double share = 0.0;  ///< Share with which the control uses the units, 0..1
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const InertialUnitsState& state) {
  const auto& [is_started, units, last, same, trust, past, newest, seen, turn, found, carried,
               variance, error, unseen, q, dq, bend_rate, bend, share] = state;
  for (int i = 0; i < trust.size(); ++i) hash.mix(units[i], same[i]);
  hash.mix(past[newest], trust, found, carried, unseen, q, dq, variance, error, bend_rate, bend,
           share);
}

class InertialUnits {
 public:
  /// `chain` holds the gantry joints first. Throws SetupError where there are more units than
  /// kMaxInertialUnits or the delay is longer than what is remembered.
  InertialUnits(const InertialUnitsConfig& config, double dt, double link_pole_Hz,
                double gantry_pole_Hz, const model::ChainModel& chain, int n_p);

  bool has_any() const noexcept { return !config_.frames.empty(); }
  /// Processes the readings of a period, as SensorFrame::inertial has them, and the encoders'.
  void step(const InertialReadings& readings, const EncoderSample& encoders,
            InertialUnitsState& state) noexcept;
  /// Present joint state by the units; bending as at the time of the readings.
  InertialReport report(const InertialUnitsState& state) const noexcept;
  /// Replaces the encoders' estimates by the units', as far as these are trusted; no effect unless
  /// feeds_back.
  void feed_back(const InertialUnitsState& state, RobotState& robot) const noexcept;

 private:
  static constexpr int kMostUnknowns = kMaxGantry + kMaxManipulator + 6;
  using Unknowns = VectorUpTo<kMostUnknowns>;
  using Normal = MatrixUpTo<kMostUnknowns, kMostUnknowns>;
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostUnknowns>;

  using Rests = std::array<Eigen::Vector3d, kMaxInertialUnits>;

  /// Normal equations of all unknowns, and of the turning that gyroscopes add.
  struct Equations {
    Normal normal;
    Unknowns sum;
    Eigen::Matrix3d turn_normal;
    Eigen::Vector3d turn_sum = Eigen::Vector3d::Zero();
    std::array<Rows, kMaxInertialUnits> rows;  ///< Rows of the units that take part
    Rests rests;                               ///< Readings beyond what is expected and found
    bool has_lost_one = false;                 ///< A unit took part and has dropped out
  };

  LinkMotion motion_of(int frame, const VectorPM& ddq) const noexcept;
  Rows effect_on(const UnitCalibration& unit, int frame) const noexcept;
  void start(const EncoderSample& encoders, InertialUnitsState& state) const noexcept;
  bool judge(std::size_t unit, const UnitReading& reading, const LinkMotion& by_encoders,
             const Eigen::Vector3d& beyond, InertialUnitsState& state) const noexcept;
  void learn_deviations(const Unknowns& found, const Unknowns& left, const Rests& rests,
                        InertialUnitsState& state) const noexcept;
  bool is_alive(std::size_t unit, const UnitReading& reading,
                InertialUnitsState& state) const noexcept;
  Equations equations(const InertialReadings& readings, const VectorPM& by_encoders,
                      const VectorPM& by_reference, InertialUnitsState& state) const noexcept;
  void solve_for_motion(const EncoderSample& then, Equations& equations,
                        InertialUnitsState& state) const noexcept;
  void observe(const EncoderSample& then, InertialUnitsState& state) const noexcept;
  const EncoderSample& ago(int periods, const InertialUnitsState& state) const noexcept;

  InertialUnitsConfig config_;
  double dt_;
  VectorPM slow_Hz_;   ///< Observer poles of joints whose acceleration is seen
  VectorPM fast_Hz_;   ///< Observer poles of joints whose acceleration is not seen
  Unknowns variance_;  ///< Prior variances of the unknowns
  model::ChainData chain_;
  int n_p_, n_;
  int delay_;  ///< Delay in periods
};

}  // namespace hg::estimation
