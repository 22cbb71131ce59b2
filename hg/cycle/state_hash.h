/// One number for the state after a cycle: two runs that show the same numbers are the same run.
///
/// The words of the state, one after the other: hash = (rotated hash ^ word) * odd constant, a
/// bijection of each word, so that one value that differs always shows. Not cryptographic. About a
/// nanosecond per word. No allocation, noexcept.
#pragma once

#include "hg/cycle/cycle.h"

namespace hg::cycle {

/// Hash of everything in `state`; of the drives' past commands only the last one, the others were
/// in earlier hashes. `rows` is the number of rows of the rendering problem, of which the state
/// holds the active set.
std::uint64_t hash_of(const State& state, int rows) noexcept;

}  // namespace hg::cycle
