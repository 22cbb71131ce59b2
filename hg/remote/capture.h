/// Writes datagrams to a pcap file with link type 147 (LINKTYPE_USER0): each packet is one
/// datagram, without headers of IP and UDP. Source: IETF draft-ietf-opsawg-pcap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace hg::remote {

class Capture {
 public:
  /// Throws SetupError when the file cannot be written.
  explicit Capture(const std::string& file);
  void add(std::int64_t time_ns, std::span<const std::byte> datagram);

 private:
  std::ofstream file_;
};

/// The datagrams of such a file. Throws SetupError.
std::vector<std::vector<std::byte>> read_capture(const std::string& file);

}  // namespace hg::remote
