#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "hg/limits/acceleration_bounds.h"

namespace hg::limits {
namespace {

const std::string kFolder = "hg/limits/test/data/";
// The files solve quadratic equations with coefficients of order dq^2 for an acceleration: they
// lose digits in the ratio of dq / dt to the acceleration, up to 1e5 here.
constexpr double kRounding = 1e-10;

using Row = std::vector<std::string>;

std::vector<Row> read_table(const std::string& name) {
  std::ifstream file(kFolder + name);
  std::vector<Row> rows;
  std::string line;
  std::getline(file, line);  // column names
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string cell;
    rows.emplace_back();
    while (std::getline(cells, cell, ',')) rows.back().push_back(cell);
  }
  return rows;
}

double number(const Row& row, std::size_t column) { return std::stod(row.at(column)); }

// Columns q, dq, q_min, q_max, dq_max, ddq_max, dt from `first` on.
struct State {
  JointLimits limits;
  double q, dq, dt;
};

State state(const Row& row, std::size_t first) {
  return {{.q_min = number(row, first + 2),
           .q_max = number(row, first + 3),
           .dq_max = number(row, first + 4),
           .ddq_max = number(row, first + 5)},
          number(row, first),
          number(row, first + 1),
          number(row, first + 6)};
}

void expect_same(Interval got, const Row& row, std::size_t first, double dq, double dt) {
  const double scale = std::abs(dq) / dt;
  const auto same = [scale](double x, double y) {
    return x == y || std::abs(x - y) <= kRounding * std::max({1.0, std::abs(y), scale});
  };
  EXPECT_PRED2(same, got.lb, number(row, first));
  EXPECT_PRED2(same, got.ub, number(row, first + 1));
}

TEST(Reference, RecoverableBoundsAgreeWithAnIndependentImplementation) {
  const std::vector<Row> rows = read_table("recoverable_bounds.csv");
  ASSERT_EQ(rows.size(), 2000u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    SCOPED_TRACE("row " + std::to_string(k));
    const auto [limits, q, dq, dt] = state(rows[k], 0);
    const RecoverableOptions options = {.tau = number(rows[k], 7),
                                        .tau_rec = number(rows[k], 10),
                                        .v_rec = number(rows[k], 9),
                                        .ddq_rec_factor = number(rows[k], 8)};
    expect_same(recoverable_bounds(limits, options, q, dq, dt), rows[k], 11, dq, dt);
  }
}

TEST(Reference, PaperBoundsAgreeWithAnIndependentImplementation) {
  const std::vector<Row> rows = read_table("paper_bounds.csv");
  ASSERT_EQ(rows.size(), 1500u);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    SCOPED_TRACE("row " + std::to_string(k));
    const auto [limits, q, dq, dt] = state(rows[k], 0);
    const double T_C = number(rows[k], 7);
    expect_same(bounds_A(limits, q, dq, dt), rows[k], 8, dq, dt);
    expect_same(bounds_B(limits, q, dq, dt), rows[k], 10, dq, dt);
    expect_same(bounds_C(limits, q, dq, T_C), rows[k], 12, dq, T_C);
  }
}

TEST(Reference, PaperBoundsAgreeWithRecordedRuns) {
  const std::vector<Row> rows = read_table("recorded_bounds.csv");
  ASSERT_EQ(rows.size(), 500u);
  for (const Row& row : rows) {
    const auto [limits, q, dq, dt] = state(row, 2);
    SCOPED_TRACE(row[0] + ", " + row[1] + " at " + row[2]);
    if (row[1] == "s") {
      expect_same(bounds_C(limits, q, dq, dt), row, 9, dq, dt);
    } else {
      expect_same(bounds_A(limits, q, dq, dt), row, 9, dq, dt);
      expect_same(bounds_B(limits, q, dq, dt), row, 11, dq, dt);
    }
  }
}

}  // namespace
}  // namespace hg::limits
