#include "hg/teleoperation/position_force.h"

#include <cmath>

namespace hg::teleoperation {

void PositionForceLeader::start(Eigen::Index /*size*/) noexcept {}

PortVector PositionForceLeader::step(const LeaderPort& /*port*/, const RemotePacket& arrived,
                                     bool /*is_new*/, LeaderPacket& /*packet*/) noexcept {
  return arrived.reflected;
}

void PositionForceRemote::start(const PortVector& /*x*/) noexcept {}

RemoteTarget PositionForceRemote::step(const RemotePort& port, const LeaderPacket& arrived,
                                       bool /*is_new*/, RemotePacket& packet) noexcept {
  packet.reflected = port.f;
  return {arrived.x, arrived.v, PortVector::Zero(arrived.x.size())};
}

void FourChannelLeader::start(Eigen::Index /*size*/) noexcept {}

// m_l a = f_hand + f_surroundings + K (x_r - x_l) + D (v_r - v_l), D of a critically damped pair
PortVector FourChannelLeader::step(const LeaderPort& port, const RemotePacket& arrived,
                                   bool /*is_new*/, LeaderPacket& packet) noexcept {
  packet.f = port.f_hand;
  const double damping = 2.0 * std::sqrt(config_.coordination * config_.leader_mass);
  return arrived.reflected + config_.coordination * (arrived.x - port.x) +
         damping * (arrived.v - port.v);
}

void FourChannelRemote::start(const PortVector& /*x*/) noexcept {}

// m_r a = m_r / m_l (f_hand + f_surroundings), besides the machine's spring and damper
RemoteTarget FourChannelRemote::step(const RemotePort& port, const LeaderPacket& arrived,
                                     bool /*is_new*/, RemotePacket& packet) noexcept {
  packet.reflected = port.f;
  return {arrived.x, arrived.v, mass_ratio_ * arrived.f + (mass_ratio_ - 1.0) * port.f};
}

}  // namespace hg::teleoperation
