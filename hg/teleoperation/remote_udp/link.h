/// What both ends of a link to a remote machine have in common.
#pragma once

#include <optional>
#include <string>

#include "hg/device/udp/teleoperation_messages.h"
#include "hg/teleoperation/method.h"

namespace hg::teleoperation {

/// Properties of a remote machine on which both sides must agree.
struct RemoteDescription {
  std::string coordinates = "tool";  ///< what they are of: tool or joints
  int size = 3;                      ///< number of coordinates
  double rate_Hz = 1000.0;
  bool is_lock_step = false;
};

udp::Description to_message(const RemoteDescription& description);
udp::Terms to_message(const MethodConfig& method);
/// The method that a leader wants; empty where there is none, or its parameters are impossible.
std::optional<MethodConfig> method_of(const udp::Terms& terms);

}  // namespace hg::teleoperation
