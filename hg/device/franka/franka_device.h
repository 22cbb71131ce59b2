/// A Franka FR3 as a device: torques or speeds through its research interface, the robot is the
/// clock.
///
/// Set-up (constructor, close()) may block for a bounded time and throw; read() and write() follow
/// the contract of Device, but read() waits for the next state. The robot moves while commands have
/// drives on: the first one starts a motion, the first one with drives off ends it, and the robot
/// holds itself then. What the robot stops itself for becomes a fault with its own words
/// (farewell()); a reset of the panel asks it to recover.
#pragma once

#include <cstdint>
#include <string>

#include "hg/device/connected_device.h"
#include "hg/device/franka/estimate.h"
#include "hg/device/franka/impedance.h"
#include "hg/device/franka/session.h"
#include "hg/device/franka/words.h"
#include "hg/device/udp/frame_queue.h"

namespace hg::franka {

/// Contacts from which the robot stops itself, beyond what a hand at the handle does. [A]
struct CollisionThresholds {
  std::array<double, kJoints> torque = {60, 60, 50, 50, 11, 11, 11};  ///< Nm
  std::array<double, 6> force = {100, 100, 100, 25, 25, 25};          ///< N, Nm
};

/// Contacts from which it stops itself on its way to the start of a run: those of libfranka's
/// examples.
inline constexpr CollisionThresholds kLightTouch = {.torque = {20, 20, 18, 18, 16, 14, 12},
                                                    .force = {20, 20, 20, 25, 25, 25}};

/// What leads the joints along the reference of the law.
enum class Interface {
  kTorques,  ///< torques of a joint impedance of our own, impedance.h
  kSpeeds,   ///< speeds for the robot's own joint control, velocity.h
};

/// Set-up data of a Franka.
struct FrankaConfig {
  udp::Address address;
  Interface interface = Interface::kTorques;
  LoadRequest load;    ///< what is screwed onto the flange, the robot subtracts its weight
  std::string flange;  ///< frame F of the chain
  Pose T_F_S;          ///< where the wrench is wanted: S in the flange F
  CollisionThresholds collision;
  ImpedanceGains gains;
  Timeouts timeouts;
  double state_timeout_s = 0.05;  ///< without a state the device counts as silent
  double settle_s = 0.1;          ///< until the robot's filtered estimate knows a new load
  double rest_s = 0.2;            ///< time over which estimates at rest are averaged
};

class FrankaDevice final : public device::ConnectedDevice {
 public:
  /// Connects, recovers from an old reflex, sets load and thresholds, and checks at rest that the
  /// robot's estimate may be used as the user's wrench; what it estimates then is subtracted from
  /// now on. `chain` has seven joints and the tool. Throws SetupError.
  FrankaDevice(const FrankaConfig& config, const model::ChainModel& chain);
  ~FrankaDevice() override;

  /// Moves the arm to `goal` before a run, straight in its joints, with at most 0.2 rad/s, and
  /// checks the estimate there. The robot stops itself at a light touch meanwhile. Throws
  /// SetupError that says what has stopped it.
  void move_to(const VectorM& goal);

  /// Whether the weight of the tool was seen in the robot's estimate with the right sign; false: it
  /// did not appear there, or is too small.
  bool has_checked_signs() const noexcept { return has_checked_signs_; }

  /// Waits for the next state. After silence the last frame is repeated with its driver_fault set,
  /// from now on without waiting.
  void read(SensorFrame& sensors) noexcept override;
  void write(const CommandFrame& command) noexcept override;

  /// Ends a motion and waits up to 0.5 s for its end.
  void close(FaultCode reason) noexcept override;
  std::string farewell() const override;
  /// `late` are the cycles of a motion that the robot got no answer for in time, by its own count
  /// up to its last full 100 cycles, or at least those that the driver itself knows of.
  LinkCounts counts() const noexcept override;
  std::int64_t late_ns() const noexcept override { return late_ns_; }

 private:
  enum class Phase { kIdle, kStarting, kMoving, kFinishing };

  void set_collision(const CollisionThresholds& thresholds);
  void await_idle();
  void lead_to(const VectorM& goal);
  std::string stop_words(const SensorFrame& sensors) const;
  void await_end_of_motion() noexcept;
  RestingEstimate estimate_with(const LoadRequest& load);
  void check_at_rest();
  void check_signs(const model::ChainModel& chain);
  void skip_old_states() noexcept;
  void take_in() noexcept;
  void take(const RobotState& state) noexcept;
  void take_answers() noexcept;
  void follow(const RobotState& state) noexcept;
  void count_unanswered(const RobotState& state) noexcept;
  void abort(const RobotState& state) noexcept;
  FaultCode driver_fault() const noexcept;
  void stop(FaultCode fault, SensorFrame& sensors) noexcept;
  void start_motion() noexcept;
  void finish_motion() noexcept;
  void recover() noexcept;
  void forget_faults() noexcept;
  bool is_driven(const RobotState& state) const noexcept;
  void send_torques(const CommandFrame& command) noexcept;
  void send_speeds(const VectorM& wanted) noexcept;
  void send_speeds(const CommandFrame& command) noexcept;
  bool has_braked() const noexcept;

  FrankaConfig config_;
  Session session_;
  Impedance impedance_;
  udp::FrameQueue queue_;
  RobotState state_;                   ///< newest state
  Vector6 resting_ = Vector6::Zero();  ///< user's wrench that the robot estimated at rest
  SensorFrame arrived_;                ///< frame that is being filled
  RobotCommand command_;
  bool is_started_ = false;     ///< the first frame of the run was read
  std::uint64_t first_id_ = 0;  ///< message_id of the first state of the run
  Phase phase_ = Phase::kIdle;
  std::uint64_t phase_since_ = 0;   ///< message_id at which the phase began
  std::uint32_t move_id_ = 0;       ///< number of the Move that runs, 0 = none
  std::uint32_t ended_id_ = 0;      ///< number of the last Move that this driver has ended
  std::uint32_t recovery_id_ = 0;   ///< number of the recovery that was asked for, 0 = none
  std::uint64_t recovered_at_ = 0;  ///< message_id of the newest state when it had recovered
  std::uint64_t stopped_at_ = 0;    ///< the same when its answer said that it was stopped
  bool was_reset_ = false;          ///< reset button in the last command
  bool is_closed_ = false;
  bool has_checked_signs_ = false;
  // what has stopped the robot; kept for farewell() until it recovers
  bool is_aborted_ = false;
  bool was_not_finite_ = false;
  ErrorBits errors_;
  MoveStatus move_status_ = MoveStatus::kSuccess;
  std::uint8_t recovery_status_ = 0;    ///< answer to the last recovery, 0 = it worked
  FaultCode fault_ = FaultCode::kNone;  ///< of the connection, final
  LinkCounts own_;
  std::int64_t arrived_ns_ = 0;   ///< of the first state that this read() has received; 0: none
  std::int64_t late_ns_ = 0;      ///< of this computer in this read()
  std::uint64_t unanswered_ = 0;  ///< cycles without an answer in time, as the robot counts them
  std::uint64_t counted_to_ = 0;  ///< message_id up to which they are counted
};

}  // namespace hg::franka
