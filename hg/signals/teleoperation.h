/// What the leader's side knows of a teleoperation: recorded and shown, never an input of a cycle.
///
/// Port coordinates are those of the remote machine: positions of its tool in its base frame, or
/// positions of its joints. SI units. Copyable, no allocation.
#pragma once

#include <cstdint>

#include "hg/core/fields.h"
#include "hg/core/types.h"

namespace hg {

inline constexpr int kMaxPort = 7;  ///< coordinates of a port: joints of a remote machine

/// Motion or force of a port, one number per coordinate.
using PortVector = VectorUpTo<kMaxPort>;

/// State of the link to a remote machine. Numbers are recorded and never change meaning.
enum class RemoteLink : std::uint8_t {
  kNone = 0,      ///< there is no remote machine
  kWaiting = 1,   ///< nothing has been received yet
  kReleased = 2,  ///< the clutch is open: the remote machine holds
  kEngaged = 3,   ///< both sides are coupled
  kLost = 4,      ///< nothing received for too long: both sides hold until the clutch has been used
};

/// Why a remote machine does not follow what was sent to it. Numbers are recorded and never change
/// meaning.
enum class RemoteCause : std::uint8_t {
  kNone = 0,
  kSpeed = 1,         ///< slower than commanded: its largest speed
  kAcceleration = 2,  ///< later than commanded: its largest acceleration
  kRange = 3,         ///< at the end of its range
  kForce = 4,         ///< at its largest force
  kNotFinite = 5,     ///< holds: a value was not finite
  kJump = 6,          ///< holds: a target was too far from the last one
  kReplayed = 7,      ///< holds: packets were repeated or came from before the engagement
  kFrozen = 8,        ///< holds: packets kept coming, with the same content
  kSilent = 9,        ///< holds: no packets
  kReleased = 10,     ///< holds: the clutch is open
  kStopped = 11,      ///< holds: a protective stop of the machine, by its own rules
  kActive = 12,       ///< lost: more energy came to the leader than the remote side may give
};

/// Whether the remote machine holds for this cause until the clutch has been used.
constexpr bool holds(RemoteCause cause) noexcept {
  const bool is_distrust = cause >= RemoteCause::kNotFinite && cause <= RemoteCause::kSilent;
  return is_distrust || cause == RemoteCause::kStopped;
}

struct TeleoperationReport {
  RemoteLink link = RemoteLink::kNone;
  RemoteCause cause = RemoteCause::kNone;
  double age = 0.0;
  PortVector x_leader, x_remote, f_leader, f_remote;
  double energy_leader = 0.0, energy_remote = 0.0, dissipated = 0.0;
  PortVector x_true, f_true;
  double round_trip = 0.0, jitter = 0.0, loss = 0.0;
  Eigen::Vector3d motion_scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d force_scale = Eigen::Vector3d::Ones();
};

template <typename Archive, Is<TeleoperationReport> T>
void fields(Archive& a, T& report) {
  a("link", report.link);
  a("cause", report.cause, "why the remote machine does not follow, as it last said");
  a("age", report.age, "time since the newest packet from the remote machine was sent", unit::kS);
  a("x_leader", report.x_leader, "where the leader wants the remote machine", unit::kJointPosition);
  a("x_remote", report.x_remote, "where the remote machine last said it was", unit::kJointPosition);
  a("f_leader", report.f_leader, "force on the leader, at the scale of the remote machine",
    unit::kJointTorque);
  a("f_remote", report.f_remote, "force of its surroundings that the remote machine last measured",
    unit::kJointTorque);
  a("energy_leader", report.energy_leader, "net energy that the leader's port has taken", unit::kJ);
  a("energy_remote", report.energy_remote,
    "net energy that the remote port has taken, as it last said", unit::kJ);
  a("dissipated", report.dissipated, "energy that the method has dissipated at both ports",
    unit::kJ);
  a("x_true", report.x_true, "where a simulated remote machine is now; empty = not known",
    unit::kJointPosition);
  a("f_true", report.f_true, "force of its surroundings on it now; empty = not known",
    unit::kJointTorque);
  a("round_trip", report.round_trip, "measured way of packets to the remote machine and back",
    unit::kS);
  a("jitter", report.jitter, "measured mean difference of the delays of two packets in a row",
    unit::kS);
  a("loss", report.loss, "measured share of packets from the remote machine that were lost",
    unit::kNone);
  a("motion_scale", report.motion_scale, "motion of the remote machine over that of the leader",
    unit::kNone);
  a("force_scale", report.force_scale, "force on the leader over that on the remote machine",
    unit::kNone);
}

}  // namespace hg
