/// What touches the arm anywhere but at the handle: as the cycle feels it, and what it really does
/// to a simulated bystander.
#pragma once

#include "hg/core/types.h"

namespace hg {

/// What the cycle feels of something that touches the arm; hg/compliance.
struct TouchReport {
  VectorM torque;        ///< on the joints by what touches the arm, Nm; empty: it is not felt for
  double share = 0.0;    ///< of the joint's threshold that its torque has reached, the largest
  bool is_told = false;  ///< beyond its threshold: the arm gives way
  int joint = -1;        ///< the last one that feels it, whose link is touched; -1 = none
  Vector6 wrench = Vector6::Zero();  ///< on the handle, that does the same to the joints
};

/// What a simulated bystander bears, whom the arm hits.
struct BystanderReport {
  double force = 0.0;        ///< N
  double pressure = 0.0;     ///< N/cm^2
  double compression = 0.0;  ///< m
};

}  // namespace hg
