/// Description of script.yaml.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/simulation/hand_schema.h"
#include "hg/config/simulation/walk_schema.h"
#include "hg/simulator/person/person.h"

namespace hg::config {

/// A signal that segments move.
struct Channel {
  std::string key;
  int index = 0;
  Range range;
  std::string text;
};

/// The channels that every script has: wrench and grip.
std::vector<Channel> common_channels();
/// Pose channels of `frame`; those of kTwinJoints are the joints of a twin, not listed here.
std::vector<Channel> pose_channels(person::ScriptFrame frame);

/// Content of script.yaml, before it becomes a Script.
struct ScriptDraft {
  person::ScriptFrame frame = person::ScriptFrame::kBase;
  person::HandImpedance hand;
  double grasp_s = person::Script{}.grasp_s;
  person::Walk walk;
  std::vector<Channel> channels;  ///< channels of the frame, then wrench and grip
  std::array<double, person::kChannels> start{};
  std::array<bool, person::kChannels> start_given{};
  std::vector<person::Segment> segments;
  std::vector<std::string> joints;  ///< names of the joints of the twin
  int hinge_channel = -1;           ///< channel of the hinge of a doorway
  double duration_s = kNoDefault;
};

inline constexpr auto kScriptFrames = choices_of<person::ScriptFrame>();

template <class V>
void describe_frame(V& v, ScriptDraft& d) {
  v.choice("frame", d.frame, kScriptFrames, "what the pose channels mean");
  v.group(
      "hand", [&](auto& child) { describe(child, d.hand); }, "impedance of arm and grip");
  v.number(
      "grasp_s", d.grasp_s, kNotNegative,
      "when the hand takes the handle and closes the dead-man switch; sensors are tared before. "
      "The times below count from here");
  v.group(
      "walk", [&](auto& child) { describe(child, d.walk, d.joints); },
      "a walking person: moves x_m, y_m and azimuth_rad of the hand, frame base; or, at a doorway, "
      "its hinge");
  const bool is_at_a_door = d.walk.kind == person::WalkKind::kDoorway;
  const auto frame = is_at_a_door ? person::ScriptFrame::kTwinJoints : person::ScriptFrame::kBase;
  v.rule(d.walk.kind == person::WalkKind::kNone || d.frame == frame, "walk",
         is_at_a_door ? "a doorway needs frame twin_joints" : "a walk needs frame base");
}

/// Calls take(channel index, value) for each channel in this map.
template <class V, class Take>
void describe_channels(V& v, const ScriptDraft& d, Take take) {
  for (const Channel& channel : d.channels) {
    double value = kNoDefault;
    if (v.number(channel.key, value, channel.range, channel.text)) take(channel.index, value);
  }
}

template <class V>
void describe_segment(V& v, ScriptDraft& d) {
  person::Segment segment;
  int count = 0;
  const auto add = [&](person::Blend blend) {
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
  describe_channels(v, d, add(person::Blend::kTo));
  v.group(
      "by", [&](auto& child) { describe_channels(child, d, add(person::Blend::kBy)); },
      "channels and what is added to them");
  if (v.covers(d.frame == person::ScriptFrame::kBase)) {
    double turns = kNoDefault;
    const bool is_given = v.number("circle_turns", turns, {.lb = -1e3, .ub = 1e3},
                                   "turns about the origin of B, walking tangentially");
    if (is_given) add(person::Blend::kCircle)(0, turns);
  }
  v.rule(count > 0, "", "a segment needs at least one channel");
}

template <class V>
void describe_segments(V& v, ScriptDraft& d) {
  v.group(
      "start",
      [&](auto& child) {
        describe_channels(child, d, [&](int channel, double value) {
          d.start[channel] = value;
          d.start_given[channel] = true;
        });
      },
      "pose channels that are not given start at the start pose of the twin");
  v.list(
      "segments", [&](auto& child) { describe_segment(child, d); },
      "ramps, which may overlap; later ones act on what earlier ones have made");
  v.number("duration_s", d.duration_s, kPositive,
           "length of the script; without it, until the last ramp ends");
  if (d.walk.kind == person::WalkKind::kNone) return;
  v.rule(!std::isnan(d.duration_s), "walk", "a walk needs duration_s");
  const bool is_at_a_door = d.walk.kind == person::WalkKind::kDoorway;
  for (const person::Segment& segment : d.segments) {
    const bool is_walked =
        is_at_a_door ? segment.channel == d.hinge_channel
                     : segment.channel == 0 || segment.channel == 1 || segment.channel == 3;
    v.rule(!is_walked, "segments",
           is_at_a_door
               ? "at a doorway, no segment moves the hinge"
               : "with a walk, no segment moves x_m, y_m or azimuth_rad, or has circle_turns");
  }
}

}  // namespace hg::config
