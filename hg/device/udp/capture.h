/// Writes datagrams to a pcap file with link type 147 (LINKTYPE_USER0): each packet is one
/// datagram, without headers of IP and UDP. Source: IETF draft-ietf-opsawg-pcap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

namespace hg::udp {

class Capture {
 public:
  /// Throws SetupError when the file cannot be opened.
  explicit Capture(const std::string& file);
  /// Appends a datagram; no effect after a failed write: the file then holds the beginning of the
  /// capture.
  void add(std::int64_t time_ns, std::span<const std::byte> datagram);
  /// Hands all buffered data to the system. Returns why the file is incomplete; empty: it is
  /// complete.
  std::string flush();

 private:
  void write(const void* data, std::size_t size);

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  int error_ = 0;  ///< error of the first failed write; 0 = none
};

}  // namespace hg::udp
