/// Parameters of the rendering law.
#pragma once

namespace hg::rendering {

struct Options {
  double dt = 1e-3;      ///< nominal period, s; integration uses it
  double kP_tran = 400;  ///< synchronisation (11), 1/s^2; double pole at 20 rad/s with kD
  double kD_tran = 40;   ///< 1/s
  double kP_rot = 400;   ///< 1/s^2
  double kD_rot = 40;    ///< 1/s
};

}  // namespace hg::rendering
