#include "tools/pages/configuration_facts.h"

#include <nlohmann/json.hpp>

#include "hg/config/bus/machine_schema.h"
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

using Json = nlohmann::ordered_json;

Json device_table() {
  DeviceDraft draft;
  draft.joints.emplace_back();  // stands for every joint
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

Json tool_table() {
  Tool tool;
  DocWriter writer;
  describe(writer, tool);
  return writer.table();
}

Json simulation_table() {
  SimulationDraft draft;
  draft.joint_units.push_back(JointUnit::kEither);  // stands for every joint
  draft.flexible.emplace_back();
  DocWriter writer;
  describe_base(writer, draft);
  describe_plant(writer, draft);
  describe_rest(writer, draft, {"NAME"}, {"NAME"});
  return writer.table();
}

Json twin_table() {
  TwinDraft draft;
  draft.joints.emplace_back();  // stands for every joint
  draft.scalar_joints.push_back(0);
  DocWriter writer;
  describe_chain(writer, draft);
  describe(writer, draft.part, {});
  describe_followers(writer, draft, {});
  describe_joints(writer, draft);
  return writer.table();
}

Json machine_table() {
  ethercat::Machine machine;
  DocWriter writer;
  describe(writer, machine, {});
  return writer.table();
}

Json script_table() {
  ScriptDraft draft;
  draft.channels = {{"CHANNEL", 0, kJointPosition, "one of the channels below"}};
  DocWriter writer;
  describe_frame(writer, draft);
  describe_segments(writer, draft);
  return writer.table();
}

Json channel_table(const std::vector<Channel>& channels) {
  ScriptDraft draft;
  draft.channels = channels;
  DocWriter writer;
  describe_channels(writer, draft, [](int, double) {});
  return writer.table();
}

Json scenario_table() {
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
  TeleoperationDraft teleoperation;
  describe_teleoperation(writer, teleoperation, {});
  return writer.table();
}

}  // namespace

Json configuration_facts() {
  return {{"device", device_table()},
          {"tool", tool_table()},
          {"simulation", simulation_table()},
          {"twin", twin_table()},
          {"script", script_table()},
          {"channels_base", channel_table(pose_channels(person::ScriptFrame::kBase))},
          {"channels_cylindrical", channel_table(pose_channels(person::ScriptFrame::kCylindrical))},
          {"channels", channel_table(common_channels())},
          {"scenario", scenario_table()},
          {"machine", machine_table()}};
}

}  // namespace hg::pages
