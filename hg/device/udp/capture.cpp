#include "hg/device/udp/capture.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "hg/core/open_file.h"

namespace hg::udp {
namespace {

constexpr std::uint32_t kNanosecondMagic = 0xa1b23c4d;
constexpr std::uint32_t kFormatVersion = 2 | 4U << 16U;
constexpr std::uint32_t kLinkTypeUser0 = 147;
constexpr std::uint32_t kLargest = 65535;
constexpr std::array<std::uint32_t, 6> kFileHeader = {kNanosecondMagic, kFormatVersion, 0, 0,
                                                      kLargest,         kLinkTypeUser0};
using PacketHeader = std::array<std::uint32_t, 4>;  // s, ns, captured bytes, bytes

}  // namespace

Capture::Capture(const std::string& file)
    : file_(fdopen(open_to_write(file, Content::kEmptied).release(), "wb"), &std::fclose) {
  write(kFileHeader.data(), sizeof kFileHeader);
}

void Capture::write(const void* data, std::size_t size) {
  if (error_ == 0 && std::fwrite(data, 1, size, file_.get()) != size) error_ = errno;
}

std::string Capture::flush() {
  if (error_ == 0 && std::fflush(file_.get()) != 0) error_ = errno;
  return error_ == 0 ? "" : std::strerror(error_);
}

void Capture::add(std::int64_t time_ns, std::span<const std::byte> datagram) {
  const auto size = static_cast<std::uint32_t>(datagram.size());
  const PacketHeader header = {static_cast<std::uint32_t>(time_ns / 1'000'000'000),
                               static_cast<std::uint32_t>(time_ns % 1'000'000'000), size, size};
  write(header.data(), sizeof header);
  write(datagram.data(), size);
}

}  // namespace hg::udp
