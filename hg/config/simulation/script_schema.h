/// Description of script.yaml.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hg/config/schema.h"
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

inline constexpr auto kHandPresets = choices_of<person::HandPreset>();

template <class V>
void describe(V& v, person::HandImpedance& hand) {
  person::HandPreset preset = person::HandPreset::kNormal;
  const bool is_given =
      v.choice("preset", preset, kHandPresets, "values of the keys below that are not given");
  if (is_given) hand = person::hand(preset);
  v.vector(
      "stiffness_N_per_m", hand.stiffness, kNotNegative,
      "of the arm, along fore-aft, left-right and vertical: x, y, z of B, turned by the heading "
      "in frame base");
  v.vector("damping_Ns_per_m", hand.damping, kNotNegative, "of the arm, along the same axes");
  v.vector("mass_kg", hand.mass, kPositive, "effective, of hand and arm, along the same axes");
  v.number("grip_stiffness_N_per_m", hand.grip_stiffness, kPositive,
           "between hand and handle, in series with the arm");
  v.number("grip_damping_Ns_per_m", hand.grip_damping, kNotNegative, "between hand and handle");
  v.vector("angular_stiffness_Nm_per_rad", hand.angular_stiffness, kNotNegative,
           "about x, y, z of H");
  v.vector("angular_damping_Nms_per_rad", hand.angular_damping, kNotNegative, "about x, y, z of H");
  v.number("force_max_N", hand.force_max, kPositive, "the arm pulls no harder");
  v.number("torque_max_Nm", hand.torque_max, kPositive, "the hand turns no harder");
  v.number("press_force_N", hand.press_force, kNotNegative,
           "of a mouse, down at the lever; plus as much as it pulls sideways");
  v.number("tremor_N", hand.tremor_rms, kNotNegative,
           "root mean square of the tremor of 8 to 12 Hz along each axis; 0 = none");
}

template <class V>
void describe(V& v, person::Doorway& doorway, const std::vector<std::string>& joints) {
  doorway.joint = -1;  // until the name is found
  v.name("hinge", doorway.joint, joints, "a joint of the twin",
         "vertical hinge of a leaf that opens away from the person as its angle grows; z of the "
         "handle stands at right angles on the leaf",
         Need::kRequired);
  v.number("leaf_width_m", doorway.leaf_width, kPositive, "from the hinge axis to its edge");
  v.number("clear_width_m", doorway.clear_width, kPositive,
           "from the hinge axis to the opposite side of the frame");
  v.number("start_s", doorway.start_s, kNotNegative, "when the person sets out");
  v.number("beyond_m", doorway.beyond, kPositive, "where the body stops, behind the shut leaf");
  v.rule(person::has_room(doorway), "clear_width_m", "wide enough for a person");
}

template <class V>
void describe(V& v, ScriptDraft& d) {
  person::Walk& walk = d.walk;
  const bool has_circle =
      v.number("circle_radius_m", walk.circle_radius, kPositive,
               "the hand goes round such a circle, counterclockwise; or checkpoints");
  const bool has_checkpoints = v.list(
      "checkpoints",
      [&](auto& child) {
        person::Checkpoint& checkpoint = walk.checkpoints.emplace_back();
        child.number("x_m", checkpoint.p.x(), kAnyNumber, "of the handle in B", Need::kRequired);
        child.number("y_m", checkpoint.p.y(), kAnyNumber, "of the handle in B", Need::kRequired);
        child.number("heading_rad", checkpoint.heading, kAnyNumber, "of the person",
                     Need::kRequired);
      },
      "the hand goes there in this order; reached nearer than 0.10 m and 15 degrees");
  const bool has_doorway = v.group(
      "doorway", [&](auto& child) { describe(child, walk.doorway, d.joints); },
      "the body goes through a doorway; the hand opens its leaf as far as the body needs, follows "
      "the arc of the handle, and lets go once the leaf cannot fall onto the body; frame "
      "twin_joints only");
  v.number("speed_m_per_s", walk.speed, kPositive, "of the hand on a circle, else of the body");
  v.number("azimuth_from_heading_rad", walk.azimuth_from_heading, kAnyNumber,
           "azimuth of the handle minus heading of the person who holds it");
  v.number("vertical_bob_m", walk.vertical_bob, kNotNegative,
           "of the hand, 1.8 Hz; from 0.6 m/s on, less when slower");
  v.number("lateral_bob_m", walk.lateral_bob, kNotNegative, "of the hand, 0.9 Hz; likewise");
  v.rule(has_circle + has_checkpoints + has_doorway == 1, "",
         "a walk needs one of circle_radius_m, checkpoints and doorway");
  v.rule(walk.checkpoints.size() <= person::kMaxCheckpoints, "checkpoints",
         "at most 16 checkpoints", std::to_string(walk.checkpoints.size()));
  if (has_circle) walk.kind = person::WalkKind::kCircle;
  if (has_checkpoints) walk.kind = person::WalkKind::kCheckpoints;
  if (has_doorway) walk.kind = person::WalkKind::kDoorway;
  v.rule(!has_circle || person::has_room(walk), "circle_radius_m",
         "so large that the body can walk inside the circle of its hand, at this speed");
}

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
      "walk", [&](auto& child) { describe(child, d); },
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
