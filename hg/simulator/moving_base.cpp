#include "hg/simulator/moving_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "hg/core/error.h"

namespace hg::simulator {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

// Of one direction, and how it changes with the time of the motion.
struct Displacement {
  double x = 0.0, dx = 0.0, ddx = 0.0;
};

using Displacements = std::array<Displacement, 6>;

Displacements sum(const std::vector<Swing>& swings, double time) noexcept {
  Displacements all{};
  for (const Swing& swing : swings) {
    Displacement& one = all[static_cast<std::size_t>(swing.direction)];
    const double rate = 2.0 * std::numbers::pi / swing.period;
    const double angle = rate * time + swing.phase;
    one.x += swing.amplitude * (std::sin(angle) - std::sin(swing.phase));
    one.dx += swing.amplitude * rate * std::cos(angle);
    one.ddx -= swing.amplitude * rate * rate * std::sin(angle);
  }
  return all;
}

}  // namespace

void check_moving_base(const MovingBaseConfig& config) {
  const auto require = [](bool ok, const char* rule, double value) {
    if (!ok)
      throw SetupError(std::string("moving base: ") + rule + ", got " + std::to_string(value));
  };
  constexpr double kFastest = 1.0, kFastestTurn = 1.0;  // m/s, rad/s
  constexpr double kHardest = 5.0, kHardestTurn = 5.0;  // m/s^2, rad/s^2
  std::array<double, 6> speed{}, acceleration{};
  for (const Swing& swing : config.swings) {
    require(swing.period > 0.0, "period must be positive", swing.period);
    require(std::isfinite(swing.amplitude), "amplitude must be finite", swing.amplitude);
    const double rate = 2.0 * std::numbers::pi / swing.period;
    const auto i = static_cast<std::size_t>(swing.direction);
    speed[i] += std::abs(swing.amplitude) * rate;
    acceleration[i] += std::abs(swing.amplitude) * rate * rate;
  }
  for (std::size_t i = 0; i < speed.size(); ++i) {
    const bool turns = i >= 3;
    require(speed[i] <= (turns ? kFastestTurn : kFastest),
            "must move with at most 1 m/s and 1 rad/s in a direction", speed[i]);
    require(acceleration[i] <= (turns ? kHardestTurn : kHardest),
            "must accelerate with at most 5 m/s^2 and 5 rad/s^2 in a direction", acceleration[i]);
  }
  require(config.begin > 0.0, "begin must be positive", config.begin);
  require(config.end > 0.0, "end must be positive", config.end);
}

MovingBase::MovingBase(const MovingBaseConfig& config, double dt)
    : config_((check_moving_base(config), config)), dt_(dt) {}

TwinBase MovingBase::step(bool is_running, bool is_apart) noexcept {
  const double pace = pace_;
  const double change = is_running ? dt_ / config_.begin : -dt_ / config_.end;
  pace_ = std::clamp(pace_ + change, 0.0, 1.0);
  if (!is_running && is_apart && pace_ == 0.0) time_ = 0.0;
  const double pace_rate = (pace_ - pace) / dt_;

  Displacements d = sum(config_.swings, time_);
  for (Displacement& one : d) {
    one.ddx = one.ddx * pace * pace + one.dx * pace_rate;
    one.dx *= pace;
  }
  // Rz Ry Rx; each turns about an axis that those before it have turned
  const Eigen::Matrix3d R_z = AngleAxisd(d[5].x, Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d R_zy = R_z * AngleAxisd(d[4].x, Vector3d::UnitY()).toRotationMatrix();
  const Eigen::Matrix3d R = R_zy * AngleAxisd(d[3].x, Vector3d::UnitX()).toRotationMatrix();
  const Vector3d ez = Vector3d::UnitZ(), ey = R_z.col(1), ex = R_zy.col(0);
  const Vector3d omega_z = d[5].dx * ez, omega_y = d[4].dx * ey, omega_x = d[3].dx * ex;
  const Vector3d omega = omega_z + omega_y + omega_x;
  const Vector3d alpha = d[5].ddx * ez + d[4].ddx * ey + d[3].ddx * ex + omega_z.cross(omega_y) +
                         Vector3d(omega_z + omega_y).cross(omega_x);

  const Vector3d lever = R * (config_.T_B_A.p - config_.p_about);
  TwinBase base;
  base.is_moving = true;
  base.T_B_A.R = R * config_.T_B_A.R;
  base.T_B_A.p = config_.p_about + Vector3d(d[0].x, d[1].x, d[2].x) + lever;
  base.twist << Vector3d(d[0].dx, d[1].dx, d[2].dx) + omega.cross(lever), omega;
  base.acceleration << Vector3d(d[0].ddx, d[1].ddx, d[2].ddx) + alpha.cross(lever) +
                           omega.cross(omega.cross(lever)),
      alpha;
  // the acceleration holds for the period
  time_ += dt_ * (pace + 0.5 * dt_ * pace_rate);
  return base;
}

}  // namespace hg::simulator
