#include "hg/model/chain_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/model/test/models.h"

namespace hg::model {
namespace {

TEST(ChainModel, JointsAreListedWithTheirPlacesInQAndDq) {
  const ChainModel chain = mixed_chain();
  ASSERT_EQ(chain.joints().size(), 4u);
  EXPECT_EQ(chain.nq(), 10);
  EXPECT_EQ(chain.nv(), 9);
  const Joint& free = chain.joints()[2];
  EXPECT_EQ(free.name, "free");
  EXPECT_EQ(free.type, JointType::kFloating);
  EXPECT_EQ(free.q_index, 2);
  EXPECT_EQ(free.v_index, 2);
  EXPECT_EQ(free.nq, 7);
  EXPECT_EQ(free.nv, 6);
  EXPECT_FALSE(free.position.bounded());
  const Joint& spin = chain.joints()[3];
  EXPECT_EQ(spin.type, JointType::kContinuous);
  EXPECT_EQ(spin.q_index, 9);
  EXPECT_EQ(spin.v_index, 8);
  EXPECT_EQ(spin.nq, 1);
  EXPECT_EQ(chain.joint("spin"), 3);
}

TEST(ChainModel, AFloatingRootWithoutMassIsRefused) {
  EXPECT_THROW(haptic_giant_chain({.T_B_root = {}, .floating_root = true}), SetupError);
}

TEST(ChainModel, WrongNamesAreAnsweredWithTheNearest) {
  const ChainModel chain = haptic_giant_chain();
  const auto message_of = [](auto call) -> std::string {
    try {
      call();
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message_of([&] { (void)chain.frame("hand"); }),
            "haptic_giant: frame must be one of the chain, got 'hand', nearest is 'handle'");
  EXPECT_EQ(message_of([&] { (void)chain.joint("M7"); }),
            "haptic_giant: joint must be one of the chain, got 'M7', nearest is 'm1'");
}

TEST(ChainModel, AnImpossibleFreeBodyIsRefused) {
  EXPECT_THROW(ChainModel::free_body({.mass = 0.0}), SetupError);
  EXPECT_THROW(ChainModel::free_body({.inertia = Eigen::Vector3d(1, 1, 3).asDiagonal()}),
               SetupError);
  EXPECT_THROW(ChainModel::free_body({.p_handle_com = Eigen::Vector3d(0, std::nan(""), 0)}),
               SetupError);
}

TEST(ChainModel, IntegrationIsExactForTinySteps) {
  const ChainModel body = ChainModel::free_body({});
  const Eigen::VectorXd step = 1e-5 * Eigen::VectorXd{{1.0, -2.0, 3.0, -4.0, 5.0, 6.0}};
  const ConfigurationA q = body.integrate(body.neutral(), step);
  const double half = 0.5 * step.tail<3>().norm();
  const Eigen::Vector3d axis_part = std::sin(half) * step.tail<3>().normalized();
  EXPECT_LT((q.segment<3>(3) - axis_part).norm(), 1e-19);
  EXPECT_LT((q.head<3>() - step.head<3>()).norm(), 2e-9);
}

TEST(ChainModel, IntegrationKeepsQuaternionsNormalisedOverAMillionSteps) {
  const ChainModel body = ChainModel::free_body({});
  ConfigurationA q = body.neutral();
  const Eigen::VectorXd step{{0.0, 0.0, 0.0, 2e-3, -1e-3, 3e-3}};
  for (int i = 0; i < 1'000'000; ++i) q = body.integrate(q, step);
  EXPECT_NEAR(q.tail<4>().norm(), 1.0, 1e-12);
  const double angle = std::remainder(1e6 * step.norm(), 2.0 * std::numbers::pi);
  EXPECT_NEAR(std::abs(q[6]), std::abs(std::cos(0.5 * angle)), 1e-6);
}

TEST(ChainModel, IntegrationAddsScalarCoordinatesWithoutWrapping) {
  const ChainModel chain = haptic_giant_chain();
  const Eigen::VectorXd q = Eigen::VectorXd::LinSpaced(8, -20.0, 20.0);
  const Eigen::VectorXd step = Eigen::VectorXd::LinSpaced(8, 5.0, 7.0);
  EXPECT_LT((chain.integrate(q, step) - (q + step)).norm(), 1e-14);
}

TEST(ChainModel, CopiesShareTheirContents) {
  const ChainModel chain = mixed_chain();
  AllocationCounter counter;
  const ChainModel copy(chain);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_EQ(&copy.joints(), &chain.joints());
}

}  // namespace
}  // namespace hg::model
