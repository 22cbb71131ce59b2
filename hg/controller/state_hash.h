/// Hash of the state after a cycle: runs with equal hashes are identical.
///
/// Over the words of the state: hash = (rotated hash ^ word) * odd constant, a bijection of each
/// word, so that a single differing value always changes the hash. Not cryptographic. About a
/// nanosecond per word. No allocation, noexcept.
///
/// Beside each struct of the state, hashed(hash, state) passes its words to hash.mix(): not all
/// members, and in the order of the hash, unlike fields(). It names all members first, so that a
/// struct with a new one does not compile until hashed() has it, too.
#pragma once

#include <cstdint>

namespace hg::controller {

struct CycleState;

/// Hash of `state`. Left out are the past commands of the drives but the last one (earlier hashes
/// cover them), MonitorState::shaking, the filters of passivity::PassivityState, and some sums of
/// InertialUnitsState. `rows` is the number of rows of the rendering problem, whose active set is
/// in the state.
std::uint64_t hash_of(const CycleState& state, int rows) noexcept;

}  // namespace hg::controller
