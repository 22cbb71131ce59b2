/// Layout of the datagrams of hg/device/udp/layout.h, for docs/reference/device_protocol.md.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hg::pages {

/// Per message its title, type, size in bytes, and rows of offset, type, field and note; the header
/// of all messages first.
nlohmann::ordered_json datagram_facts();

}  // namespace hg::pages
