/// Counters of the datagrams between a controller and a remote device, as seen by one side.
#pragma once

#include <array>
#include <cstdint>

namespace hg {

/// Datagrams by outcome; docs/reference/device_protocol.md describes the reaction to each.
struct LinkCounts {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;       ///< Valid datagrams of this session, each counted once
  std::uint64_t lost = 0;           ///< Datagrams that never arrived, by gaps in their numbers
  std::uint64_t reordered = 0;      ///< Datagrams overtaken by a newer one
  std::uint64_t duplicate = 0;      ///< Datagrams received a second time
  std::uint64_t late = 0;           ///< Datagrams received after their period had ended
  std::uint64_t held = 0;           ///< Periods bridged with the last values
  std::uint64_t repeated = 0;       ///< Datagrams sent again for lack of an answer; lock-step only
  std::uint64_t corrupted = 0;      ///< Datagrams with a wrong checksum
  std::uint64_t truncated = 0;      ///< Datagrams whose size does not match header or type
  std::uint64_t malformed = 0;      ///< Datagrams with invalid content
  std::uint64_t foreign = 0;        ///< Datagrams of another protocol or of the wrong kind of peer
  std::uint64_t wrong_version = 0;  ///< Datagrams of another protocol version
  std::uint64_t wrong_session = 0;  ///< Datagrams of another session
  std::uint64_t refused = 0;        ///< Connection attempts of other clients
  std::uint64_t forged = 0;         ///< Datagrams with a wrong or missing tag of the shared key
  std::uint64_t from_others = 0;    ///< Datagrams not from the client's address
};

/// Name of one counter and its member.
struct LinkCount {
  const char* name;
  std::uint64_t LinkCounts::*value;
};

/// All counters of LinkCounts that count faults, with their names in texts and files.
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
