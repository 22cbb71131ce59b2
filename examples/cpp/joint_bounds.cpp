// How hard may a joint accelerate on its way to a stop? Full speed ahead until it rests there.
#include <cstdio>

#include "hg/limits/acceleration_bounds.h"

int main() {
  constexpr double kPeriod = 1e-3;  // s
  const hg::limits::JointLimits limits{.q_min = -1, .q_max = 1, .dq_max = 2, .ddq_max = 10};
  hg::limits::check_joint_limits(limits, "joint m1");
  const auto options = hg::limits::recoverable_options(limits, kPeriod, kPeriod);

  double q = 0.0, dq = 0.0;  // rad, rad/s
  for (int k = 0; k < 1000; ++k) {
    const double ddq = hg::limits::recoverable_bounds(limits, options, q, dq, kPeriod).ub;
    if (k % 200 == 0) std::printf("q %6.3f  dq %6.3f  ddq at most %7.3f\n", q, dq, ddq);
    q += kPeriod * dq + 0.5 * kPeriod * kPeriod * ddq;
    dq += kPeriod * ddq;
  }
  std::printf("rests at %.6f rad\n", q);
}
