/// Description of script.yaml.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "hg/config/range.h"
#include "hg/user/person.h"

namespace hg::config {

/// Something that segments move.
struct Channel {
  std::string key;
  int index = 0;
  Range range;
  std::string text;
};

/// The channels that every script has: wrench and grip.
std::vector<Channel> common_channels();
/// Pose channels of `frame`; those of kTwinJoints are the joints of a twin, not listed here.
std::vector<Channel> pose_channels(user::ScriptFrame frame);

/// What stands in script.yaml, before it becomes a Script.
struct ScriptDraft {
  user::ScriptFrame frame = user::ScriptFrame::kBase;
  user::HandImpedance hand;
  std::vector<Channel> channels;  ///< those of the frame, then wrench and grip
  std::array<double, user::kChannels> start{};
  std::array<bool, user::kChannels> start_given{};
  std::vector<user::Segment> segments;
  double duration_s = kNoDefault;
};

inline constexpr std::array<Choice<user::ScriptFrame>, 3> kScriptFrames = {
    {{"base", user::ScriptFrame::kBase},
     {"cylindrical", user::ScriptFrame::kCylindrical},
     {"twin_joints", user::ScriptFrame::kTwinJoints}}};

template <class V>
void describe(V& v, user::HandImpedance& hand) {
  v.vector("stiffness_N_per_m", hand.stiffness, kNotNegative, "along x, y, z of B");
  v.vector("damping_Ns_per_m", hand.damping, kNotNegative, "along x, y, z of B");
  v.vector("angular_stiffness_Nm_per_rad", hand.angular_stiffness, kNotNegative,
           "about x, y, z of H");
  v.vector("angular_damping_Nms_per_rad", hand.angular_damping, kNotNegative, "about x, y, z of H");
  v.number("force_max_N", hand.force_max, kPositive, "the hand pulls no harder");
  v.number("torque_max_Nm", hand.torque_max, kPositive, "the hand turns no harder");
  v.number("press_force_N", hand.press_force, kNotNegative, "of a mouse that presses the lever");
}

template <class V>
void describe_frame(V& v, ScriptDraft& d) {
  v.choice("frame", d.frame, kScriptFrames, "what the pose channels mean");
  v.group(
      "hand", [&](auto& child) { describe(child, d.hand); }, "impedance of the hand");
}

/// Gives the channels in this map to take(channel index, value).
template <class V, class Take>
void describe_channels(V& v, const ScriptDraft& d, Take take) {
  for (const Channel& channel : d.channels) {
    double value = kNoDefault;
    if (v.number(channel.key, value, channel.range, channel.text)) take(channel.index, value);
  }
}

template <class V>
void describe_segment(V& v, ScriptDraft& d) {
  user::Segment segment;
  int count = 0;
  const auto add = [&](user::Blend blend) {
    return [&, blend](int channel, double value) {
      segment.channel = channel;
      segment.blend = blend;
      segment.value = value;
      d.segments.push_back(segment);
      ++count;
    };
  };
  v.number("start_s", segment.start_s, kNotNegative, "when the ramp begins", Need::kRequired);
  v.number("duration_s", segment.duration_s, kPositive, "of the minimum-jerk ramp",
           Need::kRequired);
  describe_channels(v, d, add(user::Blend::kTo));
  v.group(
      "by", [&](auto& child) { describe_channels(child, d, add(user::Blend::kBy)); },
      "channels and what is added to them");
  if (v.covers(d.frame == user::ScriptFrame::kBase)) {
    double turns = kNoDefault;
    const bool is_given = v.number("circle_turns", turns, kAnyNumber,
                                   "turns about the origin of B, walking tangentially");
    if (is_given) add(user::Blend::kCircle)(0, turns);
  }
  v.rule(count > 0, "", "a segment needs at least one channel");
}

template <class V>
void describe_segments(V& v, ScriptDraft& d) {
  v.group(
      "start",
      [&](auto& child) {
        describe_channels(child, d, [&](int channel, double value) {
          d.start[static_cast<std::size_t>(channel)] = value;
          d.start_given[static_cast<std::size_t>(channel)] = true;
        });
      },
      "pose channels that are not given start at the start pose of the twin");
  v.list(
      "segments", [&](auto& child) { describe_segment(child, d); },
      "ramps, which may overlap; later ones act on what earlier ones have made");
  v.number("duration_s", d.duration_s, kPositive,
           "length of the script; without it, until the last ramp ends");
}

}  // namespace hg::config
