#include "hg/device/udp/key.h"

#include <fmt/format.h>
#include <sodium/utils.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg::udp {
namespace {

static_assert(Key::kTagSize <= crypto_auth_hmacsha256_BYTES);

const unsigned char* raw(std::span<const std::byte> bytes) noexcept {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

}  // namespace

Key::Key(std::span<const std::byte> secret) : is_set_(true) {
  crypto_auth_hmacsha256_init(&begun_, raw(secret), secret.size());
}

Key Key::from_file(const std::string& name) {
  const auto refuse = [&](const std::string& why) { throw SetupError(name + ": " + why); };
  const OpenFile file = open_to_read(name);
  struct stat facts {};
  if (fstat(file.descriptor(), &facts) != 0) {
    refuse(fmt::format("the key must be readable: {}", std::strerror(errno)));
  }
  if (facts.st_uid != geteuid() && facts.st_uid != 0) {
    refuse(fmt::format("the key must be a file of yours or of root, got one of user {}",
                       facts.st_uid));
  }
  if ((facts.st_mode & 077U) != 0) {
    refuse(fmt::format("the key must be its owner's only, got mode {:04o}: chmod 600 {}",
                       facts.st_mode & 07777U, name));
  }
  std::array<std::byte, kMostSize + 1> bytes;
  std::size_t size = 0;
  ssize_t more = 0;
  do {
    more = read(file.descriptor(), bytes.data() + size, bytes.size() - size);
    if (more < 0) refuse(fmt::format("the key must be readable: {}", std::strerror(errno)));
    size += more;
  } while (more > 0);
  if (size < kLeastSize || size > kMostSize) {
    refuse(fmt::format("a key has {} to {} bytes, got {}{}", kLeastSize, kMostSize,
                       size > kMostSize ? "more than " : "", std::min(size, kMostSize)));
  }
  const std::span secret = std::span(bytes).first(size);
  if (std::ranges::all_of(secret, [](std::byte byte) { return byte == std::byte{}; })) {
    refuse("a key of zeros is not accepted: head -c 32 /dev/urandom makes one");
  }
  const Key key{secret};
  sodium_memzero(bytes.data(), bytes.size());
  return key;
}

Key::Tag Key::tag(std::span<const std::byte> bytes) const noexcept {
  crypto_auth_hmacsha256_state state = begun_;
  std::array<unsigned char, crypto_auth_hmacsha256_BYTES> whole;
  crypto_auth_hmacsha256_update(&state, raw(bytes), bytes.size());
  crypto_auth_hmacsha256_final(&state, whole.data());
  Tag tag;
  std::memcpy(tag.data(), whole.data(), tag.size());
  return tag;
}

bool Key::fits(std::span<const std::byte> bytes,
               std::span<const std::byte, kTagSize> tag) const noexcept {
  const Tag expected = this->tag(bytes);
  return sodium_memcmp(expected.data(), tag.data(), kTagSize) == 0;
}

}  // namespace hg::udp
