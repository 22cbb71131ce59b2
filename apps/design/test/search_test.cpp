/// The search against all candidates of a reduced problem: two lengths and two ratios on a grid.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "apps/design/optimiser.h"
#include "hg/core/error.h"
#include "hg/design/design_problem.h"

namespace hg::search {
namespace {

constexpr std::array<int, 4> kSteps = {6, 6, 4, 4};  // L1, L2, ratio of m1, ratio of m4

// All candidates, judged once.
class Grid {
 public:
  Grid() {
    design::DesignProblem problem = design::load_problem("models/design/haptic_giant.yaml");
    problem.search.poses = 60;
    const design::Judge judge(problem);
    for (int i = 0; i < kSteps[0]; ++i) {
      for (int j = 0; j < kSteps[1]; ++j) {
        for (int k = 0; k < kSteps[2]; ++k) {
          for (int l = 0; l < kSteps[3]; ++l) {
            design::DesignVariables variables = problem.base.variables;
            variables.lengths.L1 = 0.40 + 0.06 * i;
            variables.lengths.L2 = 0.40 + 0.06 * j;
            variables.ratio[0] = k;
            variables.ratio[3] = l;
            const design::DesignScore score = judge(variables);
            values_.push_back({10.0 * score.violation - score.capability,
                               10.0 * score.violation + score.moving_mass / 40.0});
          }
        }
      }
    }
  }

  std::vector<double> operator()(const Point& x) const {
    std::size_t index = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      index =
          index * static_cast<std::size_t>(kSteps[i]) + static_cast<std::size_t>(std::lround(x[i]));
    }
    return values_[index];
  }

  double best() const {
    double best = values_[0][0];
    for (const std::vector<double>& value : values_) best = std::min(best, value[0]);
    return best;
  }

  Problem problem(std::size_t objectives) const {
    return {.lower = {0, 0, 0, 0},
            .upper = {kSteps[0] - 1.0, kSteps[1] - 1.0, kSteps[2] - 1.0, kSteps[3] - 1.0},
            .integers = 4,
            .objectives = objectives,
            .evaluate = [this, objectives](const Point& x) {
              std::vector<double> value = (*this)(x);
              value.resize(objectives);
              return value;
            }};
  }

 private:
  std::vector<std::vector<double>> values_;
};

const Grid& grid() {
  static const Grid grid;
  return grid;
}

Options options(std::uint64_t seed, unsigned workers = 2) {
  return {.population = 20, .generations = 40, .islands = 2, .workers = workers, .seed = seed};
}

TEST(Search, FindsTheBestOfTheGridFromEverySeed) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Best found =
        minimise(grid().problem(1), {Algorithm::kGenetic, Algorithm::kAntColony}, options(seed));
    EXPECT_EQ(found.value, grid().best()) << "seed " << seed;
  }
}

TEST(Search, TheFrontOfASeedIsTheSameOnAnyNumberOfThreads) {
  const std::vector<FrontPoint> one = front(grid().problem(2), options(3, 1));
  const std::vector<FrontPoint> two = front(grid().problem(2), options(3, 2));
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].x, two[i].x);
    EXPECT_EQ(one[i].values, two[i].values);
  }
}

TEST(Search, AVariableWithEqualBoundsIsKept) {
  Problem one = grid().problem(1), two = grid().problem(2);
  for (Problem* problem : {&one, &two}) {
    problem->lower[0] = problem->upper[0] = 2.0;
    problem->lower[3] = problem->upper[3] = 1.0;
  }
  const Best best = minimise(one, {Algorithm::kGenetic, Algorithm::kAntColony}, options(1));
  ASSERT_EQ(best.x.size(), 4u);
  EXPECT_EQ(best.x[0], 2.0);
  EXPECT_EQ(best.x[3], 1.0);
  EXPECT_EQ(best.value, grid()(best.x)[0]);
  for (const FrontPoint& point : front(two, options(1))) {
    ASSERT_EQ(point.x.size(), 4u);
    EXPECT_EQ(point.x[0], 2.0);
    EXPECT_EQ(point.x[3], 1.0);
  }
  one.upper = one.lower;
  EXPECT_THROW(minimise(one, {Algorithm::kGenetic}, options(1)), SetupError);
}

TEST(Search, NoPointOfTheFrontBeatsAnother) {
  const std::vector<FrontPoint> points = front(grid().problem(2), options(1));
  ASSERT_GT(points.size(), 1u);
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GT(points[i].values[0], points[i - 1].values[0]);
    EXPECT_LT(points[i].values[1], points[i - 1].values[1]);
  }
}

}  // namespace
}  // namespace hg::search
