/// Contact of the arm anywhere but at the handle: as detected by the cycle, and its true effect on
/// a simulated bystander. Whether anything touches the handle.
#pragma once

#include "hg/core/fields.h"
#include "hg/core/types.h"

namespace hg {

/// Detected contact with the arm; see compliance/ in hg/controller/safety.
struct TouchReport {
  VectorM torque;
  double share = 0.0;
  bool is_reported = false;
  int joint = -1;
  Vector6 wrench = Vector6::Zero();
};

template <typename Archive, Is<TouchReport> T>
void fields(Archive& a, T& touch) {
  a("torque", touch.torque, "joint torques of the contact; empty: detection is inactive",
    unit::kJointTorque);
  a("share", touch.share, "largest ratio of joint torque to its threshold", unit::kNone);
  a("is_reported", touch.is_reported, "contact detected: the arm yields");
  a("joint", touch.joint, "most distal joint beyond its threshold: its link is touched; -1 = none");
  a("wrench", touch.wrench, "equivalent wrench on the handle: force, torque", unit::kWrench);
}

/// Drift of the force sensor's zero since its tare; hg/controller/estimation/rest_watch.h.
struct RestReport {
  bool is_untouched = false;
  Vector6 zero = Vector6::Zero();
};

template <typename Archive, Is<RestReport> T>
void fields(Archive& a, T& rest) {
  a("is_untouched", rest.is_untouched, "nothing touches the handle: its wrench is steady");
  a("zero", rest.zero, "drift of the sensor's zero since the tare, in S; subtracted",
    unit::kWrench);
}

/// Load on a simulated bystander hit by the arm.
struct BystanderReport {
  double force = 0.0;
  double pressure = 0.0;
  double compression = 0.0;
};

template <typename Archive, Is<BystanderReport> T>
void fields(Archive& a, T& bystander) {
  a("force", bystander.force, "contact force on the body", unit::kN);
  a("pressure", bystander.pressure, "contact pressure", unit::kNPerCm2);
  a("compression", bystander.compression, "compression of the body", unit::kM);
}

}  // namespace hg
