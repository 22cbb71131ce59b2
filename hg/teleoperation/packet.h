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

}  // namespace hg::teleoperation
