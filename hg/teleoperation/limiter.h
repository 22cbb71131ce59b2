/// Limits that a remote machine applies to everything that arrives: it trusts no leader.
///
/// Packets are used only when they are finite, newer than the last one, sent later, and of the
/// present engagement. Targets are kept within range, speed and acceleration of the machine, and
/// brake in front of the ends. A target that jumps, a value that is not finite and a leader that
/// falls silent, repeats or freezes end the engagement: the machine comes to rest and holds.
///
/// No allocation after construction, noexcept.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/core/interval.h"
#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

/// Limits of one coordinate of a machine.
struct AxisLimits {
  Interval range;        ///< m or rad
  double v_max = 1.0;    ///< m/s or rad/s
  double a_max = 10.0;   ///< m/s^2 or rad/s^2
  double f_max = 100.0;  ///< N or Nm, added force
};

struct LimiterConfig {
  std::vector<AxisLimits> axes;
  double silence = 0.2;     ///< Time without a packet of use after which the machine holds, s
  double jump_speed = 3.0;  ///< Speed between two packets that is a jump, m/s or rad/s
};

/// Throws SetupError naming the field that is out of range.
void check_limiter(const LimiterConfig& config);

/// Decides which packets are used.
class PacketGate {
 public:
  explicit PacketGate(const LimiterConfig& config) : config_(config) {}

  /// Looks at an arrived packet. True: it is the newest of use; it is kept in newest().
  bool take(const LeaderPacket& packet, double now_s) noexcept;
  /// The same once per period: why the machine must hold, kNone if it follows.
  RemoteCause check(double now_s) noexcept;
  const LeaderPacket& newest() const noexcept { return newest_; }
  /// Ends the engagement for a cause of the machine's own; kept until the next one.
  void end(RemoteCause cause) noexcept {
    if (cause_ == RemoteCause::kNone) cause_ = cause;
  }
  /// Forgets the leader: another one begins.
  void forget() noexcept;

 private:
  bool has_jumped(const LeaderPacket& packet) const noexcept;

  LimiterConfig config_;
  LeaderPacket newest_;
  double used_s_ = 0.0;            ///< When the newest packet arrived
  int repeated_ = 0, frozen_ = 0;  ///< Packets without use since then
  RemoteCause cause_ = RemoteCause::kReleased;
};

/// Keeps targets within the limits of the machine.
class TargetLimiter {
 public:
  /// `machine` follows the targets.
  TargetLimiter(const LimiterConfig& config, const MachineImpedance& machine, double dt)
      : config_(config), machine_(machine), dt_(dt) {}

  /// The nearest target to `wanted` that may follow (x, v), and what holds it back.
  RemoteTarget step(const RemoteTarget& wanted, const PortVector& x, const PortVector& v,
                    RemoteCause& cause) const noexcept;

 private:
  void limit_push(const AxisLimits& axis, double x, double speed, double& v,
                  double& f) const noexcept;

  LimiterConfig config_;
  MachineImpedance machine_;
  double dt_;
};

}  // namespace hg::teleoperation
