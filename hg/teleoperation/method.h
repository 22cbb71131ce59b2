/// Methods of bilateral control: each has a half at the leader and a half at the remote machine,
/// which see only what has arrived. docs/concepts/teleoperation.md derives them.
///
/// Signs: forces that a port reports act on the leader, or on the machine. A port takes energy
/// where its owner works against the force of the method. No allocation after construction.
#pragma once

#include <cstdint>
#include <memory>

#include "hg/signals/remote_packets.h"
#include "hg/signals/teleoperation.h"

namespace hg::teleoperation {

enum class MethodKind : std::uint8_t {
  kPositionForce,
  kFourChannel,
  kWaveVariables,
  kPassivityControl,
  kModelMediated,
};

/// Parameters of the methods, for every coordinate of the port alike.
struct MethodConfig {
  MethodKind kind = MethodKind::kModelMediated;
  double leader_mass = 6.0;     ///< Inertia that the hand feels in free motion, kg or kg m^2
  double coordination = 500.0;  ///< Four-channel: spring between both positions, N/m or Nm/rad
  double impedance = 30.0;      ///< Wave variables: Ns/m or Nms/rad
  double correction = 4.0;      ///< Rate at which errors of position decay where energy allows, 1/s
  double contact_force = 1.5;   ///< Model-mediated: what is a contact, N or Nm
  double touch_force = 5.0;     ///< Model-mediated: of a contact that the leader does not know, N
};

/// The machine's own controller: x_target + spring and damper, as far as its force goes.
struct MachineImpedance {
  double mass = 3.0;       ///< kg or kg m^2
  double stiffness = 1e4;  ///< N/m or Nm/rad
  double damping = 300.0;  ///< Ns/m or Nms/rad
};

/// Throws SetupError naming the field that is out of range.
void check_method(const MethodConfig& config);

/// Energy through a port, coordinate by coordinate.
struct PortEnergy {
  PortVector taken, given;  ///< Both only grow, J

  void start(Eigen::Index size) noexcept {
    taken = PortVector::Zero(size);
    given = PortVector::Zero(size);
  }
  /// Adds what a constant force `f` on the owner of the port does along `dx`.
  void add(const PortVector& f, const PortVector& dx) noexcept {
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      const double work = -f[i] * dx[i];
      (work > 0.0 ? taken : given)[i] += std::abs(work);
    }
  }
  double net() const noexcept { return taken.sum() - given.sum(); }
};

/// The leader at the begin of a period.
struct LeaderPort {
  const PortVector& x;  ///< In coordinates of the remote machine, as v
  const PortVector& v;
  const PortVector& f_hand;  ///< Force of the hand on the leader
  const PortEnergy& energy;  ///< Until now
};

class LeaderMethod {
 public:
  virtual ~LeaderMethod() = default;
  /// Begins an engagement with a leader of `size` coordinates at rest.
  virtual void start(Eigen::Index size) noexcept = 0;
  /// Force on the leader in the coming period, from the newest packet that has arrived. `is_new`:
  /// it has arrived since the last call. Adds to `packet`, whose x and v are those of the port,
  /// what the other half needs.
  virtual PortVector step(const LeaderPort& port, const RemotePacket& arrived, bool is_new,
                          LeaderPacket& packet) noexcept = 0;
  double dissipated() const noexcept { return dissipated_; }

 protected:
  double dissipated_ = 0.0;  ///< By this half in this engagement, J
};

/// The remote machine at the begin of a period.
struct RemotePort {
  const PortVector& x;  ///< Measured, as v
  const PortVector& v;
  const PortVector& f;         ///< Force of the surroundings on the machine
  const PortVector& x_target;  ///< Target in the last period, as the limiter let it through
  const PortEnergy& energy;    ///< Of target and coupling force, until now
};

/// Target of the machine's controller for the coming period.
struct RemoteTarget {
  PortVector x, v;
  PortVector f;  ///< Added to what the machine's spring and damper do
};

class RemoteMethod {
 public:
  virtual ~RemoteMethod() = default;
  /// Begins an engagement with the machine's target at `x`.
  virtual void start(const PortVector& x) noexcept = 0;
  /// Target for the coming period. Adds to `packet` what the other half needs.
  virtual RemoteTarget step(const RemotePort& port, const LeaderPacket& arrived, bool is_new,
                            RemotePacket& packet) noexcept = 0;
  double dissipated() const noexcept { return dissipated_; }

 protected:
  double dissipated_ = 0.0;
};

/// Throws SetupError.
std::unique_ptr<LeaderMethod> make_leader_method(const MethodConfig& config, double dt);
std::unique_ptr<RemoteMethod> make_remote_method(const MethodConfig& config,
                                                 const MachineImpedance& machine, double dt);

}  // namespace hg::teleoperation
