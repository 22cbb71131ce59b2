#include "hg/experiments/moved_scenario.h"

#include <fmt/format.h>

#include "hg/core/error.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/free_space.h"
#include "hg/experiments/place.h"
#include "hg/scenario/start_posture.h"
#include "hg/workspace/way.h"

namespace hg::experiments {
namespace {

constexpr double kDuration = 15.0;  // s, of strokes of a free body

bool is_free_body(const rendering::TwinModel& twin) {
  return twin.chain.joints().size() == 1 &&
         twin.chain.joints().front().type == model::JointType::kFloating;
}

person::Script strokes(const config::Scenario& scenario, const Place& place) {
  haptify::FreeSpaceConfig config;
  config.duration_s = kDuration;
  config.lower = place.lower;
  config.upper = place.upper;
  config.turn_range = place.turn;
  const Pose start = scenario::handle_start(scenario.twin.model);
  return haptify::exploration(config, config::hand_of(start), 1);
}

}  // namespace

config::Scenario moved_scenario(scenario::ScenarioOptions options) {
  options.scenario = "walk";
  config::Scenario scenario = scenario::load(options);
  person::Script script;
  if (is_free_body(scenario.twin.model)) {
    const Place place = place_of(scenario.device);
    scenario = at_place(scenario, place);
    script = strokes(scenario, place);
  } else {
    const double grasp_s = scenario.script.script.grasp_s;
    if (!workspace::take_script_through_ranges(scenario)) {
      throw SetupError(fmt::format(
          "twin {}: no joint has limits through which a hand can lead it within a minute; give a "
          "scenario with a script instead",
          scenario.twin.name));
    }
    script = scenario.script.script;
    scenario.script.script.grasp_s = grasp_s;
  }
  play_script(scenario, script);
  scenario.script.script.start[person::kGripChannel] = 1.0;
  scenario.events.clear();
  scenario.title = fmt::format("{} on {}", scenario.twin.name, scenario.device.name);
  return scenario;
}

}  // namespace hg::experiments
