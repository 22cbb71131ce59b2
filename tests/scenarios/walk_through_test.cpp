/// The door task of section VII-D: a person opens the door, walks through it and lets it fall shut.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/scenarios/trace.h"

namespace hg {
namespace {

using Eigen::Vector2d;

// models/twins/door: placement and shapes of the URDF, as the eye sees them; x along the shut leaf
const Vector2d kHingePlace(-0.30, -0.20);            // in B
constexpr double kLeafFrom = 0.01, kLeafTo = 0.92;   // m, along the leaf
constexpr double kLeafHalf = 0.02;                   // m, of its thickness
constexpr double kOpenFrom = -0.01, kOpenTo = 0.93;  // m, between the posts
constexpr double kFrameHalf = 0.07;                  // m, of the depth of the posts
constexpr double kShoulder = 0.25;                   // m, half of the breadth of a person
constexpr double kRightShoulder = 0.15;              // m, from the middle, of the hand that holds

struct Moment {
  double time_s = 0.0;
  Vector2d body;  // from the hinge
  double hinge = 0.0, lever = 0.0, hold = 0.0;
  Vector2d hand;       // of the twin, from the hinge
  double reach = 0.0;  // from the shoulder to the handle, m
};

double leaf_distance(const Moment& now) {
  const Vector2d leaf(std::cos(now.hinge), std::sin(now.hinge));
  return (now.body - leaf * std::clamp(leaf.dot(now.body), kLeafFrom, kLeafTo)).norm() - kLeafHalf;
}

double frame_distance(const Moment& now) {
  const double deep = std::max(0.0, std::abs(now.body.y()) - kFrameHalf);
  const double aside = std::max(0.0, std::min(now.body.x() - kOpenFrom, kOpenTo - now.body.x()));
  return std::hypot(deep, aside);
}

// The scenario in truth, from the grasp on.
class WalkThrough {
 public:
  explicit WalkThrough(const config::Scenario& scenario) : run_(scenario) {
    const double grasp_s = scenario.script.script.grasp_s;
    run_.play([&](const Sample& sample) {
      const WalkerReport& walker = sample.truth.walker;
      ASSERT_EQ(walker.is_walking, sample.record.time_s >= grasp_s) << sample.record.time_s;
      if (sample.record.time_s < grasp_s + 0.01) return;
      const Pose& handle = sample.truth.T_B_H;
      const Vector2d body(walker.x, walker.y);
      const Vector2d to_the_left(-std::sin(walker.heading), std::cos(walker.heading));
      const Vector2d to_person = handle.R.col(2).head<2>();
      Moment now{.time_s = sample.record.time_s, .body = body - kHingePlace};
      now.hinge = std::atan2(to_person.x(), -to_person.y());
      now.lever = sample.record.twin.q_a[1];
      now.hold = walker.hold;
      now.hand = handle.p.head<2>() - kHingePlace;
      now.reach = (handle.p.head<2>() - body + kRightShoulder * to_the_left).norm();
      moments_.push_back(now);
    });
  }

  const ScenarioRun& run() const { return run_; }
  const std::vector<Moment>& moments() const { return moments_; }
  const Moment& last() const { return moments_.back(); }

  template <typename Distance>
  double nearest(Distance distance) const {
    double nearest = kInfinity;
    for (const Moment& now : moments_) nearest = std::min(nearest, distance(now));
    return nearest;
  }

 private:
  ScenarioRun run_;
  std::vector<Moment> moments_;
};

void expect_passed(const WalkThrough& walk) {
  // before the door, then past it: more than half a breadth from leaf and frame
  EXPECT_LT(walk.moments().front().body.y(), -kShoulder);
  EXPECT_GT(walk.last().body.y(), kShoulder);
  EXPECT_GT(leaf_distance(walk.last()), kShoulder);
  EXPECT_GT(frame_distance(walk.last()), kShoulder);
  // through the opening, never through leaf or frame, nor is the body hit by the falling leaf
  EXPECT_GT(walk.nearest(leaf_distance), kShoulder);
  EXPECT_GT(walk.nearest(frame_distance), kShoulder);
}

TEST(WalkThrough, TheBodyGoesThroughTheOpeningWithoutTouchingLeafOrFrame) {
  const WalkThrough walk(shipped("walk_through"));
  expect_passed(walk);
  expect_sound(walk.run());
}

TEST(WalkThrough, TheHandHoldsTheHandleUntilTheLeafCannotFallOntoTheBody) {
  const WalkThrough walk(shipped("walk_through"));
  double let_go_s = -1.0, widest = 0.0;
  for (const Moment& now : walk.moments()) {
    widest = std::max(widest, now.hinge);
    if (now.hold == 1.0) {
      // the arm reaches that far
      ASSERT_LT(now.reach, 0.75) << now.time_s;
      continue;
    }
    if (let_go_s < 0.0) let_go_s = now.time_s;
    ASSERT_GT(now.body.y(), 0.0) << now.time_s;
    ASSERT_GT(now.body.norm(), kLeafTo + kShoulder) << now.time_s;
  }
  EXPECT_GT(let_go_s, walk.run().time_of("wide enough"));
  EXPECT_LT(let_go_s, walk.run().time_of("shut again"));
  EXPECT_LT(widest, 1.75 - 0.1);  // no wider than needed: the stop of the leaf is not met
}

TEST(WalkThrough, ALockedDoorIsNotWalkedThrough) {
  config::Scenario scenario = shipped("walk_through");
  std::erase_if(scenario.script.script.segments, [](const person::Segment& segment) {
    return segment.channel == 1 || segment.channel == person::kWrenchChannel;  // lever, fx
  });
  const WalkThrough walk(scenario);
  EXPECT_LT(walk.last().hinge, 1e-3);
  EXPECT_LT(walk.last().body.y(), -kShoulder);
  EXPECT_EQ(walk.last().hold, 1.0);
  EXPECT_GT(walk.nearest(leaf_distance), kShoulder);
}

struct Person {
  person::HandPreset hand;
  double speed;  // m/s
};

class WalkThroughBy : public ::testing::TestWithParam<Person> {};

INSTANTIATE_TEST_SUITE_P(People, WalkThroughBy,
                         ::testing::Values(Person{person::HandPreset::kRelaxed, 0.6},
                                           Person{person::HandPreset::kNormal, 0.4},
                                           Person{person::HandPreset::kNormal, 1.0},
                                           Person{person::HandPreset::kStiff, 0.6}));

TEST_P(WalkThroughBy, TheyPassTheDoorAndItFallsShut) {
  config::Scenario scenario = shipped("walk_through");
  scenario.script.hand = person::hand(GetParam().hand);
  scenario.script.script.walk.speed = GetParam().speed;
  const WalkThrough walk(scenario);
  expect_passed(walk);
  expect_sound(walk.run());
}

}  // namespace
}  // namespace hg
