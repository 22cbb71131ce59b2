// What a hand measures on a virtual surface of the simulated device, and what ends the workspace.

#include "hg/experiments/haptify/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/free_space.h"
#include "hg/experiments/haptify/shape.h"

namespace hg::haptify {
namespace {

using experiments::DecayClass;

const config::Scenario& walk() {
  static const config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  return scenario;
}

TEST(Press, FindsTheStiffnessOfThePlane) {
  SurfaceConfig config;
  config.press_s = 2.0;
  for (const double stiffness : {1000.0, 4000.0}) {
    const Press press = measure_press(walk(), config, stiffness, 1);
    EXPECT_EQ(press.failure, "");
    EXPECT_NEAR(press.accuracy, 100.0, 5.0) << stiffness;
    EXPECT_NEAR(press.twin_accuracy, 100.0, 5.0) << stiffness;
    EXPECT_NEAR(press.force, config.press_force, 2.0);
  }
}

// The mean of norms is at most the sum of theirs; without friction nothing else acts on the body.
TEST(Slide, IsTheBodysOwnForce) {
  SurfaceConfig config;
  config.strokes = 2;
  const Slide slide = measure_slide(walk(), config, 1);
  EXPECT_EQ(slide.failure, "");
  EXPECT_NEAR(slide.normal, config.slide_force, 0.5);
  EXPECT_NEAR(slide.speed, config.stroke / config.stroke_s, 0.04);
  EXPECT_NEAR(slide.viscous, 4.0 * slide.speed, 1e-9);
  EXPECT_GT(slide.inertial, slide.viscous);
  EXPECT_LT(slide.own_share, slide.inertial + slide.viscous);
  EXPECT_NEAR(slide.force, slide.own_share, 0.15);
  EXPECT_LT(slide.extra, 0.4);
  EXPECT_GT(slide.extra, std::abs(slide.force - slide.own_share));

  config.clearance = 0.2;
  config.slide_force = 0.0;
  SurfaceConfig far = config;
  far.position.z() -= 0.3;  // the hand starts as far above, and aims no lower
  far.clearance = 0.5;
  config::Scenario soft = walk();
  soft.script.hand.stiffness.z() = 1.0;  // too weak to reach it
  EXPECT_EQ(measure_slide(soft, far, 1).failure, "the hand did not touch the surface");
}

TEST(Knock, CalmsDownOnAMildSurfaceAndNotOnAStiffOneUnderALightBody) {
  const SurfaceConfig config;
  EXPECT_EQ(knock(walk(), config, 1000.0, 20.0).verdict, DecayClass::kStable);
  config::Scenario light = walk();
  experiments::set_free_twin(light, {.mass = 2.0, .damping = 2.0});
  EXPECT_NE(knock(light, config, 50'000.0, 0.0).verdict, DecayClass::kStable);
}

TEST(FreeSpace, IsTheSameWithTheSameSeedOnly) {
  FreeSpaceConfig config;
  config.duration_s = 5.0;
  const FreeSpace one = measure_free_space(walk(), config, 3);
  EXPECT_EQ(one.failure, "");
  EXPECT_EQ(one.force, measure_free_space(walk(), config, 3).force);
  EXPECT_NE(one.force, measure_free_space(walk(), config, 4).force);
  // the body's own force and what the device adds make the force, in every sample
  EXPECT_LT(one.force, one.own_share + one.extra + 0.02);
  EXPECT_GT(one.force, one.own_share - one.extra - 0.02);
  EXPECT_LT(one.extra, 0.4);
  // the instrument's noise adds in quadrature: three axes of 1e-3 m/s^2/sqrt(Hz)
  EXPECT_NEAR(std::hypot(one.vibration_rms, 1e-3 * std::sqrt(1000.0 * 3.0 * 0.96)), one.seen_rms,
              0.003);
  EXPECT_GT(one.seen_centroid_Hz, one.centroid_Hz);
}

TEST(Exploration, GoesAnotherWayWithAnotherSeed) {
  const FreeSpaceConfig config;
  const auto way = [&](std::uint64_t seed) {
    return exploration(config, {.p = {0.0, 0.0, -0.8}}, seed).segments;
  };
  const auto one = way(3), same = way(3), other = way(4);
  ASSERT_GT(one.size(), 16u);
  for (std::size_t i = 0; i < one.size(); ++i) ASSERT_EQ(one[i].value, same[i].value);
  EXPECT_NE(one[0].value, other[0].value);
  for (const person::Segment& segment : one) {
    if (segment.channel > 2) continue;
    EXPECT_GE(segment.value, config.lower[segment.channel]);
    EXPECT_LE(segment.value, config.upper[segment.channel]);
  }
}

// The highest posture has m4 and q4+q5 at their limits; m1 to m3 turn about vertical axes.
TEST(UnreachedSides, NamesTheLimitsThatEndTheWay) {
  const ShapeConfig config;  // many: the highest of few has other joints in the middle by chance
  const workspace::HandleWorkspace shape = measure_shape(walk().device, config, 1);
  EXPECT_LT(shape.volume, shape.box_volume);
  EXPECT_GT(shape.volume, 0.97 * shape.box_volume);
  const std::vector<UnreachedSide> sides = unreached_sides(walk().device, shape, config, 1);
  ASSERT_EQ(sides.size(), 1u);
  EXPECT_EQ(sides[0].axis, 2);
  EXPECT_NEAR(sides[0].limit, -0.3, 1e-9);
  EXPECT_GT(sides[0].short_by, 2e-3);
  ASSERT_EQ(sides[0].at_limit.size(), 2u);
  EXPECT_EQ(sides[0].at_limit[0].first, "m4");
  EXPECT_NEAR(sides[0].at_limit[0].second, 2.45, 0.005);
  EXPECT_EQ(sides[0].at_limit[1].first, "q4+q5");
  EXPECT_NEAR(sides[0].at_limit[1].second, 2.88, 0.005);
}

}  // namespace
}  // namespace hg::haptify
