/// The messages between a leader and a remote machine of a teleoperation. A session begins as that
/// of a device, with hello and welcome; then the leader sends its terms instead of a ready.
///
/// No allocation, noexcept.
#pragma once

#include "hg/device/udp/protocol.h"
#include "hg/signals/remote_packets.h"

namespace hg::udp {

/// The method of bilateral control, whose other half the machine has to run.
struct Terms {
  std::uint32_t method = 0;
  double leader_mass = 0.0, coordination = 0.0, impedance = 0.0, correction = 0.0;
  double contact_force = 0.0, touch_force = 0.0;
};

template <typename Archive, Is<Terms> T>
void fields(Archive& a, T& terms) {
  a("method", terms.method,
    "0 position_force, 1 four_channel, 2 wave_variables, 3 passivity_control, 4 model_mediated");
  a.zeros("zero");
  a("leader_mass", terms.leader_mass, "as leader_mass_kg of a scenario", unit::kNone);
  a("coordination", terms.coordination, "as coordination_N_per_m", unit::kNone);
  a("impedance", terms.impedance, "as impedance_Ns_per_m", unit::kNone);
  a("correction", terms.correction, "as correction_per_s", unit::kNone);
  a("contact_force", terms.contact_force, "as contact_force_N", unit::kNone);
  a("touch_force", terms.touch_force, "as touch_force_N", unit::kNone);
}

/// A period of the leader.
struct LeaderMessage {
  std::uint64_t period = 0;
  double time_s = 0.0;
  teleoperation::LeaderPacket packet;
};

template <typename Archive, Is<LeaderMessage> T>
void fields(Archive& a, T& message) {
  a("period", message.period, "counts periods of the leader, from 1");
  a("time_s", message.time_s, "time of the leader's run", unit::kS);
  fields(a, message.packet);
}

/// A period of the remote machine.
struct RemoteMessage {
  std::uint64_t period = 0;
  teleoperation::RemotePacket packet;
};

template <typename Archive, Is<RemoteMessage> T>
void fields(Archive& a, T& message) {
  a("period", message.period, "newest period of the leader that has arrived");
  fields(a, message.packet);
}

template <>
inline constexpr MessageType kTypeOf<Terms> = MessageType::kTerms;
template <>
inline constexpr MessageType kTypeOf<LeaderMessage> = MessageType::kLeader;
template <>
inline constexpr MessageType kTypeOf<RemoteMessage> = MessageType::kRemote;

}  // namespace hg::udp
