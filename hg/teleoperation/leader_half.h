/// The leader's side: clutch, the link, the method, and a force that ends with the link.
///
/// A closing clutch begins an engagement: the position of the leader then belongs to the target
/// that the remote machine has. The force begins from zero when the remote machine has confirmed
/// it. Where nothing arrives any more, or the remote machine holds, the force fades, and only the
/// clutch, opened and closed, begins the next one.
///
/// One call of step() per period; receive() before it for each packet that has arrived. No
/// allocation after construction, noexcept.
#pragma once

#include <memory>
#include <vector>

#include "hg/core/interval.h"
#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

struct LeaderConfig {
  double silence = 0.2;               ///< Time without a packet after which the link is lost, s
  double fade = 0.15;                 ///< Time in which the force begins and ends, s
  double force_max = 60.0;            ///< Largest force on the leader, N or Nm, at the remote scale
  std::vector<Interval> ranges = {};  ///< Of the remote machine, felt here; empty = not
  double snapshot = kInfinity;        ///< Largest distance of both sides at an engagement, m or rad
  /// Energy that may come to the leader beyond `power` for as long as it comes, J; W
  double surplus = 5.0, power = 20.0;
};

/// Throws SetupError naming the field that is out of range.
void check_leader(const LeaderConfig& config);

/// The leader at the begin of a period, in coordinates of the remote machine but for an offset.
struct LeaderInput {
  const PortVector& x;
  const PortVector& v;
  const PortVector& f_hand;
  bool is_clutch_closed = false;
  /// Of the ends of the remote machine's range, as the leader feels them; empty = not felt here
  PortVector end_stiffness = {};
};

class LeaderHalf {
 public:
  /// Throws SetupError.
  LeaderHalf(const MethodConfig& method, const LeaderConfig& config, double dt)
      : LeaderHalf(make_leader_method(method, dt), config, dt) {}
  LeaderHalf(std::unique_ptr<LeaderMethod> method, const LeaderConfig& config, double dt);

  void receive(const RemotePacket& packet, double now_s) noexcept;
  /// Force on the leader in the coming period, and the packet to send.
  PortVector step(double now_s, const LeaderInput& input, LeaderPacket& packet) noexcept;

  RemoteLink link() const noexcept { return link_; }
  /// Why the remote machine does not follow.
  RemoteCause cause() const noexcept { return cause_; }
  const RemotePacket& arrived() const noexcept { return arrived_; }
  /// Position of the leader in coordinates of the remote machine; the offset is that of the
  /// engagement.
  const PortVector& x() const noexcept { return x_; }
  const PortEnergy& energy() const noexcept { return energy_; }
  double dissipated() const noexcept { return method_->dissipated(); }

 private:
  RemoteCause distrust() const noexcept;
  void watch(double now_s) noexcept;
  void operate(double now_s, const LeaderInput& input) noexcept;
  void engage(const LeaderInput& input) noexcept;
  PortVector force_of_ends(const LeaderInput& input) const noexcept;
  bool is_confirmed() const noexcept;

  LeaderConfig config_;
  double dt_;
  std::unique_ptr<LeaderMethod> method_;
  RemotePacket arrived_;
  bool is_new_ = false;
  double arrived_s_ = -kInfinity;  ///< When the newest packet arrived
  RemoteLink link_ = RemoteLink::kWaiting;
  RemoteCause cause_ = RemoteCause::kReleased;
  bool was_open_ = true;     ///< The clutch was open since the last engagement ended
  bool is_started_ = false;  ///< The remote machine has confirmed this engagement
  std::uint32_t engagements_ = 0;
  std::uint64_t sequence_ = 0;
  double share_ = 0.0;             ///< Of the method's force, 0..1
  PortVector offset_, x_, force_;  ///< force_: of the method, and on the leader before
  PortVector x_before_, applied_;
  PortEnergy energy_;
  double surplus_ = 0.0;      ///< Energy that has come to the leader beyond the power that may, J
  double net_before_ = 0.0;   ///< Of energy_
  bool is_changed_ = true;    ///< The remote machine has moved, or is felt otherwise
  PortVector x_unchanged_;    ///< Of the leader when that was so
  double led_s_ = kInfinity;  ///< When it had moved away from there
};

}  // namespace hg::teleoperation
