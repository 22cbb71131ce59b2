#include "hg/hqp/test/byte_problem.h"

#include <algorithm>
#include <limits>

namespace hg::hqp {
namespace {

using Numbers = ByteProblem::Numbers;

constexpr std::array kScales = {1e3, 1e-3, 1e9, 1e-9};
constexpr std::array kSpecials = {std::numeric_limits<double>::quiet_NaN(),
                                  kInfinity,
                                  -kInfinity,
                                  std::numeric_limits<double>::max(),
                                  std::numeric_limits<double>::min(),
                                  std::numeric_limits<double>::denorm_min(),
                                  1e154,
                                  1e-154,
                                  -0.0};
constexpr double kFraction = 1.0 / 23.0;  // rounds: sums are not exact

double integer(std::uint8_t byte) { return static_cast<std::int8_t>(byte) % 4; }
double fraction(std::uint8_t byte) { return kFraction * static_cast<std::int8_t>(byte); }

// One number in 256 / `one_in` bytes out of a table, else `otherwise`.
template <std::size_t kSize>
double pick(const std::array<double, kSize>& table, std::uint8_t byte, double otherwise) {
  const int from_top = 255 - byte;
  return from_top < static_cast<int>(kSize) ? table[from_top] : otherwise;
}

Interval interval(int kind, double a, double b) {
  switch (kind) {
    case 0:
    case 1:
      return {a, a};
    case 2:
      return {a, kInfinity};
    case 3:
      return {-kInfinity, a};
    case 4:
      return {};
    default:
      return {std::min(a, b), std::max(a, b)};
  }
}

// Coefficients of a row, as a dense one.
std::vector<double> coefficients_of(const Problem& problem, int row) {
  std::vector<double> c(problem.variables());
  if (problem.variable(row) >= 0) {
    c[problem.variable(row)] = 1.0;
  } else {
    const auto coefficients = problem.coefficients(row);
    std::copy(coefficients.begin(), coefficients.end(), c.begin());
  }
  return c;
}

}  // namespace

ByteProblem::ByteProblem(std::span<const std::uint8_t> bytes, Numbers numbers)
    : problem(kCapacity) {
  const std::uint8_t head = bytes.empty() ? 0 : bytes[0];
  const std::uint8_t setting = bytes.size() < 2 ? 0 : bytes[1];
  problem.clear(1 + head % kCapacity.variables);
  options.minimum_norm = setting % 4 != 1;
  constexpr std::array kCaps = {1, 2, 3, 5, 10, 20};
  if (setting >= 224) options.max_iterations = kCaps[setting % kCaps.size()];
  guess.state.fill(static_cast<RowState>(head / kCapacity.variables % 6));
  bytes = bytes.subspan(std::min<std::size_t>(bytes.size(), kHeadBytes));
  for (; bytes.size() >= kRowBytes; bytes = bytes.subspan(kRowBytes)) {
    if (problem.rows() == kCapacity.rows) return;
    add_row(bytes.first(kRowBytes), numbers);
  }
}

void ByteProblem::add_row(std::span<const std::uint8_t> bytes, Numbers numbers) {
  const int new_levels = std::array{0, 1, 0, 0, 2, 0, 0, 1}[bytes[0] / 8 % 8];
  for (int i = 0; i < std::max(new_levels, problem.levels() == 0 ? 1 : 0); ++i) {
    if (problem.levels() < kCapacity.levels) problem.add_level();
  }

  const auto number = bytes[0] / 64 % 2 == 0 ? integer : fraction;
  const std::size_t n = problem.variables();
  const int kind = bytes[0] % 8;
  std::vector<double> c(n);
  if ((kind == 4 || kind == 5) && problem.rows() > 0) {
    const auto one = coefficients_of(problem, bytes[13] % problem.rows());
    const auto other = coefficients_of(problem, bytes[13] / 16 % problem.rows());
    const double factor = kind == 4 ? 0.0 : number(bytes[2]);
    for (std::size_t j = 0; j < n; ++j) c[j] = number(bytes[1]) * one[j] + factor * other[j];
  } else if (kind != 6) {
    for (std::size_t j = 0; j < n; ++j) c[j] = number(bytes[1 + j]);
  }
  double a = number(bytes[10]);
  double b = number(bytes[11]);
  double weight = std::array{1.0, 1.0, 1.0, 1.0, 2.0, 0.5, 3.0, 0.1}[bytes[9] / 8 % 8];

  const double scale = numbers == Numbers::kTame ? 1.0 : pick(kScales, bytes[12], 1.0);
  const double reach = numbers == Numbers::kTame
                           ? 1.0
                           : pick(kScales, static_cast<std::uint8_t>(bytes[12] ^ 64), 1.0);
  for (double& c_j : c) c_j *= scale;
  a *= scale * reach;
  b *= scale * reach;
  if (scale != 1.0 || reach != 1.0) is_tame = false;
  if (numbers == Numbers::kSpecial && bytes[12] >= 128 && bytes[12] < 144) {
    is_tame = false;
    const std::size_t place = bytes[12] % 16;
    double& special = place < n ? c[place] : (place == 13 ? a : (place == 14 ? b : weight));
    special = kSpecials[bytes[13] % kSpecials.size()];
  }

  const Interval bounds = interval(bytes[9] % 8, a, b);
  if (kind < 2) {
    problem.add_bound(bytes[1] % problem.variables(), bounds, weight);
  } else {
    problem.add_row(c, bounds, weight);
  }
  changes_.push_back({bytes[14], bytes[15]});
}

void ByteProblem::change(int step) noexcept {
  for (int row = 0; row < problem.rows(); ++row) {
    const std::uint8_t byte = changes_[row][step];
    const auto [lb, ub] = problem.bounds(row);
    const double shift = 1e-2 * fraction(byte);
    switch (byte % 8) {
      case 1:
      case 2:
        problem.set_bounds(row, {lb + shift, ub + shift});
        break;
      case 3:
        problem.set_bounds(row, {-kInfinity, ub < kInfinity ? ub : fraction(byte)});
        break;
      case 4:
        problem.set_bounds(row, {lb > -kInfinity ? lb : fraction(byte), kInfinity});
        break;
      case 5:
        problem.set_bounds(row, {});
        break;
      case 6:
        problem.set_bounds(row, {fraction(byte), fraction(byte)});
        break;
      default:
        break;
    }
  }
}

}  // namespace hg::hqp
