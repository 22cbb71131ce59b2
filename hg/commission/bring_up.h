/// The first motions of a new machine, step by step, with a person at the emergency stop: what is
/// connected wrongly is named before it can do harm.
///
/// Sequential code that advances through a Rig. Independent of real time.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hg/commission/rig.h"
#include "hg/start_test/procedure.h"

namespace hg::commission {

/// One step and its outcome, as in a start test.
using start_test::Item;
using start_test::Outcome;

struct Options {
  /// The last step sends nothing while the drives hold: the machine must switch them off itself.
  /// Only for a device at the other end of a connection, which it ends.
  bool falls_silent = false;
  /// How many samples the connection has filled in so far, for lack of better ones; empty: none
  std::function<std::uint64_t()> filled_in;
};

/// Goes through all steps. What follows a step that has failed is untested. An Ended of the rig
/// becomes the failure of the step in which it came.
std::vector<Item> run(Rig& rig, const Options& options = {});

}  // namespace hg::commission
