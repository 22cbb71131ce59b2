/// Devices for the tests of this module.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

#include "hg/controller/safety/collision/guard.h"
#include "hg/model/urdf.h"

namespace hg::collision {

struct TestDevice {
  model::ChainModel chain;
  CollisionConfig config;
  Braking braking;
  std::vector<std::string> links_without;
  std::vector<Interval> range;
};

inline std::string haptic_giant_urdf() {
  std::ifstream stream("models/haptic_giant/haptic_giant.urdf");
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "" : text.replace(at, from.size(), to);
}

/// A HapticGiant with a thicker first link, onto which the second joint can fold the others.
inline std::string folding_urdf() {
  std::string text = replaced(haptic_giant_urdf(), R"(lower="0.20" upper="2.75" velocity="2.0")",
                              R"(lower="-3.10" upper="3.10" velocity="2.0")");
  for (int i = 0; i < 3; ++i) text = replaced(text, R"(radius="0.07")", R"(radius="0.12")");
  return text;
}

inline TestDevice device_of(const std::string& urdf_text) {
  TestDevice device = {.chain = model::ChainModel::from_urdf_text(urdf_text, "test.urdf"),
                       .config = {},
                       .braking = {},
                       .links_without = {},
                       .range = {}};
  const Geometry geometry =
      read_geometry(model::read_urdf_text(urdf_text, "test.urdf"), device.chain);
  device.config.shapes = geometry.shapes;
  device.links_without = geometry.links_without;
  device.config.shapes.push_back(floor_at(-2.15));
  for (const model::Joint& joint : device.chain.joints()) {
    device.range.push_back(joint.position);
  }
  device.braking.reaction.resize(8);
  device.braking.reaction << 0.046, 0.046, 0.013, 0.013, 0.013, 0.013, 0.013, 0.013;
  device.braking.deceleration.resize(8);
  device.braking.deceleration << 2.0, 2.0, 6.5, 7.5, 15.0, 8.0, 40.0, 40.0;
  device.braking.separate = 2;
  device.config.pairs = choose_pairs(device.config.shapes, device.chain, device.range,
                                     device.config.safe_distance + kFarEnough);
  return device;
}

}  // namespace hg::collision
