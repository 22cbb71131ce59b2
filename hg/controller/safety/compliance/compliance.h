/// Detects contacts of the arm and computes how the arm yields to them.
///
/// Detection: the torque of the joints that neither motion nor user explain, M ddq + c - J^T w -
/// tau_J with measured speeds, low-passed. With ddq as their difference this is the observer of the
/// generalised momentum of De Luca et al. (IROS 2006), discrete, gain 1 / filter. A threshold is
/// the sum of a minimum, of six standard deviations of the noise without contact, and of a share of
/// the torque that has just moved the joint, to cover model errors.
///
/// Yielding: the torques beyond the thresholds are mapped to the wrench on the handle with the same
/// effect on the joints, by damped least squares. It pushes the twin, which yields where it is
/// free; the gantry moves away from the contact.
///
/// Pure functions of arguments and state: deterministic, no allocation, noexcept.
#pragma once

#include <cstdint>

#include "hg/controller/safety/compliance/compliance_config.h"
#include "hg/core/types.h"
#include "hg/model/device_model.h"
#include "hg/signals/touch.h"

namespace hg::compliance {

/// The twin yields with no larger wrench than kForceMax and kMomentMax.
inline constexpr double kForceMax = 100.0;   // N
inline constexpr double kMomentMax = 30.0;   // Nm
inline constexpr double kGantrySpeed = 0.3;  // m/s or rad/s, away from the contact

/// Part of the copyable state of a cycle.
struct ComplianceState {
  bool is_started = false;
  VectorM dq;        ///< Joint speeds in the last sample, rad/s
  VectorM torque;    ///< Joint torques of the contact, low-passed, Nm
  VectorM variance;  ///< Variance of `torque` without contact, Nm^2
  VectorM load;      ///< Torques that have just moved the joints, Nm
  bool is_reported = false;
  double quiet_s = 0.0;  ///< Time for which less than half of the thresholds is felt, s
  VectorP away;          ///< Velocity of the gantry, m/s or rad/s; empty: its own aim
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const ComplianceState& state) {
  const auto& [is_started, dq, torque, variance, load, is_reported, quiet_s, away] = state;
  hash.mix(std::uint64_t{is_started} | std::uint64_t{is_reported} << 1U, dq, torque, variance, load,
           quiet_s, away);
}

using JacobianIn = Eigen::Ref<const Eigen::Matrix<double, 6, Eigen::Dynamic>>;

/// Peak torque of each joint, Nm; empty: the joints have no actuators.
VectorM peak_torques(const DeviceModel& device);

/// One sample.
struct ComplianceInput {
  VectorM torque;  ///< Joint torques explained by neither motion nor user, Nm
  VectorM load;    ///< Model torques that move and hold the joints, Nm
  JacobianIn J;    ///< Jacobian of the handle; gantry joints first
  int n_p = 0;     ///< Number of gantry joints
};

/// Advances by one sample of `dt` (s); call once per cycle with the drives on. `torque_max`: peak
/// torque of each joint, Nm.
TouchReport react_to_contact(const VectorM& torque_max, double dt, const ComplianceInput& input,
                             ComplianceState& state) noexcept;

/// Torque from which a joint reports a contact, Nm.
double threshold(const VectorM& torque_max, const ComplianceState& state, int joint) noexcept;

}  // namespace hg::compliance
