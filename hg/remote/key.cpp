#include "hg/remote/key.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sodium/utils.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "hg/core/error.h"

namespace hg::remote {
namespace {

static_assert(Key::kTagSize <= crypto_auth_hmacsha256_BYTES);

const unsigned char* raw(std::span<const std::byte> bytes) noexcept {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

// closed at the end
struct File {
  explicit File(const std::string& name) : number(open(name.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~File() {
    if (number >= 0) close(number);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  int number;
};

}  // namespace

Key::Key(std::span<const std::byte> secret) : is_set_(true) {
  crypto_auth_hmacsha256_init(&begun_, raw(secret), secret.size());
}

Key Key::from_file(const std::string& name) {
  const auto refuse = [&](const std::string& why) { throw SetupError(name + ": " + why); };
  const File file(name);
  struct stat facts {};
  if (file.number < 0 || fstat(file.number, &facts) != 0) {
    refuse(fmt::format("the key must be readable: {}", std::strerror(errno)));
  }
  if (!S_ISREG(facts.st_mode)) refuse("the key must be a file");
  if ((facts.st_mode & 077U) != 0) {
    refuse(fmt::format("the key must be its owner's only, got mode {:04o}: chmod 600 {}",
                       facts.st_mode & 07777U, name));
  }
  std::array<std::byte, kMostSize + 1> bytes;
  std::size_t size = 0;
  ssize_t more = 0;
  do {
    more = read(file.number, bytes.data() + size, bytes.size() - size);
    if (more < 0) refuse(fmt::format("the key must be readable: {}", std::strerror(errno)));
    size += static_cast<std::size_t>(more);
  } while (more > 0);
  if (size < kLeastSize || size > kMostSize) {
    refuse(fmt::format("a key has {} to {} bytes, got {}{}", kLeastSize, kMostSize,
                       size > kMostSize ? "more than " : "", std::min(size, kMostSize)));
  }
  const Key key{std::span(bytes).first(size)};
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

}  // namespace hg::remote
