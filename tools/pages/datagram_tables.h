/// Generates the tables of docs/reference/device_protocol.md from hg/device/udp/layout.h.
#pragma once

#include <string>

namespace hg::pages {

/// Returns `page` with the layout of all messages between `<!-- messages -->` and `<!-- end -->`
/// regenerated: offset, type, field and note of each.
std::string with_datagram_tables(std::string page);

}  // namespace hg::pages
