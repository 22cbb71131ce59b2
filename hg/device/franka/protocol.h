/// Messages of the Franka Control Interface (FCI), version 10: an FR3 with system 5.9 or newer.
///
/// Source: libfranka-common d96c221, include/research_interface/robot/{service_types,rbk_types,
/// error}.h: layouts and numbers. Copyright 2024 Franka Robotics GmbH, Apache-2.0. Differs from it:
/// truth values are bytes, because untrusted bytes are read; poses are named as ours. Packed,
/// little endian. SI units; matrices column by column; frames O (base), F (flange), ee (end
/// effector), K (where stiffness and external wrench are meant).
///
/// Commands and answers go through TCP, each behind a CommandHeader; states and commands of a
/// motion through UDP, one per datagram, 1000 per second.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace hg::franka {

static_assert(std::endian::native == std::endian::little);

inline constexpr std::uint16_t kVersion = 10;
inline constexpr const char* kCommandPort = "1337";
inline constexpr int kJoints = 7;
inline constexpr int kErrors = 41;
inline constexpr double kPeriod_s = 1e-3;

enum class Command : std::uint32_t {
  kConnect = 0,
  kMove = 1,
  kStopMove = 2,
  kSetCollisionBehavior = 3,
  kSetLoad = 9,
  kAutomaticErrorRecovery = 10,
};

enum class RobotMode : std::uint8_t {
  kOther = 0,
  kIdle = 1,
  kMove = 2,
  kGuiding = 3,
  kReflex = 4,
  kUserStopped = 5,
  kAutomaticErrorRecovery = 6,
};

/// Result of a Move; the first answer of a motion that begins is kMotionStarted.
enum class MoveStatus : std::uint8_t {
  kSuccess = 0,
  kMotionStarted = 1,
  kPreempted = 2,
  kPreemptedBySafety = 3,
  kRejectedBySafety = 4,
  kNotPossible = 5,
  kSingularPose = 6,
  kInvalidArgument = 7,
  kReflexAborted = 8,
  kEmergencyAborted = 9,
  kInputErrorAborted = 10,
  kAborted = 11,
};

// modes of a motion that is driven by torques, in a Move and in a state
inline constexpr std::uint32_t kExternalController = 2;
inline constexpr std::uint32_t kMoveWithoutGenerator = 4;
inline constexpr std::uint8_t kStateWithoutGenerator = 5;
// and of one that is driven by speeds of the joints, which the robot's own control follows
inline constexpr std::uint32_t kJointImpedance = 0;
inline constexpr std::uint32_t kMoveByJointVelocity = 1;
inline constexpr std::uint8_t kStateByJointVelocity = 2;

/// Index of an error bit that has a fault of its own here.
inline constexpr int kCommunicationError = 25;

#pragma pack(push, 1)

struct CommandHeader {
  Command command = Command::kConnect;
  std::uint32_t id = 0;    ///< number of the command, repeated in its answers
  std::uint32_t size = 0;  ///< of the whole message, bytes
};

struct ConnectRequest {
  std::uint16_t version = kVersion;
  std::uint16_t udp_port = 0;  ///< where the client waits for states
};

/// The robot decides whether the client's version is good enough; where it is not, its own version
/// says why. libfranka does not look at the version of a robot that accepts, either.
struct ConnectAnswer {
  std::uint8_t status = 0;    ///< 0: connected
  std::uint16_t version = 0;  ///< version of the robot
};

struct Deviation {
  double translation = 10.0, rotation = 3.12, elbow = 2.0 * 3.14159265358979323846;
};

/// Defaults: a motion by torques, with libfranka's deviations, which do not matter for it.
struct MoveRequest {
  std::uint32_t controller_mode = kExternalController;
  std::uint32_t motion_generator_mode = kMoveWithoutGenerator;
  Deviation path, goal;
  std::uint8_t is_asynchronous = 0;
  std::array<double, kJoints> largest_velocity{};
};

/// Contact above the lower thresholds is reported, above the upper ones stops the robot.
struct CollisionRequest {
  std::array<double, kJoints> lower_torque_accelerating{}, upper_torque_accelerating{};
  std::array<double, kJoints> lower_torque{}, upper_torque{};
  std::array<double, 6> lower_force_accelerating{}, upper_force_accelerating{};
  std::array<double, 6> lower_force{}, upper_force{};
};

struct LoadRequest {
  double mass = 0.0;                 ///< kg
  std::array<double, 3> p_F_load{};  ///< centre of mass in F, m
  std::array<double, 9> inertia{};   ///< about the centre of mass, kg m^2
};

struct RobotState {
  std::uint64_t message_id = 0;  ///< milliseconds of the robot's clock
  std::array<float, 16> T_O_ee, T_O_ee_d, T_F_ee, T_ee_K, T_F_ne, T_ne_ee;
  float m_ee;
  std::array<float, 9> I_ee;
  std::array<float, 3> p_F_ee;
  float m_load;
  std::array<float, 9> I_load;
  std::array<float, 3> p_F_load;
  std::array<float, 2> elbow, elbow_d;
  std::array<float, kJoints> tau_J;    ///< joint torque sensors, Nm
  std::array<float, kJoints> tau_J_d;  ///< torques of the last command in effect, Nm
  std::array<float, kJoints> dtau_J, q, q_d, dq, dq_d, ddq_d;
  std::array<float, kJoints> joint_contact;
  std::array<float, 6> cartesian_contact;
  std::array<float, kJoints> joint_collision;
  std::array<float, 6> cartesian_collision;
  /// Measured torques minus those of the robot's model, Nm.
  std::array<float, kJoints> tau_ext_hat_filtered;
  /// Estimated wrench of the robot on its surroundings at K: resolved in O, resolved in K.
  std::array<float, 6> O_F_ext_hat_K, K_F_ext_hat_K;
  std::array<float, 6> twist_ee_d;
  std::array<float, 3> acceleration_O;
  std::array<float, 2> elbow_c, delbow_c, ddelbow_c;
  std::array<float, 16> T_O_ee_c;
  std::array<float, 6> twist_ee_c, acceleration_ee_c;
  std::array<float, kJoints> theta, dtheta;
  std::array<float, 18> accelerometer_top, accelerometer_bottom;
  std::uint8_t motion_generator_mode;
  std::uint8_t controller_mode;
  std::array<std::uint8_t, kErrors> errors;         ///< errors of the moment
  std::array<std::uint8_t, kErrors> reflex_reason;  ///< what has ended the last motion
  RobotMode robot_mode;
  float control_command_success_rate;  ///< share of the last 100 commands that came in time
};
static_assert(sizeof(RobotState) == 1377);

struct RobotCommand {
  std::uint64_t message_id = 0;  ///< of the state that is answered
  std::array<double, kJoints> q_c{}, dq_c{};
  std::array<double, 16> T_O_ee_c{};
  std::array<double, 6> twist_ee_c{};
  std::array<double, 2> elbow_c{};
  std::uint8_t valid_elbow = 0;
  std::uint8_t motion_generation_finished = 0;
  std::array<double, kJoints> tau_J_d{};  ///< beyond gravity, which the robot adds, Nm
  std::uint8_t torque_command_finished = 0;
};
static_assert(sizeof(RobotCommand) == 371);
static_assert(sizeof(CommandHeader) == 12);
static_assert(sizeof(MoveRequest) == 113);
static_assert(sizeof(CollisionRequest) == 416);
static_assert(sizeof(LoadRequest) == 104);

#pragma pack(pop)

}  // namespace hg::franka
