// Where measurements are made with the reference device and with any other.

#include "hg/experiments/place.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/config/simulation/simulation.h"
#include "hg/core/error.h"
#include "hg/scenario/options.h"
#include "hg/scenario/start_posture.h"

namespace hg::experiments {
namespace {

TEST(Place, OfTheReferenceDeviceIsGivenAndHasRoomForAll) {
  const config::Scenario walk = scenario::load({.scenario = "walk"});
  const Place place = place_of(walk.device);
  EXPECT_FALSE(place.is_found);
  EXPECT_EQ(place.middle, Eigen::Vector3d(0.0, 0.0, -0.775));
  EXPECT_EQ(no_room(place, Eigen::Vector3d::UnitX(), 100.0), "");
  EXPECT_EQ(to_text(place), "");
  const config::Scenario same = at_place(walk, place);
  EXPECT_EQ(same.twin.model.q_start, walk.twin.model.q_start);
}

class PlaceOf : public testing::TestWithParam<const char*> {};

TEST_P(PlaceOf, AnArmIsABoxInWhichItCanHoldTheBody) {
  const config::Scenario walk = scenario::load({.scenario = "walk", .device = GetParam()});
  const Place place = place_of(walk.device);
  ASSERT_TRUE(place.is_found);
  config::Scenario held = at_place(walk, place);
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_upper = (corner >> axis & 1) == 1;
      held.twin.model.q_start[axis] = is_upper ? place.upper[axis] : place.lower[axis];
    }
    EXPECT_NO_THROW(scenario::find_start(held.device, held.twin)) << corner;
  }
  EXPECT_TRUE(scenario::handle_start(held.twin.model).R.isApprox(place.R_B_H, 1e-9));
  EXPECT_EQ(no_room(place, Eigen::Vector3d::UnitY(), 0.1), "");
  EXPECT_TRUE(no_room(place, Eigen::Vector3d::UnitY(), 1.5).starts_with(kNotPossible));
}

INSTANTIATE_TEST_SUITE_P(SixAndSevenJoints, PlaceOf,
                         testing::Values("models/examples/arm.yaml", "models/arms/ur5e/device.yaml",
                                         "models/arms/xarm7/device.yaml"));

}  // namespace
}  // namespace hg::experiments
