/// Whether what has come over a network can be used at all: complete, finite, and of a size that no
/// calculation loses. noexcept, no allocation.
#pragma once

#include "hg/signals/remote_packets.h"

namespace hg::teleoperation {

/// Of a machine with `size` coordinates. A packet of an open clutch counts, too.
bool is_plausible(const LeaderPacket& packet, Eigen::Index size) noexcept;
bool is_plausible(const RemotePacket& packet, Eigen::Index size) noexcept;

}  // namespace hg::teleoperation
