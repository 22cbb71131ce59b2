/// Where the other side of a network link is.
#pragma once

#include <string>

namespace hg::udp {

/// HOST:PORT as typed by a user; a host with colons in brackets.
struct Address {
  std::string host, port;
};

/// Parses an address; throws SetupError that begins with `option`.
Address parse_address(const std::string& option, const std::string& text);

}  // namespace hg::udp
