/// A device that leads a remote machine over a simulated link.
///
/// Direct: the end effector of the twin leads the tool of the remote machine; motion and force are
/// scaled, also while it runs, and the clutch sets where both belong together. Orientations follow
/// unscaled. Indirect: the twin is the model of the remote machine, and its joints lead the
/// machine's joints; what limits the machine limits the twin.
///
/// The source of the twin's force in a session (hg/signals/twin_force_source.h). No allocation
/// after construction, noexcept.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hg/core/interval.h"
#include "hg/model/chain_data.h"
#include "hg/signals/twin_force_source.h"
#include "hg/teleoperation/channel.h"
#include "hg/teleoperation/leader_half.h"
#include "hg/teleoperation/limiter.h"
#include "hg/teleoperation/link_meter.h"
#include "hg/teleoperation/machine.h"
#include "hg/teleoperation/remote_side.h"
#include "hg/teleoperation/turn.h"

namespace hg::teleoperation {

enum class Mapping : std::uint8_t {
  kTool,    ///< direct: positions of the tool, three coordinates
  kPose,    ///< direct: positions and orientation of the tool, six coordinates
  kJoints,  ///< indirect: joints of the twin, up to seven
};

/// Where a remote machine is that is not simulated in this process.
struct RemoteAddress {
  std::string udp;       ///< HOST:PORT; empty = it is simulated here
  std::string key_file;  ///< secret that it has, too; empty = none
};

struct TeleoperationConfig {
  Mapping mapping = Mapping::kTool;
  MethodConfig method;
  LeaderConfig leader;
  ChannelConfig link;     ///< Of both directions, each with random numbers of its own
  LimiterConfig limiter;  ///< Of the remote machine
  SimulatedMachineConfig machine;
  RemoteAddress address;
  double motion_scale = 1.0;  ///< Motion of the remote machine over that of the leader
  double force_scale = 1.0;   ///< Force on the leader over that on the remote machine
  double torque_scale = 1.0;  ///< Torque likewise, of a tool that is turned
  double lever = 0.1;         ///< Length of a turn by one radian in coordinates of the port, m
  Eigen::Matrix3d R_R_B =
      Eigen::Matrix3d::Identity();    ///< Base of the leader in that of the remote
  std::vector<Interval> clutch_open;  ///< Times at which the clutch is open, s since the run began
};

class Teleoperation final : public TwinForceSource {
 public:
  /// `end_effector` is a frame of the twin; `remote` is null for a simulated machine. Throws
  /// SetupError.
  Teleoperation(const TeleoperationConfig& config, const model::ChainModel& twin, int end_effector,
                double dt, std::unique_ptr<RemoteSide> remote = nullptr);

  void step(const TwinNow& now, TwinForce& force, TeleoperationReport& report) noexcept override;

 private:
  void find_port(const TwinNow& now) noexcept;
  void find_tool(const Vector6& w_H) noexcept;
  void find_turn(const Vector6& w_H) noexcept;
  PortVector stiffness_of_ends() const noexcept;
  void approach_scales(const ParameterChange& change) noexcept;
  bool is_clutch_closed(const TwinNow& now) noexcept;
  void move_remote(double now_s) noexcept;
  void push(TwinForce& force) const noexcept;

  TeleoperationConfig config_;
  model::ChainData twin_;
  int end_effector_;
  double dt_;
  Eigen::Vector3d motion_scale_, force_scale_;    ///< Along the axes of the remote tool
  Eigen::Vector3d wanted_motion_, wanted_force_;  ///< What they approach
  Turn turn_;
  LeaderHalf leader_;
  std::unique_ptr<RemoteSide> remote_;
  Channel<LeaderPacket> to_remote_;
  Channel<RemotePacket> to_leader_;
  LinkMeter meter_;  ///< Of what arrives at the leader
  // the leader's port before the offset of an engagement
  PortVector x_, v_, f_hand_, f_leader_;
  Eigen::Vector3d p_before_ = Eigen::Vector3d::Zero();
  double began_s_ = -1.0;  ///< When the run began; negative = it has not
  LeaderPacket leader_packet_, arrived_at_remote_;
  RemotePacket remote_packet_, arrived_at_leader_;
};

}  // namespace hg::teleoperation
