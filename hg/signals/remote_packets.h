/// What the two sides of a teleoperation send each other, once per period.
///
/// All vectors are in coordinates of the remote machine and have one number per coordinate.
/// Energies are those of a port since the engagement and never fall, so that a packet that is lost
/// costs nothing but time. SI units. Copyable, no allocation.
#pragma once

#include <cstdint>

#include "hg/signals/teleoperation.h"

namespace hg::teleoperation {

struct LeaderPacket {
  std::uint64_t sequence = 0;    ///< Counts packets, from 1
  std::uint32_t engagement = 0;  ///< Counts closings of the clutch, from 1; 0 = it is open
  double sent_s = 0.0;           ///< By the leader's clock, s
  PortVector x, v;               ///< Where the leader wants the remote machine, and how fast
  PortVector f;                  ///< Force of the hand, or force that the leader renders
  PortVector wave;               ///< Wave towards the remote side, sqrt(W)
  PortVector energy;             ///< Energy that the leader's port has taken, J
  std::uint32_t model = 0;       ///< Number of the newest model of the contact that has arrived
};

template <typename Archive, Is<LeaderPacket> T>
void fields(Archive& a, T& packet) {
  a("packet", packet.sequence, "counts packets, from 1; 0: there is none");
  a("engagement", packet.engagement, "counts closings of the clutch, from 1; 0: it is open");
  a("model", packet.model, "number of the newest model of the contact that has arrived");
  a("sent_s", packet.sent_s, "by the leader's clock", unit::kS);
  a("x", packet.x, "where the leader wants the machine", unit::kJointPosition);
  a("v", packet.v, "how fast", unit::kJointSpeed);
  a("f", packet.f, "force of the hand, or force that the leader renders", unit::kJointTorque);
  a("wave", packet.wave, "wave towards the machine, root of a power", unit::kNone);
  a("energy", packet.energy, "that the leader's port has taken, or sent as waves", unit::kJ);
}

/// A contact as the remote side has measured it: a plane in port coordinates with a spring.
struct ContactModel {
  std::uint32_t number = 0;  ///< Counts changes, from 1; 0 = nothing is known yet
  bool is_touching = false;
  PortVector normal;       ///< Unit vector out of the surface
  double offset = 0.0;     ///< Position of the surface along the normal
  double stiffness = 0.0;  ///< N/m or Nm/rad
};

struct RemotePacket {
  std::uint64_t sequence = 0;    ///< Counts packets, from 1
  std::uint32_t engagement = 0;  ///< Engagement in which the remote side follows; 0 = it holds
  double sent_s = 0.0;           ///< By the remote clock, s
  double answered_s = 0.0;       ///< LeaderPacket::sent_s of the newest packet in use
  RemoteCause cause = RemoteCause::kReleased;
  PortVector x, v;          ///< Measured
  PortVector x_target;      ///< Target of the machine's own controller
  PortVector f;             ///< Force of the surroundings on the machine
  PortVector reflected;     ///< Force that the method lets the leader feel
  PortVector wave;          ///< Wave towards the leader, sqrt(W)
  PortVector energy;        ///< Energy that the remote port has taken, J
  double energy_net = 0.0;  ///< Taken minus given at the remote port, J
  double dissipated = 0.0;  ///< By the method at the remote port, J
  ContactModel model;
};

template <typename Archive, Is<RemotePacket> T>
void fields(Archive& a, T& packet) {
  a("packet", packet.sequence, "counts packets, from 1");
  a("engagement", packet.engagement, "that the machine follows, or last followed");
  a("cause", packet.cause, "why it does not follow: 0 it does, 1..4 its limits, 5..11 it holds");
  a("sent_s", packet.sent_s, "by the clock of the machine", unit::kS);
  a("answered_s", packet.answered_s, "sent_s of the newest packet in use", unit::kS);
  a("x", packet.x, "measured", unit::kJointPosition);
  a("v", packet.v, "measured", unit::kJointSpeed);
  a("x_target", packet.x_target, "target of the machine's own controller", unit::kJointPosition);
  a("f", packet.f, "force of its surroundings on the machine", unit::kJointTorque);
  a("reflected", packet.reflected, "force for the leader, by the method", unit::kJointTorque);
  a("wave", packet.wave, "wave towards the leader, root of a power", unit::kNone);
  a("energy", packet.energy, "that the machine's port has taken, or sent as waves", unit::kJ);
  a("energy_net", packet.energy_net, "taken minus given there", unit::kJ);
  a("dissipated", packet.dissipated, "by the method there", unit::kJ);
  a("model", packet.model.number, "counts changes of the model of the contact; 0: none");
  a("is_touching", packet.model.is_touching, "1: the machine touches it");
  a("normal", packet.model.normal, "unit vector out of its surface", unit::kNone);
  a("offset", packet.model.offset, "of the surface along the normal", unit::kJointPosition);
  a("stiffness", packet.model.stiffness, "of the contact; 0: there is none", unit::kNone);
}

}  // namespace hg::teleoperation
