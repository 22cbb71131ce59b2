/// A scripted hand: the intended motion as ramps of named channels over time. Time counts from the
/// grasp.
///
/// Pose channels give the desired pose of the handle, wrench channels the wrench exerted by the
/// hand. Every segment moves its channels along a minimum-jerk ramp from their present value to a
/// target; segments may overlap. Set-up data and pure functions of time.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "hg/core/types.h"
#include "hg/simulator/person/walker.h"

namespace hg::person {

/// Meaning of the pose channels.
enum class ScriptFrame {
  kBase,         ///< x y z azimuth pitch roll of the handle in B
  kCylindrical,  ///< swing r z about the twin's base axis
  kTwinJoints,   ///< coordinates of the twin's joints, in their order
};

/// Channel numbers: pose channels first, then the wrench in H, then the grip.
inline constexpr int kPoseChannels = 8;
inline constexpr int kWrenchChannel = kPoseChannels;    ///< fx fy fz nx ny nz in H
inline constexpr int kGripChannel = kPoseChannels + 6;  ///< 0 = released, 1 = held
inline constexpr int kChannels = kGripChannel + 1;

enum class Blend {
  kTo,      ///< ramps from the present value to `value`
  kBy,      ///< adds `value`
  kCircle,  ///< kBase only: walks `value` turns about the origin of B, tangentially
};

struct Segment {
  double start_s = 0.0;
  double duration_s = 1.0;  ///< > 0
  int channel = 0;
  Blend blend = Blend::kTo;
  double value = 0.0;
};

struct Script {
  double grasp_s = 0.7;  ///< time of the grasp; until then the handle's sensors can be tared
  ScriptFrame frame = ScriptFrame::kBase;
  std::array<double, kChannels> start{};  ///< values before the first segment
  std::vector<Segment> segments;          ///< segments ordered by start time
  double duration_s = 0.0;                ///< time at which the script ends
  /// Moves x, y and azimuth of kBase, or the hinge of a doorway of kTwinJoints; segments of these
  /// channels have no effect
  Walk walk;
};

/// Minimum-jerk ramp from 0 to 1 over [start, start + duration]; [HANDBOOK] 5.2.
double minimum_jerk(double t, double start, double duration) noexcept;

/// Values of all channels at time t.
std::array<double, kChannels> evaluate(const Script& script, double t) noexcept;

}  // namespace hg::person
