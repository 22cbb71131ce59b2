/// Table I of [HG] by plain matrix products, written apart from the code under test.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "hg/core/types.h"

namespace hg::model {

struct DhFrames {
  Pose hand;   ///< DH frame 6
  Pose elbow;  ///< DH frame 3
};

/// q = (ppu1, ppu2, m1..m6).
inline DhFrames dh_frames(const Eigen::Matrix<double, 8, 1>& q) {
  using std::numbers::pi;
  struct Row {
    double theta, d, a, alpha;
  };
  const std::array<Row, 8> table = {{{0.0, q[0], 0.0, pi / 2},
                                     {pi / 2, q[1], 0.0, pi / 2},
                                     {q[2], 0.0, 0.53, 0.0},
                                     {q[3], 0.0, 0.67, 0.0},
                                     {q[4] + pi, -0.75, 0.0, pi / 2},
                                     {q[5] - pi / 2, 0.0, 0.42, 0.0},
                                     {q[6] + pi / 2, 0.0, 0.0, pi / 2},
                                     {q[7], 0.12, 0.0, 0.0}}};
  // the DH base has x up; B has z up
  Eigen::Matrix4d T;
  T << 0, 0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1;
  Eigen::Matrix4d T_elbow;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto [theta, d, a, alpha] = table[i];
    const double ct = std::cos(theta), st = std::sin(theta);
    const double ca = std::cos(alpha), sa = std::sin(alpha);
    Eigen::Matrix4d A;
    A << ct, -st * ca, st * sa, a * ct, st, ct * ca, -ct * sa, a * st, 0, sa, ca, d, 0, 0, 0, 1;
    T = T * A;
    if (i == 4) T_elbow = T;
  }
  return {{T.topRightCorner<3, 1>(), T.topLeftCorner<3, 3>()},
          {T_elbow.topRightCorner<3, 1>(), T_elbow.topLeftCorner<3, 3>()}};
}

inline double distance(const Pose& a, const Pose& b) {
  return std::max((a.p - b.p).cwiseAbs().maxCoeff(), (a.R - b.R).cwiseAbs().maxCoeff());
}

}  // namespace hg::model
