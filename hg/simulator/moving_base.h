/// A place that sways, as on a ship: the root link of the twin moves with it.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/signals/twin_force_source.h"

namespace hg::simulator {

/// Direction of a swing: along or about an axis of B.
enum class SwingDirection : std::uint8_t { kX, kY, kZ, kRx, kRy, kRz };

/// amplitude (sin(2 pi t / period + phase) - sin(phase))
struct Swing {
  SwingDirection direction = SwingDirection::kZ;
  double amplitude = 0.0;  ///< m or rad
  double period = 6.0;     ///< s
  double phase = 0.0;      ///< rad
};

struct MovingBaseConfig {
  Pose T_B_A;                                         ///< Root link of the twin at rest
  Eigen::Vector3d p_about = Eigen::Vector3d::Zero();  ///< Point that only translates, in B, m
  std::vector<Swing> swings;                          ///< Turns: Rz Ry Rx of their sums
  double begin = 2.0;                                 ///< Time in which the motion begins, s
  double end = 0.2;                                   ///< Time in which it ends, s
};

/// Throws SetupError naming the field that is out of range.
void check_moving_base(const MovingBaseConfig& config);

/// The motion begins with the run and rests while the device does.
class MovingBase final : public TwinBaseSource {
 public:
  /// Throws SetupError.
  MovingBase(const MovingBaseConfig& config, double dt);
  TwinBase step(bool is_running, bool is_apart) noexcept override;

 private:
  MovingBaseConfig config_;
  double dt_;
  double time_ = 0.0, pace_ = 0.0;  ///< Time of the motion, s, and its change per time, 0..1
};

}  // namespace hg::simulator
