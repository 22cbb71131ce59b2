#include "hg/hqp/solution.h"

#include "hg/core/error.h"

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

void check_solver_options(const SolverOptions& options) {
  const auto require = [](bool ok, const char* text) {
    if (!ok) throw SetupError(text);
  };
  const auto is_small = [](double tolerance) { return tolerance > 0.0 && tolerance <= 1e-3; };
  require(is_small(options.rank_tolerance), "rank_tolerance must be in 0 .. 1e-3, above 0");
  require(is_small(options.feasibility_tolerance),
          "feasibility_tolerance must be in 0 .. 1e-3, above 0");
  require(options.max_iterations > 0, "max_iterations must be above 0");
  require(options.budget >= 0, "budget must not be negative");
}

Solution::Solution(const Capacity& capacity) {
  check_capacity(capacity);
  x.reserve(capacity.variables);
  state.reserve(capacity.rows);
  slack.reserve(capacity.rows);
  levels.reserve(capacity.levels);
}

}  // namespace hg::hqp
