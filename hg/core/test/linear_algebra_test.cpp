#include "hg/core/linear_algebra.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace hg {
namespace {

Eigen::MatrixXd random_matrix(int size, double radius) {
  static std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd A =
      Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(random); });
  return A * (radius / spectral_radius(A));
}

TEST(LinearAlgebra, PowersDecayBelowASpectralRadiusOfOne) {
  for (const int size : {1, 6, 60}) {
    for (const double radius : {0.0, 0.5, 0.99, 0.9999, 0.999999}) {
      EXPECT_TRUE(has_decaying_powers(random_matrix(size, radius))) << size << " " << radius;
    }
    for (const double radius : {1.000001, 1.0001, 1.01, 2.0, 1e9}) {
      EXPECT_FALSE(has_decaying_powers(random_matrix(size, radius))) << size << " " << radius;
    }
  }
}

TEST(LinearAlgebra, PowersThatFirstGrowDecayToo) {
  Eigen::MatrixXd A(2, 2);
  A << 0.9, 1e9, 0.0, 0.9;
  EXPECT_TRUE(has_decaying_powers(A));
  A(1, 1) = 1.1;
  EXPECT_FALSE(has_decaying_powers(A));
}

TEST(LinearAlgebra, PowersOfWhatIsNotFiniteDoNotDecay) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
    A(0, 2) = bad;
    EXPECT_FALSE(has_decaying_powers(A));
  }
}

}  // namespace
}  // namespace hg
