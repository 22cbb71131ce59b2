#include "apps/hapticgiant/run_setup.h"

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/recording/recording_folder.h"

namespace hg::apps {
namespace {

constexpr char kArguments[] = "arguments";  // attachment of a recording

// a remote device has its own seed, step, hand and sensors
void refuse_what_is_simulated(const scenario::Options& world) {
  std::vector<std::string> given;
  if (world.seed) given.push_back("--seed");
  if (world.step_s) given.push_back("--step");
  if (!world.hand.empty()) given.push_back("--hand");
  if (!world.simulation.empty()) given.push_back("--simulation");
  if (!world.sensors.empty()) given.push_back("--sensors");
  if (given.empty()) return;
  throw SetupError(
      fmt::format("{}: the device of --device-address is simulated elsewhere; give this to "
                  "'hapticgiant simulate' there",
                  fmt::join(given, ", ")));
}

std::string recording_name(const std::filesystem::path& scenario) {
  constexpr std::string_view kMarks = "._-";
  std::string name = scenario.stem().string();
  for (char& c : name) {
    const bool is_plain =
        (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    if (!is_plain && kMarks.find(c) == std::string_view::npos) c = '_';
  }
  return name;
}

}  // namespace

config::Scenario make_scenario(const RunArguments& arguments) {
  if (!arguments.device_address.empty()) refuse_what_is_simulated(arguments.world);
  config::Scenario scenario = scenario::load(arguments.world);
  scenario.device.rendering.slow_solve = arguments.slow_solve;
  return scenario;
}

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
  return scenario::load_recorded(std::move(sources), options);
}

recording::ProblemDumps problem_dumps(const config::Scenario& scenario,
                                      const RunArguments& arguments,
                                      const recording::Recorder* recorder) {
  const analysis::RunFacts facts = scenario::facts_of_scenario(scenario);
  const auto now = std::chrono::system_clock::now();
  return recording::ProblemDumps(
      {.folder = arguments.has_recording ? arguments.recordings : "",
       .stem = recorder != nullptr
                   ? recorder->stem()
                   : recording::stamped(recording_name(arguments.world.scenario), now),
       .origin = fmt::format("{}, law {}, bounds {}, gantry {}, braking {}", facts.scenario,
                             facts.law, facts.bounds, facts.gantry, facts.braking),
       .program = arguments.program});
}

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments) {
  recording::RecordingInfo info;
  info.folder = arguments.recordings;
  info.name = recording_name(arguments.world.scenario);
  info.gantry_joints = scenario::gantry_joints(scenario.device);
  info.manipulator_joints = scenario::manipulator_joints(scenario.device);
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    info.twin_joints.push_back({joint.name, joint.type == model::JointType::kFloating});
  }
  info.limits = scenario.limits;
  for (const auto& source : scenario.sources) {
    info.configuration.push_back({source.name, source.content});
  }
  if (const std::string options = scenario::to_text(arguments.world); !options.empty()) {
    info.configuration.push_back({kArguments, options});
  }
  info.version = kVersion;
  info.rate_Hz = scenario.device.model.rate_Hz;
  return info;
}

}  // namespace hg::apps
