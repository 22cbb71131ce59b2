/// hapticgiant.hqp: problems from numpy, solutions as numpy.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hg/hqp/solver.h"
#include "hg/hqp/text.h"
#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {
namespace {

using hqp::ActiveSet;
using hqp::Capacity;
using hqp::LevelResult;
using hqp::Problem;
using hqp::RowState;
using hqp::Solution;

// a solution and the active set that it ended with
struct SolutionOut {
  Solution solution;
  ActiveSet active_set;
};

void require(bool holds, const std::string& message) {
  if (!holds) throw nb::value_error(message.c_str());
}

void require_row(const Problem& problem, int row) {
  require(row >= 0 && row < problem.rows(),
          "row " + std::to_string(row) + ": there are " + std::to_string(problem.rows()));
}

std::span<const double> row_of(const Problem& problem, const ArrayIn& coefficients) {
  const auto row = vector_of(coefficients, problem.variables(), "coefficients");
  return {row.data(), coefficients.size()};
}

void bind_enums(nb::module_& module) {
  nb::enum_<hqp::Status>(module, "Status", "How a solve ended.")
      .value("SOLVED", hqp::Status::kSolved, "every level is optimal")
      .value("ITERATION_LIMIT", hqp::Status::kIterationLimit,
             "levels from completed_levels on are feasible but not optimal")
      .value("BAD_ROW", hqp::Status::kBadRow, "bad_row is not finite, lb > ub or weight <= 0")
      .value("NUMERICAL_FAILURE", hqp::Status::kNumericalFailure, "x is the last finite point");
  nb::enum_<RowState>(module, "RowState", nb::is_arithmetic(), "Place of a row in its interval.")
      .value("INACTIVE", RowState::kInactive, "inside")
      .value("LOWER", RowState::kLower, "held at its lower bound by lower levels")
      .value("UPPER", RowState::kUpper, "held at its upper bound by lower levels")
      .value("EQUAL", RowState::kEqual, "lb = ub and reached")
      .value("BELOW", RowState::kBelow, "violated: stays below its lower bound")
      .value("ABOVE", RowState::kAbove, "violated: stays above its upper bound");
}

void bind_problem(nb::module_& module) {
  nb::class_<Problem>(module, "Problem",
                      "Levels of rows lb <= c x <= ub, the first level being the most important. "
                      "Equalities have lb = ub; infinite ends are no bounds. Rows keep their id.")
      .def(
          "__init__",
          [](Problem* self, int variables, int levels, int rows) {
            new (self) Problem({.variables = variables, .levels = levels, .rows = rows});
          },
          nb::arg("variables"), nb::arg("levels") = 16, nb::arg("rows") = 256,
          "A problem without levels and rows; `levels` and `rows` are what fits in.")
      .def("add_level", &Problem::add_level, "Appends a level below all others; returns its index.")
      .def(
          "add_row",
          [](Problem& self, const ArrayIn& coefficients, double lb, double ub, double weight) {
            return self.add_row(row_of(self, coefficients), {lb, ub}, weight);
          },
          nb::arg("coefficients"), nb::arg("lb") = -kInfinity, nb::arg("ub") = kInfinity,
          nb::arg("weight") = 1.0, "Appends a row to the last level; returns its id.")
      .def(
          "add_bound",
          [](Problem& self, int variable, double lb, double ub, double weight) {
            return self.add_bound(variable, {lb, ub}, weight);
          },
          nb::arg("variable"), nb::arg("lb") = -kInfinity, nb::arg("ub") = kInfinity,
          nb::arg("weight") = 1.0, "Appends the row x[variable]; returns its id.")
      .def(
          "set_row",
          [](Problem& self, int row, const ArrayIn& coefficients) {
            require_row(self, row);
            require(self.variable(row) < 0, "set_row is not for rows made by add_bound");
            self.set_row(row, row_of(self, coefficients));
          },
          nb::arg("row"), nb::arg("coefficients"))
      .def(
          "set_bounds",
          [](Problem& self, int row, double lb, double ub) {
            require_row(self, row);
            self.set_bounds(row, {lb, ub});
          },
          nb::arg("row"), nb::arg("lb"), nb::arg("ub"))
      .def(
          "set_weight",
          [](Problem& self, int row, double weight) {
            require_row(self, row);
            self.set_weight(row, weight);
          },
          nb::arg("row"), nb::arg("weight"))
      .def_prop_ro("variables", &Problem::variables)
      .def_prop_ro("levels", &Problem::levels)
      .def_prop_ro("rows", &Problem::rows)
      .def(
          "level_of",
          [](const Problem& self, int row) {
            require_row(self, row);
            return self.level_of(row);
          },
          nb::arg("row"), "The level that a row belongs to.");
}

void bind_solution(nb::module_& module) {
  nb::class_<ActiveSet>(module, "ActiveSet",
                        "Guess of the row states; the default is a cold start. A wrong guess costs "
                        "time, never correctness.")
      .def(nb::init<>());
  nb::class_<hqp::Options>(module, "Options", "Tolerances of the solver.")
      .def(nb::init<>())
      .def_rw("rank_tolerance", &hqp::Options::rank_tolerance)
      .def_rw("feasibility_tolerance", &hqp::Options::feasibility_tolerance)
      .def_rw("max_iterations", &hqp::Options::max_iterations)
      .def_rw("minimum_norm", &hqp::Options::minimum_norm,
              "freedom left by the last level goes to the smallest |x|");

  const auto by_level = [](auto member) {
    return [member](const SolutionOut& out) {
      std::vector<std::remove_cvref_t<decltype(out.solution.levels[0].*member)>> values;
      for (const LevelResult& level : out.solution.levels) values.push_back(level.*member);
      return values;
    };
  };
  nb::class_<SolutionOut>(module, "Solution", "Result of one solve.")
      .def_prop_ro("status", [](const SolutionOut& out) { return out.solution.status; })
      .def_prop_ro(
          "iterations", [](const SolutionOut& out) { return out.solution.iterations; },
          "active sets tried")
      .def_prop_ro(
          "completed_levels", [](const SolutionOut& out) { return out.solution.completed_levels; },
          "levels known to be optimal, from the top")
      .def_prop_ro(
          "bad_row", [](const SolutionOut& out) { return out.solution.bad_row; },
          "row that caused BAD_ROW, else -1")
      .def_prop_ro(
          "x",
          [](const SolutionOut& out) { return to_numpy(out.solution.x, {out.solution.x.size()}); },
          "(variables)")
      .def_prop_ro(
          "slack",
          [](const SolutionOut& out) {
            return to_numpy(out.solution.slack, {out.solution.slack.size()});
          },
          "(rows) nearest bound minus c x, 0 inside")
      .def_prop_ro(
          "state", [](const SolutionOut& out) { return out.solution.state; },
          "RowState of every row")
      .def_prop_ro("slack_squared", by_level(&LevelResult::slack_squared),
                   "by level: sum of (weight * slack)^2")
      .def_prop_ro("freedom", by_level(&LevelResult::freedom),
                   "by level: dimensions that it found left to it")
      .def_prop_ro("blocking_row", by_level(&LevelResult::blocking_row),
                   "by level: row above that costs it most, -1: none")
      .def_ro("active_set", &SolutionOut::active_set, "start the next, similar problem with it");
}

}  // namespace

void bind_hqp(nb::module_& module) {
  bind_enums(module);
  bind_problem(module);
  bind_solution(module);
  module.def(
      "solve",
      [](const Problem& problem, const ActiveSet* active, const hqp::Options& options) {
        hqp::Solver solver(problem.capacity());
        SolutionOut out{Solution(problem.capacity()), active ? *active : ActiveSet{}};
        solver.solve(problem, options, out.active_set, out.solution);
        return out;
      },
      nb::arg("problem"), nb::arg("active_set") = nb::none(), nb::arg("options") = hqp::Options{},
      "Minimises the violations of every level, in the order of the levels.");
  module.def(
      "multipliers",
      [](const Problem& problem, const SolutionOut& out, int level, const hqp::Options& options) {
        require(
            level >= 0 && level < problem.levels() &&
                out.solution.x.size() == static_cast<std::size_t>(problem.variables()) &&
                out.solution.state.size() == static_cast<std::size_t>(problem.rows()),
            "the solution is not of this problem, or there is no level " + std::to_string(level));
        hqp::Solver solver(problem.capacity());
        std::vector<double> mu(static_cast<std::size_t>(problem.rows()));
        solver.multipliers(problem, options, out.solution, level, mu);
        const std::size_t rows = mu.size();
        return to_numpy(std::move(mu), {rows});
      },
      nb::arg("problem"), nb::arg("solution"), nb::arg("level"),
      nb::arg("options") = hqp::Options{},
      "(rows) what the rows above `level` do against it: >= 0 at an upper bound, <= 0 at a lower "
      "one.");
  module.def("read_problems", &hqp::read_problems, nb::arg("file"),
             "All problems of a file in the format of docs/hqp.md, plain or gzipped.");
}

}  // namespace hg::python
