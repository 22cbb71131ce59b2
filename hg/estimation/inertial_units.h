/// Accelerations of the joints, and what links and gantry bend, from inertial units on the links.
///
/// Encoders say where joints are; how they are accelerated is known from the reference (which the
/// joints do not follow exactly) or by differences (which are noise). Units on the links see
/// accelerations themselves, and what no encoder sees: that the structure bends. In each period
/// the accelerations of all joints and those of a bent root are the most likely ones (ridge
/// regression) of what the units show, what the reference says being the prior. How far joints and
/// structure usually are from that, and how the units sit (unit_calibration.h), is learnt while the
/// device moves. Works with any number of units anywhere; a
/// unit that shows nothing new, nonsense, or what nothing explains, does not take part.
///
/// "pm" are all joints, the gantry's first. The root is the origin of the first unit's link, where
/// the bending is told as if all of it were there. No allocation, noexcept after set-up.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hg/core/stacked.h"
#include "hg/core/types.h"
#include "hg/estimation/unit_calibration.h"
#include "hg/model/chain.h"
#include "hg/signals/state.h"

namespace hg::estimation {

using UnitCalibrations = std::array<UnitCalibration, kMaxInertialUnits>;

/// Set-up data.
struct InertialUnitsConfig {
  std::vector<int>
      frames;           ///< of the chain: links with a unit, root to tip; empty = there are none
  double delay = 1e-3;  ///< from motion to reading, s; rounded to periods, at least one
  bool feeds_back = false;  ///< true: the control uses what they say; false: it is only reported
  /// How they sit, where that is known from an earlier run of the same device; null = it is learnt.
  std::shared_ptr<const UnitCalibrations> known;
};

/// Joints by encoders alone.
struct EncoderSample {
  VectorPM measured;      ///< what the encoders show, unwrapped
  VectorPM q, dq;         ///< what their observers make of it
  VectorPM ddq_expected;  ///< since the last sample, of the reference and of the drives' model
};

struct InertialUnitsState {
  static constexpr int kPast = 16;  ///< periods that are remembered

  bool is_started = false;
  UnitCalibrations units;
  std::array<UnitReading, kMaxInertialUnits> last;  ///< readings of the last period
  std::array<int, kMaxInertialUnits> same{};        ///< for how many periods they have not changed
  VectorUpTo<kMaxInertialUnits> trust;              ///< share with which each takes part, 0..1
  std::array<EncoderSample, kPast> past;            ///< a ring
  std::size_t newest = 0;
  int seen = 0;          ///< periods since the start, up to kPast
  std::size_t turn = 0;  ///< the unit whose calibration is solved next
  VectorUpTo<kMaxGantry + kMaxManipulator + 6> found;  ///< accelerations beyond the expected, root
  VectorUpTo<kMaxGantry + kMaxManipulator + 6> carried;   ///< of a unit that has gone, fading
  VectorUpTo<kMaxGantry + kMaxManipulator + 6> variance;  ///< usual ones of what is found
  VectorUpTo<kMaxInertialUnits> error;  ///< mean square of what remains unexplained, (m/s^2)^2
  VectorPM unseen;  ///< variance of each joint's acceleration that is left, 0..1
  VectorPM q, dq;   ///< at the time of the readings
  Vector6 bend_rate = Vector6::Zero(), bend = Vector6::Zero();
  double share = 0.0;  ///< with which the control uses it, 0..1
};

class InertialUnits {
 public:
  /// `chain` holds the gantry joints first. Throws SetupError where there are more units than
  /// kMaxInertialUnits or the delay is longer than what is remembered.
  InertialUnits(const InertialUnitsConfig& config, double dt, double link_pole_Hz,
                double gantry_pole_Hz, const model::Chain& chain, int n_p);

  bool has_any() const noexcept { return !config_.frames.empty(); }
  /// Takes the readings of a period, as SensorFrame::inertial has them, and the encoders'.
  void step(const InertialReadings& readings, const EncoderSample& encoders,
            InertialUnitsState& state) noexcept;
  /// Joints now, with what the units say; bending as it was when they saw it.
  InertialReport report(const InertialUnitsState& state) const noexcept;
  /// Puts it in the place of the encoders' estimates, as far as it is trusted; nothing unless it
  /// feeds back.
  void feed_back(const InertialUnitsState& state, RobotState& robot) const noexcept;

 private:
  static constexpr int kMostUnknowns = kMaxGantry + kMaxManipulator + 6;
  using Unknowns = VectorUpTo<kMostUnknowns>;
  using Normal = MatrixUpTo<kMostUnknowns, kMostUnknowns>;
  using Rows = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostUnknowns>;

  using Rests = std::array<Eigen::Vector3d, kMaxInertialUnits>;

  LinkMotion motion_of(int frame, const VectorPM& ddq) const noexcept;
  Rows effect_on(const UnitCalibration& unit, int frame) const noexcept;
  void start(const EncoderSample& encoders, InertialUnitsState& state) const noexcept;
  bool judge(std::size_t unit, const UnitReading& reading, const LinkMotion& by_encoders,
             const Eigen::Vector3d& beyond, InertialUnitsState& state) const noexcept;
  void learn_deviations(const Unknowns& found, const Unknowns& left, const Rests& rests,
                        InertialUnitsState& state) const noexcept;
  bool is_alive(std::size_t unit, const UnitReading& reading,
                InertialUnitsState& state) const noexcept;
  void observe(const EncoderSample& then, InertialUnitsState& state) const noexcept;
  const EncoderSample& ago(int periods, const InertialUnitsState& state) const noexcept;

  InertialUnitsConfig config_;
  double dt_;
  VectorPM slow_Hz_;   ///< poles of joints whose acceleration is seen
  VectorPM fast_Hz_;   ///< and of those where it is not
  Unknowns variance_;  ///< of what is to be found, before anything is known
  model::Chain chain_;
  int n_p_, n_;
  int delay_;  ///< periods
};

}  // namespace hg::estimation
