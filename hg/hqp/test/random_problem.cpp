#include "hg/hqp/test/random_problem.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace hg::hqp {
namespace {

class Generator {
 public:
  Generator(std::uint32_t seed, const RandomKind& kind) : random_(seed), kind_(kind) {}

  Problem make() {
    const int n = integer(1, kind_.max_variables);
    const int levels = integer(1, kind_.max_levels);
    Problem problem({n, levels, levels * kind_.max_rows_per_level});
    const double equality_share = uniform(0.0, 0.7);
    for (int level = 0; level < levels; ++level) {
      problem.add_level();
      const int rows = integer(0, kind_.max_rows_per_level);
      const bool is_equality_level = chance(0.3);
      for (int i = 0; i < rows; ++i) {
        add_row(problem, chance(is_equality_level ? 1.0 : equality_share));
      }
    }
    return problem;
  }

 private:
  int integer(int min, int max) { return std::uniform_int_distribution<int>(min, max)(random_); }
  double uniform(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random_);
  }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  double value() {
    return kind_.has_integers ? integer(-2, 2) : std::normal_distribution<double>()(random_);
  }

  std::vector<double> coefficients(int n) {
    std::vector<double> c(n, 0.0);
    const double kind = uniform(0.0, 1.0);
    if (kind < 0.05) return c;
    if (kind < 0.2 && !earlier_.empty()) {
      c = earlier_[integer(0, static_cast<int>(earlier_.size()) - 1)];
      if (kind_.noise > 0.0) {
        for (double& c_j : c) c_j *= 1.0 + kind_.noise * value();
      }
    } else if (kind < 0.35 && !earlier_.empty()) {
      for (const auto& row : earlier_) {
        const double factor = chance(0.3) ? value() : 0.0;
        for (std::size_t j = 0; j < c.size(); ++j) c[j] += factor * row[j];
      }
    } else {
      const double density = chance(0.5) ? 1.0 : 0.4;
      for (double& c_j : c) c_j = chance(density) ? value() : 0.0;
    }
    const double factor = std::pow(10.0, uniform(-kind_.row_decades, kind_.row_decades));
    for (double& c_j : c) c_j *= factor;
    return c;
  }

  Interval bounds(bool is_equality, double norm) {
    const double a = norm * kind_.scale * value();
    const double b = norm * kind_.scale * value();
    if (is_equality) return {a, a};
    const double kind = uniform(0.0, 1.0);
    if (kind < 0.1) return {};
    if (kind < 0.35) return {a, kInfinity};
    if (kind < 0.6) return {-kInfinity, a};
    return {std::min(a, b), std::max(a, b)};
  }

  void add_row(Problem& problem, bool is_equality) {
    const double weight = chance(0.8) ? 1.0 : std::pow(10.0, uniform(-1.0, 1.0));
    const int n = problem.variables();
    std::vector<double> c(n, 0.0);
    if (chance(0.4)) {
      const int variable = integer(0, n - 1);
      c[variable] = 1.0;
      problem.add_bound(variable, bounds(is_equality, 1.0), weight);
    } else {
      c = coefficients(n);
      double norm = 0.0;
      for (const double c_j : c) norm = std::hypot(norm, c_j);
      if (kind_.has_integers || norm == 0.0) norm = 1.0;
      problem.add_row(c, bounds(is_equality, norm), weight);
    }
    earlier_.push_back(c);
  }

  std::mt19937 random_;
  const RandomKind& kind_;
  std::vector<std::vector<double>> earlier_;
};

}  // namespace

Problem random_problem(std::uint32_t seed, const RandomKind& kind) {
  return Generator(seed, kind).make();
}

}  // namespace hg::hqp
