/// Contact of the arm anywhere but at the handle: as detected by the cycle, and its true effect on
/// a simulated bystander.
#pragma once

#include "hg/core/fields.h"
#include "hg/core/types.h"

namespace hg {

/// Detected contact with the arm; see compliance/ in hg/controller/safety.
struct TouchReport {
  VectorM torque;            ///< Joint torques of the contact, Nm; empty: detection is inactive
  double share = 0.0;        ///< Largest ratio of joint torque to its threshold
  bool is_reported = false;  ///< Contact detected: the arm yields
  int joint = -1;  ///< Most distal joint beyond its threshold: its link is touched; -1 = none
  Vector6 wrench = Vector6::Zero();  ///< Equivalent wrench on the handle
};

template <typename Archive, Is<TouchReport> T>
void fields(Archive& a, T& touch) {
  a("torque", touch.torque, "joint torques of the contact, Nm; empty: detection is inactive");
  a("share", touch.share, "largest ratio of joint torque to its threshold");
  a("is_reported", touch.is_reported, "contact detected: the arm yields");
  a("joint", touch.joint, "most distal joint beyond its threshold; -1 = none");
  a("wrench", touch.wrench, "equivalent wrench on the handle: force N, torque Nm");
}

/// Load on a simulated bystander hit by the arm.
struct BystanderReport {
  double force = 0.0;        ///< Contact force, N
  double pressure = 0.0;     ///< Contact pressure, N/cm^2
  double compression = 0.0;  ///< Compression of the body, m
};

template <typename Archive, Is<BystanderReport> T>
void fields(Archive& a, T& bystander) {
  a("force", bystander.force, "contact force on the body, N");
  a("pressure", bystander.pressure, "contact pressure, N/cm^2");
  a("compression", bystander.compression, "compression of the body, m");
}

}  // namespace hg
