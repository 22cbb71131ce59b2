/// Bindings of hapticgiant.hqp: problems from numpy, solutions as numpy.
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/hqp/printing.h"
#include "hg/hqp/solver.h"
#include "hg/hqp/text.h"
#include "python/src/arrays.h"
#include "python/src/bind.h"

namespace hg::python {
namespace {

using hqp::ActiveSet;
using hqp::LevelResult;
using hqp::Problem;
using hqp::RowState;
using hqp::Solution;

// a solution, its problem, and its final active set
struct SolutionOut {
  Problem problem;
  hqp::SolverOptions options;
  Solution solution;
  ActiveSet active_set;
};

using IntegersOut = nb::ndarray<nb::numpy, const std::int32_t>;

// get(i) for i < size, as a copy that Python owns
template <typename Get>
nb::object integers(std::size_t size, Get get) {
  auto* owned = new std::vector<std::int32_t>(size);
  const nb::capsule owner(
      owned, [](void* p) noexcept { delete static_cast<std::vector<std::int32_t>*>(p); });
  for (std::size_t i = 0; i < size; ++i) (*owned)[i] = static_cast<std::int32_t>(get(i));
  return nb::cast(IntegersOut(owned->data(), {size}, owner), nb::rv_policy::automatic);
}

ArrayOut vector_to_numpy(std::vector<double> numbers) {
  const std::size_t size = numbers.size();
  return to_numpy(std::move(numbers), {size});
}

// array of a member of every level's result
template <int LevelResult::*kMember>
nb::object by_level(const SolutionOut& out) {
  const auto& levels = out.solution.levels;
  return integers(levels.size(), [&](std::size_t i) { return levels[i].*kMember; });
}

ArrayOut slack_squared_of(const SolutionOut& out) {
  std::vector<double> values;
  for (const LevelResult& level : out.solution.levels) values.push_back(level.slack_squared);
  return vector_to_numpy(std::move(values));
}

// number i of an array with either one number for all, or `size`
double number_of(const ArrayIn& in, std::size_t i, std::size_t size, const char* name) {
  if (in.size() != 1 && in.size() != size) refuse_size(name, size, in.size());
  return in.data()[in.size() == 1 ? 0 : i];
}

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

// `A` (rows x variables), or one row
std::vector<int> add_rows(Problem& problem, const ArrayIn& A, const ArrayIn& lb, const ArrayIn& ub,
                          const ArrayIn& weights) {
  const std::size_t n = problem.variables();
  const std::size_t columns = A.array.ndim() == 0 ? 1 : A.array.shape(A.array.ndim() - 1);
  if (columns != n) refuse_size("A: columns", n, columns);
  const std::size_t rows = A.size() / n;
  std::vector<int> ids;
  for (std::size_t i = 0; i < rows; ++i) {
    const Interval bounds = {number_of(lb, i, rows, "lb"), number_of(ub, i, rows, "ub")};
    ids.push_back(
        problem.add_row({A.data() + i * n, n}, bounds, number_of(weights, i, rows, "weights")));
  }
  return ids;
}

std::vector<int> add_bounds(Problem& problem, const ArrayIn& lb, const ArrayIn& ub,
                            const ArrayIn& weights) {
  const std::size_t n = problem.variables();
  std::vector<int> ids;
  for (std::size_t i = 0; i < n; ++i) {
    const Interval bounds = {number_of(lb, i, n, "lb"), number_of(ub, i, n, "ub")};
    ids.push_back(
        problem.add_bound(static_cast<int>(i), bounds, number_of(weights, i, n, "weights")));
  }
  return ids;
}

SolutionOut solve(const Problem& problem, const ActiveSet* active,
                  const hqp::SolverOptions& options) {
  hqp::check_solver_options(options);
  hqp::Solver solver(problem.capacity());
  SolutionOut out{problem, options, Solution(problem.capacity()), active ? *active : ActiveSet{}};
  const hqp::Status status = solver.solve(problem, options, out.active_set, out.solution);
  const int bad_row = out.solution.bad_row;
  require(status != hqp::Status::kBadRow, bad_row < 0 ? ""
                                                      : hqp::to_string(problem, bad_row) + ": " +
                                                            hqp::broken_rule(problem, bad_row));
  return out;
}

std::vector<double> multipliers_of(const SolutionOut& out, int level, double& remainder) {
  require(level >= 0 && level < out.problem.levels(), "there is no level " + std::to_string(level));
  hqp::Solver solver(out.problem.capacity());
  std::vector<double> mu(out.problem.rows());
  remainder = solver.multipliers(out.problem, out.options, out.solution, level, mu);
  return mu;
}

std::string explain(const SolutionOut& out, std::optional<int> level) {
  std::string text = hqp::to_string(out.problem, out.solution);
  if (!level) return text;
  double remainder = 0.0;
  const std::vector<double> mu = multipliers_of(out, *level, remainder);
  return text + hqp::to_string(out.problem, *level, mu, remainder);
}

void write_problem(const std::string& file, const Problem& problem, const ActiveSet* active,
                   const hqp::SolverOptions& options, const std::string& name) {
  hqp::check_solver_options(options);  // before the file is touched
  std::optional<ActiveSet> guess;
  if (active != nullptr) guess = *active;
  std::ofstream out(file);
  hqp::write_problem(out, {.problem = problem, .options = options, .guess = guess, .name = name});
  out.close();
  if (!out) throw SetupError(file + ": cannot be written");
}

void bind_enums(nb::module_& module) {
  nb::enum_<hqp::Status>(module, "Status", "How a solve ended.")
      .value("SOLVED", hqp::Status::kSolved, "every level is optimal")
      .value("ITERATION_LIMIT", hqp::Status::kIterationLimit,
             "levels from completed_levels on are not known to be optimal")
      .value("NUMERICAL_FAILURE", hqp::Status::kNumericalFailure, "x is the last finite point");
  nb::enum_<RowState>(module, "RowState", nb::is_arithmetic(), "Place of a row in its interval.")
      .value("INACTIVE", RowState::kInactive, "inside")
      .value("LOWER", RowState::kLower, "held at its lower bound by lower levels")
      .value("UPPER", RowState::kUpper, "held at its upper bound by lower levels")
      .value("EQUAL", RowState::kEqual, "lb = ub and reached")
      .value("BELOW", RowState::kBelow, "violated: stays below its lower bound")
      .value("ABOVE", RowState::kAbove, "violated: stays above its upper bound");
}

// Adds the functions for single rows.
void bind_single_rows(nb::class_<Problem>& problem) {
  problem
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
      .def(
          "level_of",
          [](const Problem& self, int row) {
            require_row(self, row);
            return self.level_of(row);
          },
          nb::arg("row"), "The level that a row belongs to.");
}

void bind_problem(nb::module_& module) {
  nb::class_<Problem> problem(
      module, "Problem",
      "Levels of rows lb <= c x <= ub, the first level being the most important. "
      "Equalities have lb = ub; infinite ends are no bounds. Rows keep their id.");
  problem
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
      .def("add_rows", &add_rows, nb::arg("A"), nb::arg("lb"), nb::arg("ub"),
           nb::arg("weights") = 1.0,
           "Appends the rows of A (m x variables) to the last level; lb, ub and weights have m "
           "numbers or one for all. Returns the ids.")
      .def("add_bounds", &add_bounds, nb::arg("lb"), nb::arg("ub"), nb::arg("weights") = 1.0,
           "Appends a row per variable to the last level, as add_rows(). Returns the ids.")
      .def_prop_ro("variables", &Problem::variables)
      .def_prop_ro("levels", &Problem::levels)
      .def_prop_ro("rows", &Problem::rows);
  bind_single_rows(problem);
}

void bind_options(nb::module_& module) {
  nb::class_<ActiveSet>(module, "ActiveSet",
                        "Guess of the row states; the default is a cold start. A wrong guess costs "
                        "time, never correctness.")
      .def(nb::init<>());
  nb::class_<hqp::SolverOptions>(module, "Options", "Tolerances of the solver.")
      .def(nb::init<>())
      .def_rw("rank_tolerance", &hqp::SolverOptions::rank_tolerance)
      .def_rw("feasibility_tolerance", &hqp::SolverOptions::feasibility_tolerance)
      .def_rw("max_iterations", &hqp::SolverOptions::max_iterations)
      .def_rw("budget", &hqp::SolverOptions::budget,
              "active sets before the solve is brought to an end, 0: no such limit")
      .def_rw("minimum_norm", &hqp::SolverOptions::minimum_norm,
              "freedom left by the last level goes to the smallest |x|");

  nb::class_<hqp::RecordedProblem>(module, "RecordedProblem",
                                   "A problem and how it is to be solved.")
      .def_ro("problem", &hqp::RecordedProblem::problem)
      .def_ro("options", &hqp::RecordedProblem::options)
      .def_ro("active_set", &hqp::RecordedProblem::guess, "None: nothing is known")
      .def_ro("name", &hqp::RecordedProblem::name, "where it comes from");
}

void bind_solution(nb::module_& module) {
  nb::class_<SolutionOut>(module, "Solution", "Result of one solve.")
      .def_prop_ro("status", [](const SolutionOut& out) { return out.solution.status; })
      .def_prop_ro(
          "iterations", [](const SolutionOut& out) { return out.solution.iterations; },
          "active sets tried")
      .def_prop_ro(
          "completed_levels", [](const SolutionOut& out) { return out.solution.completed_levels; },
          "levels known to be optimal, from the top")
      .def_prop_ro(
          "x", [](const SolutionOut& out) { return vector_to_numpy(out.solution.x); },
          "(variables)")
      .def_prop_ro(
          "slack", [](const SolutionOut& out) { return vector_to_numpy(out.solution.slack); },
          "(rows) nearest bound minus c x, 0 inside")
      .def_prop_ro(
          "state",
          [](const SolutionOut& out) {
            const auto& state = out.solution.state;
            return integers(state.size(), [&](std::size_t i) { return state[i]; });
          },
          "(rows) RowState of every row")
      .def_prop_ro("slack_squared", &slack_squared_of, "(levels) sum of (weight * slack)^2")
      .def_prop_ro("freedom", &by_level<&LevelResult::freedom>,
                   "(levels) dimensions that each level found left to it")
      .def_prop_ro("blocking_row", &by_level<&LevelResult::blocking_row>,
                   "(levels) row above that costs each level most, -1: none")
      .def(
          "multipliers",
          [](const SolutionOut& out, int level) {
            double remainder = 0.0;
            return vector_to_numpy(multipliers_of(out, level, remainder));
          },
          nb::arg("level"),
          "(rows) what the rows above `level` do against it: >= 0 at an upper bound, <= 0 at a "
          "lower one.")
      .def("explain", &explain, nb::arg("level") = nb::none(),
           "Levels and rows that act, in words; with the multipliers of `level`.")
      .def("__str__", [](const SolutionOut& out) { return explain(out, {}); })
      .def_ro("active_set", &SolutionOut::active_set, "start the next, similar problem with it");
}

}  // namespace

void bind_hqp(nb::module_& module) {
  bind_enums(module);
  bind_problem(module);
  bind_options(module);
  bind_solution(module);
  module.def("solve", &solve, nb::arg("problem"), nb::arg("active_set") = nb::none(),
             nb::arg("options") = hqp::SolverOptions{},
             "Minimises the violations of every level, in the order of the levels. Raises "
             "ValueError with the first row that is not right: not finite, lb > ub, weight <= 0; "
             "SetupError for options that are not.");
  module.def("read_problems", &hqp::read_problems, nb::arg("file"),
             "All problems of a file in the format of docs/concepts/hqp.md, plain or gzipped.");
  module.def("read_recorded_problems", &hqp::read_recorded_problems, nb::arg("file"),
             "The same with how each is to be solved.");
  module.def("write_problem", &write_problem, nb::arg("file"), nb::arg("problem"),
             nb::arg("active_set") = nb::none(), nb::arg("options") = hqp::SolverOptions{},
             nb::arg("name") = "", "Writes a file that reads back to the same bits.");
}

}  // namespace hg::python
