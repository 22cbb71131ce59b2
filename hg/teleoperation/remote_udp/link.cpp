#include "hg/teleoperation/remote_udp/link.h"

#include "hg/core/error.h"

namespace hg::teleoperation {

udp::Description to_message(const RemoteDescription& description) {
  return {.device = "remote machine led by its " + description.coordinates,
          .n_m = static_cast<std::uint32_t>(description.size),
          .rate_Hz = description.rate_Hz,
          .interface = udp::Interface::kRemote,
          .is_lock_step = description.is_lock_step};
}

udp::Terms to_message(const MethodConfig& method) {
  return {.method = static_cast<std::uint32_t>(method.kind),
          .leader_mass = method.leader_mass,
          .coordination = method.coordination,
          .impedance = method.impedance,
          .correction = method.correction,
          .contact_force = method.contact_force,
          .touch_force = method.touch_force};
}

std::optional<MethodConfig> method_of(const udp::Terms& terms) {
  if (terms.method > static_cast<std::uint32_t>(MethodKind::kModelMediated)) return {};
  const MethodConfig method = {.kind = static_cast<MethodKind>(terms.method),
                               .leader_mass = terms.leader_mass,
                               .coordination = terms.coordination,
                               .impedance = terms.impedance,
                               .correction = terms.correction,
                               .contact_force = terms.contact_force,
                               .touch_force = terms.touch_force};
  try {
    check_method(method);
  } catch (const SetupError&) {
    return {};
  }
  return method;
}

}  // namespace hg::teleoperation
