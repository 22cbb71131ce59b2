/// Shared secret of controller and device, and the tag of a datagram: HMAC-SHA256 ([RFC 2104],
/// [FIPS 180-4]), of which the first 16 bytes are sent.
///
/// Uses libsodium (ISC licence). Tags are made and compared without allocation, noexcept; a
/// comparison takes constant time.
#pragma once

#include <sodium/crypto_auth_hmacsha256.h>

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace hg::udp {

class Key {
 public:
  static constexpr std::size_t kTagSize = 16;     ///< bytes
  static constexpr std::size_t kLeastSize = 32;   ///< bytes of a key
  static constexpr std::size_t kMostSize = 4096;  ///< bytes of a key
  using Tag = std::array<std::byte, kTagSize>;

  /// No key: datagrams carry no tag.
  Key() = default;
  explicit Key(std::span<const std::byte> secret);

  /// Key from all bytes of the file. Throws SetupError: it cannot be read, is no file, may be read
  /// by others than its owner, who must be this user or root, has less than kLeastSize or more than
  /// kMostSize bytes, or only zeros.
  static Key from_file(const std::string& file);

  bool is_set() const noexcept { return is_set_; }
  /// Tag of these bytes; requires a key that is set.
  Tag tag(std::span<const std::byte> bytes) const noexcept;
  /// Whether `tag` is the tag of `bytes`.
  bool fits(std::span<const std::byte> bytes,
            std::span<const std::byte, kTagSize> tag) const noexcept;

 private:
  bool is_set_ = false;
  crypto_auth_hmacsha256_state begun_{};  ///< initial state with the key: copied for each datagram
};

}  // namespace hg::udp
