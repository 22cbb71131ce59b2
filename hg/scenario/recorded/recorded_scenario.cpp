#include "hg/scenario/recorded/recorded_scenario.h"

#include <filesystem>
#include <memory>
#include <string_view>
#include <utility>

#include "hg/scenario/names.h"
#include "hg/scenario/recorded/robot_models.h"

namespace hg::scenario {
namespace {

constexpr char kArguments[] = "arguments";  // attachment that holds the options

// The name of what is felt, as that of a file: of the twin where it is not the scenario's own.
std::string recording_name(const ScenarioOptions& options, const config::Scenario& scenario) {
  constexpr std::string_view kMarks = "._-";
  std::string name = options.twin.empty() ? std::filesystem::path(options.scenario).stem().string()
                                          : scenario.twin.name;
  for (char& c : name) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (!is_plain && kMarks.find(c) == std::string_view::npos) c = '_';
  }
  return name;
}

}  // namespace

config::Scenario recorded_scenario(const std::vector<recording::NamedText>& configuration) {
  std::vector<config::SourceText> sources;
  std::string options;
  for (const recording::NamedText& text : configuration) {
    if (text.name == kArguments) {
      options = text.text;
    } else {
      sources.push_back({text.name, text.text});
    }
  }
  return load_recorded(std::move(sources), options);
}

messages::RunNames run_names(const config::Scenario& scenario) {
  messages::RunNames names{.gantry_joints = gantry_joints(scenario.device),
                           .manipulator_joints = manipulator_joints(scenario.device),
                           .twin_joints = {},
                           .limits = scenario.limits};
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    names.twin_joints.push_back({.name = joint.name,
                                 .is_floating = joint.type == model::JointType::kFloating,
                                 .is_slide = joint.is_slide()});
  }
  return names;
}

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const ScenarioOptions& options) {
  recording::RecordingInfo info;
  static_cast<messages::RunNames&>(info) = run_names(scenario);
  info.name = recording_name(options, scenario);
  info.gantry_units = gantry_units(scenario.device);
  info.manipulator_units = manipulator_units(scenario.device);
  for (const auto& source : scenario.sources) {
    info.configuration.push_back({source.name, source.content});
  }
  if (const std::string text = to_text(options); !text.empty()) {
    info.configuration.push_back({kArguments, text});
  }
  info.rate_Hz = scenario.device.model.rate_Hz;
  // the scenario may be gone when links are made
  const auto kept = std::make_shared<const config::Scenario>(scenario);
  info.make_links = [kept] { return link_tree(*kept); };
  info.device_description = device_description(scenario);
  info.twin_description = twin_description(scenario);
  return info;
}

}  // namespace hg::scenario
