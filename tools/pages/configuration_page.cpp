#include "tools/pages/configuration_page.h"

#include "hg/config/device_schema.h"
#include "hg/config/simulation/scenario_schema.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/config/simulation/simulation_schema.h"
#include "hg/config/tool_schema.h"
#include "hg/config/twin_schema.h"
#include "tools/pages/doc_writer.h"

namespace hg::pages {
namespace {

using namespace config;

constexpr const char* kIntroduction = R"(# Configuration files

<!-- Generated from the descriptions in hg/config: edit those. -->

Six kinds of YAML files set up a run. `models/` has complete examples.

- A key ends in its unit: `q_max_rad`, `stiffness_N_per_m`, `k_ppu_1_per_s`. Values are plain
  numbers in that unit; `15 deg` is refused. Where the unit depends on the joint, revolute joints
  take the key with rad and prismatic joints the key with m.
- Every number has a range: that of its unit, or a narrower one. The tables give it.
- `.inf` stands for "no limit" where the table says that it may.
- Unknown keys, keys given twice and everything outside the allowed values are errors. All errors
  of a file are reported at once, as `file:line:column: key: what is wrong`.
- Names of files start at the folder of the file that names them.
- In the tables, `a.b` is key `b` in the map `a`, `a[].b` is key `b` of each element of the list
  `a`, and `NAME` is the name of a joint.
)";

std::string device_table() {
  DeviceDraft draft;
  draft.joints.emplace_back();  // stands for every joint
  draft.actuators.emplace_back();
  DocWriter writer;
  describe_chain(writer, draft);
  describe(writer, draft.part, {});
  describe_tool(writer, draft);
  describe_structure(writer, draft);
  describe_limits(writer, draft);
  describe_behaviour(writer, draft);
  describe_control(writer, draft);
  return writer.table();
}

std::string tool_table() {
  Tool tool;
  DocWriter writer;
  describe(writer, tool);
  return writer.table();
}

std::string simulation_table() {
  SimulationDraft draft;
  draft.joint_units.push_back(JointUnit::kEither);  // stands for every joint
  draft.flexible.emplace_back();
  DocWriter writer;
  describe_base(writer, draft);
  describe_plant(writer, draft);
  describe_rest(writer, draft, {"NAME"}, {"NAME"});
  return writer.table();
}

std::string twin_table() {
  TwinDraft draft;
  draft.joints.emplace_back();  // stands for every joint
  draft.scalar_joints.push_back(0);
  DocWriter writer;
  describe_chain(writer, draft);
  describe(writer, draft.part, {});
  describe_joints(writer, draft);
  return writer.table();
}

std::string script_table() {
  ScriptDraft draft;
  draft.channels = {{"CHANNEL", 0, kJointPosition, "one of the channels below"}};
  DocWriter writer;
  describe_frame(writer, draft);
  describe_segments(writer, draft);
  return writer.table();
}

std::string channel_table(const std::vector<Channel>& channels) {
  ScriptDraft draft;
  draft.channels = channels;
  DocWriter writer;
  describe_channels(writer, draft, [](int, double) {});
  return writer.table();
}

std::string scenario_table() {
  ScenarioDraft draft;
  draft.names.twin_limits.push_back(0);
  DocWriter writer;
  describe_parts(writer, draft);
  describe_events(writer, draft);
  ChangesDraft changes;
  changes.joints.emplace_back();  // stands for every joint
  describe_changes(writer, changes);
  std::vector<TimedPanel> panel;
  describe_panel(writer, panel);
  InjectionsDraft injections = injections_of({}, {});
  describe_injections(writer, injections);
  std::vector<SurfaceDraft> surfaces;
  describe_surfaces(writer, surfaces);
  BystanderDraft bystander;
  describe_bystander(writer, bystander);
  return writer.table();
}

}  // namespace

std::string configuration_page() {
  std::string page = kIntroduction;
  const auto section = [&](const std::string& title, const std::string& text) {
    page += "\n" + title + "\n\n" + text;
  };
  section("## Device: device.yaml", device_table());
  section("## Tool of a device: tool.yaml", tool_table());
  section("## Simulated device: simulation.yaml", simulation_table());
  section("## Twin: twin.yaml", twin_table());
  section("## Script of a hand: script.yaml", script_table());
  section("### Channels of frame base", channel_table(pose_channels(person::ScriptFrame::kBase)));
  section("### Channels of frame cylindrical",
          channel_table(pose_channels(person::ScriptFrame::kCylindrical)));
  section("### Channels of frame twin_joints",
          "The names of the twin's joints; values in rad or m.\n");
  section("### Channels of every frame", channel_table(common_channels()));
  section("## Scenario: scenario.yaml", scenario_table());
  return page;
}

}  // namespace hg::pages
