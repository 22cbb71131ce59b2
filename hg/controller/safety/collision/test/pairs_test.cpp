#include "hg/controller/safety/collision/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "hg/controller/safety/collision/test/devices.h"

namespace hg::collision {
namespace {

std::string name(const CollisionConfig& config, int a, int b) {
  return config.shapes[a].name + " - " + config.shapes[b].name;
}

TEST(Shapes, OfTheHapticGiantAreBoxesAndCapsules) {
  const TestDevice device = device_of(haptic_giant_urdf());
  std::vector<std::string> names;
  for (const Shape& shape : device.config.shapes) names.push_back(shape.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"column_1", "column_2", "column_3", "column_4", "rail_1",
                                      "rail_2", "beam_1", "beam_2", "bridge", "trolley", "link1",
                                      "link2", "drop_tube", "forearm", "hand", "floor"}));
  const Shape& tube = *std::ranges::find(device.config.shapes, "drop_tube", &Shape::name);
  EXPECT_FALSE(tube.is_box);
  EXPECT_EQ(tube.radius, 0.05);
  EXPECT_EQ(tube.half_length, 0.375);
  EXPECT_EQ(tube.body, 5);
  EXPECT_EQ(device.links_without, std::vector<std::string>{"m5"});
}

TEST(Shapes, ThatAreMeshesAreNamed) {
  const std::string text = replaced(
      haptic_giant_urdf(), R"(<cylinder radius="0.045" length="0.42"/></geometry></collision>)",
      R"(<mesh filename="forearm.stl"/></geometry></collision>)");
  EXPECT_EQ(device_of(text).links_without, (std::vector<std::string>{"m4", "m5"}));
}

TEST(Pairs, NothingTouchesTheFloorByDesign) {
  const TestDevice device = device_of(haptic_giant_urdf());
  for (const Excluded& pair : device.config.pairs.excluded) {
    if (device.config.shapes[pair.a].name != "floor" &&
        device.config.shapes[pair.b].name != "floor") {
      continue;
    }
    EXPECT_NE(pair.reason, Exclusion::kNeighbours) << name(device.config, pair.a, pair.b);
  }
}

TEST(Pairs, OfTheHapticGiantAreThoseThatCanTouch) {
  const TestDevice device = device_of(haptic_giant_urdf());
  const Pairs& pairs = device.config.pairs;
  std::set<std::string> watched;
  for (const Pair& pair : pairs.watched) watched.insert(name(device.config, pair.a, pair.b));
  std::set<std::string> expected = {"drop_tube - hand"};
  for (const std::string column : {"column_1", "column_2", "column_3", "column_4"}) {
    for (const std::string link : {"link2", "drop_tube", "forearm", "hand"}) {
      expected.insert(column + " - " + link);
    }
  }
  EXPECT_EQ(watched, expected);
  for (const Excluded& pair : pairs.excluded) {
    const std::string names = name(device.config, pair.a, pair.b);
    EXPECT_EQ(pair.reason == Exclusion::kAlways, names == "forearm - hand") << names;
    if (names == "trolley - link2") {
      EXPECT_NEAR(pair.distance, 0.09, 1e-3);
    }
  }
}

// Every pair that is left out as never touching stays out in a hundred times as many postures.
TEST(Pairs, ThatAreLeftOutStayApart) {
  for (const std::string& text : {haptic_giant_urdf(), folding_urdf()}) {
    const TestDevice device = device_of(text);
    const Pairs& pairs = device.config.pairs;
    std::vector<Distance> distances;
    for (const Excluded& pair : pairs.excluded) {
      distances.emplace_back(device.config.shapes[pair.a], device.config.shapes[pair.b]);
    }
    const unsigned seed = 21;
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    model::ChainData chain(device.chain);
    Eigen::VectorXd q(8);
    for (int n = 0; n < 50000; ++n) {
      for (int i = 0; i < 8; ++i) {
        const Interval range = intersect(device.range[i], {-std::numbers::pi, std::numbers::pi});
        // the ends of the ranges more often than the rest
        const double share = std::uniform_real_distribution<double>(-0.3, 1.3)(random);
        q[i] = range.lb + std::clamp(share, 0.0, 1.0) * (range.ub - range.lb);
      }
      chain.update_poses(q);
      const auto pose = [&](int shape) {
        const int frame = device.config.shapes[shape].frame;
        return frame < 0 ? Pose{} : chain.pose(frame);
      };
      for (std::size_t i = 0; i < distances.size(); ++i) {
        const Excluded& pair = pairs.excluded[i];
        if (pair.reason == Exclusion::kNeighbours) continue;
        const double distance = distances[i](pose(pair.a), pose(pair.b));
        if (pair.reason == Exclusion::kAlways) {
          ASSERT_LE(distance, 0.0) << name(device.config, pair.a, pair.b);
        } else {
          ASSERT_GT(distance, 0.03) << name(device.config, pair.a, pair.b);
        }
      }
    }
  }
}

}  // namespace
}  // namespace hg::collision
