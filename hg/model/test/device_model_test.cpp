#include "hg/model/device_model.h"

#include <gtest/gtest.h>

#include "hg/core/test/message_of.h"

namespace hg {
namespace {

DeviceModel haptic_giant() {
  DeviceModel device{
      .chain = model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf"),
      .n_p = 2,
      .n_m = 6};
  device.handle = device.chain.frame("handle");
  device.elbow = device.chain.frame("elbow");
  device.gantry_range.resize(2);
  device.joint_limits.resize(6);
  return device;
}

TEST(DeviceModel, ChecksEachFactThatItsPartsRelyOn) {
  const auto message = [](auto change) {
    DeviceModel device = haptic_giant();
    change(device);
    return message_of([&] { check_device_model(device); });
  };
  EXPECT_EQ(message([](DeviceModel&) {}), "no error");
  EXPECT_EQ(message([](DeviceModel& d) { d.rate_Hz = 99.0; }),
            "rate_Hz: must be 100..20000, got 99");
  EXPECT_NE(message([](DeviceModel& d) { d.rate_Hz = NAN; }), "no error");
  EXPECT_EQ(message([](DeviceModel& d) { d.n_p = 1; }),
            "device: gantry and manipulator must be all joints of the chain");
  EXPECT_EQ(message([](DeviceModel& d) { d.gantry_range.pop_back(); }),
            "device: one range per gantry axis is needed");
  EXPECT_EQ(message([](DeviceModel& d) {
              d.gantry_range[1] = {1.0, -1.0};
            }),
            "device: ranges of the gantry must not be reversed");
  EXPECT_EQ(message([](DeviceModel& d) { d.joint_limits.pop_back(); }),
            "device: one limit per manipulator joint is needed");
  EXPECT_EQ(message([](DeviceModel& d) { d.actuators.resize(5); }),
            "device: one actuator per manipulator joint is needed, or none");
  EXPECT_EQ(message([](DeviceModel& d) { d.rate_Hz = 20000.0, d.drive.dead_time = 0.02; }),
            "drive.dead_time_s: at most 255 periods, got 0.02 s at 20000 Hz");
}

// the law's limits: motors count only where it knows their torques
TEST(DeviceModel, CountsMotorsAsLimitsWhereTheLawKnowsThem) {
  DeviceModel device = haptic_giant();
  device.actuators.resize(6);
  EXPECT_EQ(device.limit_count(), 6);
  EXPECT_TRUE(device.motors().empty());
  device.has_torque_limits = true;
  EXPECT_EQ(device.limit_count(), 12);
  EXPECT_EQ(device.motors().data(), device.actuators.data());
}

TEST(HandleLimits, AreTheTighterOnesOfTheHandleAndOfNothingElse) {
  DeviceModel device = haptic_giant();
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
}  // namespace hg
