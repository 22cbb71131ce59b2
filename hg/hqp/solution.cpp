#include "hg/hqp/solution.h"

namespace hg::hqp {

const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::kSolved:
      return "solved";
    case Status::kIterationLimit:
      return "iteration limit";
    case Status::kBadRow:
      return "bad row";
    case Status::kNumericalFailure:
      return "numerical failure";
  }
  return "unknown";
}

Solution::Solution(const Capacity& capacity) {
  check(capacity);
  x.reserve(static_cast<std::size_t>(capacity.variables));
  state.reserve(static_cast<std::size_t>(capacity.rows));
  slack.reserve(static_cast<std::size_t>(capacity.rows));
  levels.reserve(static_cast<std::size_t>(capacity.levels));
}

}  // namespace hg::hqp
