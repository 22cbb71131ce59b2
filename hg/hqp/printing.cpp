#include "hg/hqp/printing.h"

#include <cmath>
#include <initializer_list>
#include <string_view>

#include "hg/core/text.h"
#include "hg/hqp/solver/rows.h"

namespace hg::hqp {
namespace {

constexpr int kMostTerms = 6;  // most terms shown of a row

std::string number(double value) { return to_text(value, 6); }

std::string padded(const std::string& text, std::size_t width) {
  return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
}

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

std::string count_of(int count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

void append_term(double coefficient, int variable, std::string& text) {
  const bool is_first = text.empty();
  if (!is_first) text += std::signbit(coefficient) ? " - " : " + ";
  if (is_first && std::signbit(coefficient)) text += "-";
  if (std::abs(coefficient) != 1.0) text += number(std::abs(coefficient)) + " ";
  text += joined({"x", std::to_string(variable)});
}

std::string sum_text(const Problem& problem, int row) {
  std::string text;
  if (problem.variable(row) >= 0) append_term(1.0, problem.variable(row), text);
  int terms = 0;
  const auto coefficients = problem.coefficients(row);
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    if (coefficients[i] == 0.0) continue;
    if (terms++ == kMostTerms) return text + " + ...";
    append_term(coefficients[i], static_cast<int>(i), text);
  }
  return text.empty() ? "0" : text;
}

std::string content_of(const Problem& problem, int row) {
  const auto [lb, ub] = problem.bounds(row);
  std::string text = sum_text(problem, row);
  text +=
      lb == ub ? joined({" = ", number(lb)}) : joined({" in [", number(lb), ", ", number(ub), "]"});
  if (problem.weight(row) != 1.0) text += joined({", weight ", number(problem.weight(row))});
  return text;
}

std::string head_text(const Problem& problem, const Solution& solution) {
  std::string text = to_string(solution.status);
  text += ": " + count_of(solution.iterations, "active set") + " tried; " +
          count_of(problem.variables(), "variable") + ", " + count_of(problem.rows(), "row") +
          ", " + count_of(problem.levels(), "level") + "\n";
  if (solution.bad_row >= 0) {
    text +=
        to_string(problem, solution.bad_row) + ": " + broken_rule(problem, solution.bad_row) + "\n";
  }
  return text;
}

std::string level_line(const Problem& problem, const Solution& solution, int level) {
  const LevelResult& result = solution.levels[level];
  int rows = 0, met = 0, held = 0, violated = 0;
  for (int row = problem.first_row(level); row < problem.end_row(level); ++row) {
    const RowState state = solution.state[row];
    ++rows;
    met += state == RowState::kEqual;
    held += is_at_bound(state);
    violated += is_violated(state);
  }
  std::string text = padded(std::to_string(level), 5) + padded(std::to_string(rows), 6);
  if (solution.bad_level >= 0 && level >= solution.bad_level) return text + "  ignored\n";
  text += padded(std::to_string(met), 6) + padded(std::to_string(held), 6) +
          padded(std::to_string(violated), 10) + padded(std::to_string(result.freedom), 9) +
          padded(number(std::sqrt(result.slack_squared)), 13);
  text += level < solution.completed_levels ? "  optimal" : "  not optimal";
  if (result.blocking_row >= 0) {
    text += joined({", blocked by row ", std::to_string(result.blocking_row)});
  }
  return text + "\n";
}

std::string row_line(const Problem& problem, const Solution& solution, int row) {
  const double slack = solution.slack[row];
  std::string text = joined({to_string(problem, row), ": ", to_string(solution.state[row])});
  if (is_violated(solution.state[row])) text += joined({" by ", number(std::abs(slack))});
  return text + joined({", value ", number(solver::dot(problem, row, solution.x.data())), "\n"});
}

}  // namespace

const char* to_string(RowState state) noexcept {
  switch (state) {
    case RowState::kInactive:
      return "inactive";
    case RowState::kLower:
      return "held at its lower bound";
    case RowState::kUpper:
      return "held at its upper bound";
    case RowState::kEqual:
      return "met";
    case RowState::kBelow:
      return "violated, too small";
    case RowState::kAbove:
      return "violated, too large";
  }
  return "unknown";
}

std::string to_string(const Problem& problem, int row) {
  return joined({"row ", std::to_string(row), " (level ", std::to_string(problem.level_of(row)),
                 "): ", content_of(problem, row)});
}

std::string to_string(const SolverOptions& options) {
  return joined({"rank_tolerance ", number(options.rank_tolerance), ", feasibility_tolerance ",
                 number(options.feasibility_tolerance), ", max_iterations ",
                 std::to_string(options.max_iterations),
                 options.budget > 0 ? ", budget " + std::to_string(options.budget) : "",
                 options.minimum_norm ? ", freedom left goes to the smallest |x|"
                                      : ", freedom left is left"});
}

std::string to_string(const Problem& problem, const Solution& solution) {
  std::string text = head_text(problem, solution);
  text += "level  rows equal  held  violated  freedom        slack\n";
  for (int level = 0; level < problem.levels(); ++level) {
    text += level_line(problem, solution, level);
  }
  for (int row = 0; row < problem.rows(); ++row) {
    const RowState state = solution.state[row];
    if (is_at_bound(state) || is_violated(state)) text += row_line(problem, solution, row);
  }
  return text;
}

std::string to_string(const Problem& problem, int level, std::span<const double> multipliers,
                      double remainder) {
  std::string text = joined({"multipliers of level ", std::to_string(level),
                             "; of the gradient they leave ", number(remainder), "\n"});
  for (int row = 0; row < problem.rows(); ++row) {
    const double mu = multipliers[row];
    if (mu != 0.0) text += joined({padded(number(mu), 13), "  ", to_string(problem, row), "\n"});
  }
  return text;
}

}  // namespace hg::hqp
