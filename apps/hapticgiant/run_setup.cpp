#include "apps/hapticgiant/run_setup.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

// a remote device has its own seed, step, hand and sensors
void refuse_what_is_simulated(const scenario::ScenarioOptions& world) {
  std::vector<std::string> given;
  if (world.seed) given.push_back("--seed");
  if (world.step_s) given.push_back("--step");
  if (!world.hand.empty()) given.push_back("--hand");
  if (!world.simulation.empty()) given.push_back("--simulation");
  if (!world.sensors.empty()) given.push_back("--sensors");
  for (const std::string& change : world.changes) {
    if (change.starts_with("simulation.") || change.starts_with("script.")) {
      given.push_back("--set " + change);
    }
  }
  if (given.empty()) return;
  throw SetupError(
      fmt::format("{}: the device of --device-address is simulated elsewhere; give this to "
                  "'hapticgiant simulate' there",
                  fmt::join(given, ", ")));
}

}  // namespace

config::Scenario make_scenario(const RunArguments& arguments) {
  if (!arguments.device_address.empty()) refuse_what_is_simulated(arguments.world);
  config::Scenario scenario = scenario::load(arguments.world);
  scenario.device.rendering.slow_solve = arguments.slow_solve;
  return scenario;
}

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments) {
  recording::RecordingInfo info = scenario::recording_info(scenario, arguments.world);
  info.folder = arguments.recordings;
  info.version = kVersion;
  return info;
}

}  // namespace hg::apps
