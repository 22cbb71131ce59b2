/// A scripted hand: what the person wants to do, as ramps of named channels over time. Time counts
/// from the grasp.
///
/// Pose channels say where the hand wants the handle to be, wrench channels what it pushes with.
/// Every segment moves its channels along a minimum-jerk ramp from what they were to a target;
/// segments may overlap. Set-up data and pure functions of time.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "hg/core/types.h"
#include "hg/user/walker.h"

namespace hg::user {

/// What the pose channels mean.
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
  double grasp_s = 0.7;  ///< the hand takes the handle; until then its sensors can be tared
  ScriptFrame frame = ScriptFrame::kBase;
  std::array<double, kChannels> start{};  ///< values before the first segment
  std::vector<Segment> segments;          ///< in the order of their start
  double duration_s = 0.0;                ///< after it the script has played
  Walk walk;  ///< kBase only: moves x, y and azimuth; the segments of these channels do nothing
};

/// Minimum-jerk ramp from 0 to 1 over [start, start + duration]; [HANDBOOK] 5.2.
double minimum_jerk(double t, double start, double duration) noexcept;

/// All channels at time t.
std::array<double, kChannels> evaluate(const Script& script, double t) noexcept;

}  // namespace hg::user
