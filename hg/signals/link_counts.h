/// What became of the datagrams between a controller and a remote device, as one side saw it.
#pragma once

#include <array>
#include <cstdint>

namespace hg {

/// docs/device_protocol.md says what is done in each case.
struct LinkCounts {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;       ///< good ones of this session, each once
  std::uint64_t lost = 0;           ///< numbers that never arrived
  std::uint64_t reordered = 0;      ///< overtaken on the way
  std::uint64_t duplicate = 0;      ///< arrived a second time
  std::uint64_t late = 0;           ///< arrived when their turn was over
  std::uint64_t held = 0;           ///< turns for which the last values had to do
  std::uint64_t repeated = 0;       ///< sent again for want of an answer, lock-step only
  std::uint64_t corrupted = 0;      ///< checksum wrong
  std::uint64_t truncated = 0;      ///< size is not what it says or what its type has
  std::uint64_t malformed = 0;      ///< impossible content
  std::uint64_t foreign = 0;        ///< not of this protocol, or not of this kind of peer
  std::uint64_t wrong_version = 0;  ///< of another version of the protocol
  std::uint64_t wrong_session = 0;  ///< of another session
  std::uint64_t refused = 0;        ///< attempts of other clients to connect
  std::uint64_t forged = 0;         ///< the tag of the shared key is wrong or missing
  std::uint64_t from_others = 0;    ///< not from the address of the client
};

struct LinkCount {
  const char* name;
  std::uint64_t LinkCounts::*value;
};

/// Everything in LinkCounts that is not as it should be, for texts and files.
inline constexpr std::array<LinkCount, 15> kLinkTroubles = {{
    {"lost", &LinkCounts::lost},
    {"reordered", &LinkCounts::reordered},
    {"duplicate", &LinkCounts::duplicate},
    {"late", &LinkCounts::late},
    {"held", &LinkCounts::held},
    {"repeated", &LinkCounts::repeated},
    {"corrupted", &LinkCounts::corrupted},
    {"truncated", &LinkCounts::truncated},
    {"malformed", &LinkCounts::malformed},
    {"foreign", &LinkCounts::foreign},
    {"wrong version", &LinkCounts::wrong_version},
    {"wrong session", &LinkCounts::wrong_session},
    {"refused", &LinkCounts::refused},
    {"forged", &LinkCounts::forged},
    {"from others", &LinkCounts::from_others},
}};

}  // namespace hg
