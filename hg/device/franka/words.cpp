#include "hg/device/franka/words.h"

#include <fmt/format.h>

namespace hg::franka {
namespace {

constexpr std::array<std::string_view, kErrors> kErrorNames = {
    "joint_position_limits_violation",
    "cartesian_position_limits_violation",
    "self_collision_avoidance_violation",
    "joint_velocity_violation",
    "cartesian_velocity_violation",
    "force_control_safety_violation",
    "joint_reflex",
    "cartesian_reflex",
    "max_goal_pose_deviation_violation",
    "max_path_pose_deviation_violation",
    "cartesian_velocity_profile_safety_violation",
    "joint_position_motion_generator_start_pose_invalid",
    "joint_motion_generator_position_limits_violation",
    "joint_motion_generator_velocity_limits_violation",
    "joint_motion_generator_velocity_discontinuity",
    "joint_motion_generator_acceleration_discontinuity",
    "cartesian_position_motion_generator_start_pose_invalid",
    "cartesian_motion_generator_elbow_limit_violation",
    "cartesian_motion_generator_velocity_limits_violation",
    "cartesian_motion_generator_velocity_discontinuity",
    "cartesian_motion_generator_acceleration_discontinuity",
    "cartesian_motion_generator_elbow_sign_inconsistent",
    "cartesian_motion_generator_start_elbow_invalid",
    "force_controller_desired_force_tolerance_violation",
    "start_elbow_sign_inconsistent",
    "communication_constraints_violation",
    "power_limit_violation",
    "cartesian_motion_generator_joint_position_limits_violation",
    "cartesian_motion_generator_joint_velocity_limits_violation",
    "cartesian_motion_generator_joint_velocity_discontinuity",
    "cartesian_motion_generator_joint_acceleration_discontinuity",
    "cartesian_position_motion_generator_invalid_frame_flag",
    "controller_torque_discontinuity",
    "joint_p2p_insufficient_torque_for_planning",
    "tau_J_range_violation",
    "instability_detected",
    "joint_move_in_wrong_direction",
    "cartesian_spline_motion_generator_violation",
    "joint_via_motion_generator_planning_joint_limit_violation",
    "base_acceleration_initialization_timeout",
    "base_acceleration_invalid_reading"};

}  // namespace

ErrorBits errors_of(const RobotState& state) noexcept {
  ErrorBits bits;
  for (std::size_t i = 0; i < kErrors; ++i) {
    bits[i] = state.errors[i] != 0 || state.reflex_reason[i] != 0;
  }
  return bits;
}

std::string_view error_name(int index) noexcept { return kErrorNames[index]; }

std::string to_string(const ErrorBits& errors) {
  std::string names;
  for (int i = 0; i < kErrors; ++i) {
    if (!errors[i]) continue;
    names += names.empty() ? "" : ", ";
    names += error_name(i);
  }
  return names;
}

std::string_view to_string(RobotMode mode) noexcept {
  switch (mode) {
    case RobotMode::kOther:
      return "other";
    case RobotMode::kIdle:
      return "idle";
    case RobotMode::kMove:
      return "move";
    case RobotMode::kGuiding:
      return "guiding";
    case RobotMode::kReflex:
      return "reflex";
    case RobotMode::kUserStopped:
      return "user stopped";
    case RobotMode::kAutomaticErrorRecovery:
      return "automatic error recovery";
  }
  return "unknown";
}

std::string_view to_string(MoveStatus status) noexcept {
  switch (status) {
    case MoveStatus::kSuccess:
      return "finished";
    case MoveStatus::kMotionStarted:
      return "started";
    case MoveStatus::kPreempted:
      return "preempted";
    case MoveStatus::kPreemptedBySafety:
      return "preempted by a safety function";
    case MoveStatus::kRejectedBySafety:
      return "rejected by an active safety function";
    case MoveStatus::kNotPossible:
      return "rejected: not possible in the present mode";
    case MoveStatus::kSingularPose:
      return "rejected: cannot start in a singular pose";
    case MoveStatus::kInvalidArgument:
      return "rejected: invalid argument";
    case MoveStatus::kReflexAborted:
      return "aborted by a reflex";
    case MoveStatus::kEmergencyAborted:
      return "aborted by the user stop";
    case MoveStatus::kInputErrorAborted:
      return "aborted: invalid input";
    case MoveStatus::kAborted:
      return "aborted";
  }
  return "answered with an unknown status";
}

std::string answer_words(Command command, std::uint8_t status) {
  constexpr std::array<std::string_view, 4> kSetting = {
      "success", "not possible in the present mode", "invalid argument",
      "rejected by an active safety function"};
  constexpr std::array<std::string_view, 7> kRecovery = {"success",
                                                         "not possible in the present mode",
                                                         "rejected by an active safety function",
                                                         "must be done by hand in Desk",
                                                         "aborted by a reflex",
                                                         "aborted by the user stop",
                                                         "aborted"};
  if (command == Command::kMove) return std::string(to_string(static_cast<MoveStatus>(status)));
  if (command == Command::kAutomaticErrorRecovery && status < kRecovery.size()) {
    return std::string(kRecovery[status]);
  }
  if (status < kSetting.size()) return std::string(kSetting[status]);
  return fmt::format("unknown status {}", status);
}

}  // namespace hg::franka
