#include "hg/hqp/problem.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

#include "hg/core/error.h"

namespace hg::hqp {
namespace {

[[noreturn]] void refuse(const char* item, int value, int min, int max) {
  throw SetupError(std::string(item) + ": must be " + std::to_string(min) + ".." +
                   std::to_string(max) + ", got " + std::to_string(value));
}

void require_in_range(const char* item, int value, int min, int max) {
  if (value < min || value > max) refuse(item, value, min, max);
}

}  // namespace

double norm_of(std::span<const double> v) noexcept {
  double sum = 0.0;
  for (const double value : v) sum += value * value;
  return std::sqrt(sum);
}

void check_capacity(const Capacity& capacity) {
  require_in_range("hqp capacity: variables", capacity.variables, 1, kMaxVariables);
  require_in_range("hqp capacity: levels", capacity.levels, 1, kMaxLevels);
  require_in_range("hqp capacity: rows", capacity.rows, 1, kMaxRows);
}

Problem::Problem(const Capacity& capacity) : capacity_(capacity), variables_(capacity.variables) {
  check_capacity(capacity);
  first_row_.reserve(capacity.levels + 1);
  first_row_.assign(1, 0);
  rows_.reserve(capacity.rows);
  coefficients_.assign(capacity.rows * capacity.variables, 0.0);
}

void Problem::clear(int variables) {
  require_in_range("hqp problem: variables", variables, 1, capacity_.variables);
  variables_ = variables;
  first_row_.assign(1, 0);
  rows_.clear();
}

int Problem::add_level() {
  require_in_range("hqp problem: levels", levels() + 1, 1, capacity_.levels);
  first_row_.push_back(rows());
  return levels() - 1;
}

int Problem::append(Interval bounds, double weight, int variable, double norm) {
  if (levels() == 0) throw SetupError("hqp problem: add a level before its first row");
  require_in_range("hqp problem: rows", rows() + 1, 1, capacity_.rows);
  rows_.push_back({bounds, weight, norm, variable});
  first_row_.back() = rows();
  return rows() - 1;
}

int Problem::add_row(std::span<const double> coefficients, Interval bounds, double weight) {
  require_in_range("hqp row: number of coefficients", static_cast<int>(coefficients.size()),
                   variables_, variables_);
  const int row = append(bounds, weight, -1, 0.0);
  set_row(row, coefficients);
  return row;
}

int Problem::add_bound(int variable, Interval bounds, double weight) {
  require_in_range("hqp bound: variable", variable, 0, variables_ - 1);
  return append(bounds, weight, variable, 1.0);
}

void Problem::set_row(int row, std::span<const double> coefficients) noexcept {
  assert(row >= 0 && row < rows() && variable(row) < 0);
  assert(coefficients.size() == variables_);
  double* const own = coefficients_.data() + row * capacity_.variables;
  double sum = 0.0;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const double c = coefficients[i];
    own[i] = c;
    sum += c * c;
  }
  rows_[row].norm = std::sqrt(sum);
}

void Problem::set_bounds(int row, Interval bounds) noexcept {
  assert(row >= 0 && row < rows());
  rows_[row].bounds = bounds;
}

void Problem::set_weight(int row, double weight) noexcept {
  assert(row >= 0 && row < rows());
  rows_[row].weight = weight;
}

int Problem::level_of(int row) const noexcept {
  const auto next = std::upper_bound(first_row_.begin(), first_row_.end() - 1, row);
  return static_cast<int>(next - first_row_.begin()) - 1;
}

}  // namespace hg::hqp
