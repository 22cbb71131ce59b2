/// Interface of a remote machine, and a simulated one.
#pragma once

#include <vector>

#include "hg/core/interval.h"
#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

/// Measured state of a remote machine.
struct MachineState {
  PortVector x, v;
  PortVector f;              ///< Force of the surroundings on the machine
  bool has_stopped = false;  ///< By a rule of its own: it does not follow until it is freed
};

/// A machine whose own controller follows a target with a spring and a damper. One call of read()
/// and one of write() per period. Neither allocates, waits or throws.
class RemoteMachine {
 public:
  virtual ~RemoteMachine() = default;
  virtual void read(MachineState& state) noexcept = 0;
  virtual void write(const RemoteTarget& target) noexcept = 0;
};

/// A wall: pushes what is behind it out along its normal.
struct Wall {
  PortVector normal;       ///< Unit vector out of the wall
  double offset = 0.0;     ///< Position of its surface along the normal, m or rad
  double stiffness = 5e3;  ///< N/m or Nm/rad
  double damping = 50.0;   ///< Ns/m or Nms/rad; never pulls
};

/// Rules of its own by which a machine stops, the same for all of its axes.
struct StopRules {
  double beyond = kInfinity;        ///< Way out of its range, m or rad
  double speed = kInfinity;         ///< Measured, m/s or rad/s
  double acceleration = kInfinity;  ///< Of its target, m/s^2 or rad/s^2
  double force = kInfinity;         ///< Of the surroundings, N or Nm
};

struct SimulatedMachineConfig {
  MachineImpedance impedance;
  double friction = 2.0;     ///< Viscous, Ns/m or Nms/rad
  double force_max = 300.0;  ///< Of each motor, N or Nm
  std::vector<Wall> walls;
  PortVector x_start;
  std::vector<Interval> ranges;  ///< Of its axes; empty = they have no ends
  StopRules stops;
};

/// Independent axes with the same inertia, between walls.
class SimulatedMachine final : public RemoteMachine {
 public:
  SimulatedMachine(const SimulatedMachineConfig& config, double dt);
  void read(MachineState& state) noexcept override;
  void write(const RemoteTarget& target) noexcept override;
  /// Follows again after a protective stop.
  void free() noexcept { state_.has_stopped = false; }
  /// Moves the surface of a wall along its normal, m or rad, at rest in every period.
  void move_wall(std::size_t wall, double offset) noexcept { config_.walls[wall].offset = offset; }

 private:
  PortVector wall_force() const noexcept;
  bool must_stop(const PortVector& v) const noexcept;
  void follow(const RemoteTarget& target) noexcept;

  SimulatedMachineConfig config_;
  double dt_;
  MachineState state_;
  PortVector x_target_, v_target_;
};

}  // namespace hg::teleoperation
