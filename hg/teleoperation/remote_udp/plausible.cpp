#include "hg/teleoperation/remote_udp/plausible.h"

#include <cmath>

namespace hg::teleoperation {
namespace {

constexpr double kFar = 1e3;         // m or rad, and per second
constexpr double kStrong = 1e6;      // N or Nm, sqrt(W)
constexpr double kEnergy = 1e9;      // J
constexpr double kStiffest = 1e6;    // N/m or Nm/rad
constexpr double kUnitError = 1e-3;  // of the length of a unit vector

// Comparisons with NaN are false.
bool within(const PortVector& v, Eigen::Index size, double most) noexcept {
  if (v.size() != size) return false;
  for (Eigen::Index i = 0; i < size; ++i) {
    if (!(std::abs(v[i]) <= most)) return false;
  }
  return true;
}

bool is_plausible(const ContactModel& model, Eigen::Index size) noexcept {
  if (model.stiffness == 0.0 && model.normal.size() == 0) return true;
  if (!within(model.normal, size, 1.0 + kUnitError)) return false;
  if (!(model.stiffness >= 0.0 && model.stiffness <= kStiffest)) return false;
  const bool is_unit = std::abs(model.normal.norm() - 1.0) <= kUnitError;
  return std::abs(model.offset) <= kFar && (is_unit || model.stiffness == 0.0);
}

}  // namespace

bool is_plausible(const LeaderPacket& packet, Eigen::Index size) noexcept {
  return std::isfinite(packet.sent_s) && within(packet.x, size, kFar) &&
         within(packet.v, size, kFar) && within(packet.f, size, kStrong) &&
         within(packet.wave, size, kStrong) && within(packet.energy, size, kEnergy);
}

bool is_plausible(const RemotePacket& packet, Eigen::Index size) noexcept {
  return std::isfinite(packet.sent_s) && std::isfinite(packet.answered_s) &&
         packet.cause <= RemoteCause::kStopped && within(packet.x, size, kFar) &&
         within(packet.v, size, kFar) && within(packet.x_target, size, kFar) &&
         within(packet.f, size, kStrong) && within(packet.reflected, size, kStrong) &&
         within(packet.wave, size, kStrong) && within(packet.energy, size, kEnergy) &&
         std::abs(packet.energy_net) <= kEnergy && std::abs(packet.dissipated) <= kEnergy &&
         is_plausible(packet.model, size);
}

}  // namespace hg::teleoperation
