#include "hg/controller/rendering/device_model.h"

#include <gtest/gtest.h>

#include "hg/controller/rendering/test/test_models.h"

namespace hg::rendering {
namespace {

TEST(HandleLimits, AreTheTighterOnesOfTheHandleAndOfNothingElse) {
  DeviceModel device = unlimited_device();
  const limits::JointLimits wide = {.q_min = -2.0, .q_max = 2.0, .dq_max = 1.0, .ddq_max = 5.0};
  const limits::JointLimits low = {.q_min = -3.0, .q_max = 0.5, .dq_max = 1.5, .ddq_max = 4.0};
  const limits::JointLimits narrow = {.q_min = -0.1, .q_max = 0.1, .dq_max = 0.1, .ddq_max = 0.1};
  device.cartesian_limits = {
      {.name = "hand", .frame = device.handle, .axes = {{wide, wide, {}}}},
      {.name = "elbow", .frame = device.elbow, .axes = {{narrow, narrow, narrow}}},
      {.name = "table", .frame = device.handle, .axes = {{{}, low, {}}}},
  };
  const auto limits = handle_limits(device);
  EXPECT_EQ(limits[0].q_min, -2.0);
  EXPECT_EQ(limits[0].q_max, 2.0);
  EXPECT_EQ(limits[1].q_min, -2.0);
  EXPECT_EQ(limits[1].q_max, 0.5);
  EXPECT_EQ(limits[1].dq_max, 1.0);
  EXPECT_EQ(limits[1].ddq_max, 4.0);
  EXPECT_EQ(limits[2].q_min, -kInfinity);
  EXPECT_EQ(limits[2].ddq_max, kInfinity);
}

}  // namespace
}  // namespace hg::rendering
