#include "hg/config/simulation/script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "hg/config/file_kind.h"
#include "hg/config/loader.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/core/error.h"

namespace hg::config {
namespace {

constexpr std::array<std::string_view, 5> kReserved = {"start_s", "duration_s", "by",
                                                       "circle_turns", "grip"};

// Adds one channel per joint, or says why the twin has none.
void add_twin_channels(Loader& loader, const rendering::TwinModel& twin, ScriptDraft& draft) {
  const bool is_possible = twin.chain.nq() <= person::kPoseChannels &&
                           std::ranges::all_of(twin.chain.joints(), [](const model::Joint& joint) {
                             return joint.type != model::JointType::kFloating;
                           });
  loader.rule(is_possible, "frame",
              "twin_joints needs a twin with at most 8 joints, none of them floating");
  if (!is_possible) return;
  for (const model::Joint& joint : twin.chain.joints()) {
    loader.rule(std::ranges::find(kReserved, joint.name) == kReserved.end(), "frame",
                "twin_joints needs joints that are not named like a key of a segment",
                "'" + joint.name + "'");
    draft.channels.push_back({joint.name, joint.q_index, kJointPosition, ""});
  }
}

// Where the doorway of a walk is in B.
void place_doorway(Loader& loader, const rendering::TwinModel& twin, ScriptDraft& draft) {
  if (draft.walk.kind != person::WalkKind::kDoorway || draft.walk.doorway.joint < 0) return;
  draft.hinge_channel = twin.chain.joints()[draft.walk.doorway.joint].q_index;
  std::string fault;
  try {
    person::place(draft.walk.doorway, twin.chain, twin.end_effector);
  } catch (const SetupError& error) {
    fault = error.what();
  }
  loader.rule(fault.empty(), "walk", "a doorway " + fault);
}

}  // namespace

std::vector<Channel> common_channels() {
  constexpr int kFirst = person::kWrenchChannel;
  return {{"fx_N", kFirst + 0, kAnyNumber, "push along x of the handle"},
          {"fy_N", kFirst + 1, kAnyNumber, "push along y of the handle"},
          {"fz_N", kFirst + 2, kAnyNumber, "push along z of the handle"},
          {"nx_Nm", kFirst + 3, kAnyNumber, "turn about x of the handle"},
          {"ny_Nm", kFirst + 4, kAnyNumber, "turn about y of the handle"},
          {"nz_Nm", kFirst + 5, kAnyNumber, "turn about z of the handle"},
          {"grip",
           person::kGripChannel,
           {.lb = 0.0, .ub = 1.0},
           "how much of its impedance the hand uses to reach the pose; 1 at the start"}};
}

std::vector<Channel> pose_channels(person::ScriptFrame frame) {
  switch (frame) {
    case person::ScriptFrame::kBase:
      return {{"x_m", 0, kAnyNumber, "handle in B"},
              {"y_m", 1, kAnyNumber, "handle in B"},
              {"z_m", 2, kAnyNumber, "handle in B"},
              {"azimuth_rad", 3, kAnyNumber, "heading of the hand axis about z of B"},
              {"pitch_rad", 4, kAnyNumber, "0 = hand axis down, pi = up"},
              {"roll_rad", 5, kAnyNumber, "about the hand axis"}};
    case person::ScriptFrame::kCylindrical:
      return {{"swing_rad", 0, kAnyNumber, "about z of the twin's root link"},
              {"r_m", 1, kAnyNumber, "distance from that axis"},
              {"z_m", 2, kAnyNumber, "along that axis"}};
    case person::ScriptFrame::kTwinJoints:
      return {};
  }
  return {};
}

Script load_script(const std::filesystem::path& file, const rendering::TwinModel& twin) {
  SourceReader reader;
  return load_script(file, twin, reader);
}

Script load_script(const std::filesystem::path& path, const rendering::TwinModel& twin,
                   SourceReader& reader) {
  const std::size_t first_source = reader.texts().size();
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  ScriptDraft draft;
  draft.start[person::kGripChannel] = 1.0;
  for (const model::Joint& joint : twin.chain.joints()) draft.joints.push_back(joint.name);
  load_file_of_kind(FileKind::kScript, file, [&](Loader& loader) {
    describe_frame(loader, draft);
    place_doorway(loader, twin, draft);
    draft.channels = pose_channels(draft.frame);
    if (draft.frame == person::ScriptFrame::kTwinJoints) add_twin_channels(loader, twin, draft);
    for (const Channel& channel : common_channels()) draft.channels.push_back(channel);
    describe_segments(loader, draft);
  });

  Script script;
  script.hand = draft.hand;
  script.script.grasp_s = draft.grasp_s;
  script.script.frame = draft.frame;
  script.script.start = draft.start;
  script.script.segments = std::move(draft.segments);
  std::ranges::stable_sort(script.script.segments, {}, &person::Segment::start_s);
  for (const person::Segment& segment : script.script.segments) {
    script.script.duration_s =
        std::max(script.script.duration_s, segment.start_s + segment.duration_s);
  }
  script.script.walk = std::move(draft.walk);
  if (!std::isnan(draft.duration_s)) script.script.duration_s = draft.duration_s;
  std::copy_n(draft.start_given.begin(), script.start_given.size(), script.start_given.begin());
  script.sources = reader.since(first_source);
  return script;
}

}  // namespace hg::config
