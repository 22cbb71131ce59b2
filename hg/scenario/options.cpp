#include "hg/scenario/options.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "hg/config/law_names.h"
#include "hg/config/shipped_files.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/controller/rendering/catalogue.h"
#include "hg/core/error.h"

namespace hg::scenario {
namespace {

// applies --device, --simulation, --twin, --user and --rate-hz; expected events belong to the
// scenario as it stands
void apply(const ScenarioOptions& options, config::SourceReader& reader,
           config::Scenario& scenario) {
  const auto add_sources = [&](const std::vector<config::SourceText>& sources) {
    scenario.sources.insert(scenario.sources.end(), sources.begin(), sources.end());
  };
  if (!options.device.empty()) {
    scenario.device =
        config::load_simulated_device(config::find_device(options.device, reader), reader);
    add_sources(scenario.device.sources);
  }
  if (!options.simulation.empty()) {
    const std::size_t first = scenario.device.sources.size();
    config::take_simulation(scenario.device,
                            config::find_simulation(options.simulation, scenario.device, reader),
                            reader);
    const auto& sources = scenario.device.sources;
    add_sources({sources.begin() + static_cast<std::ptrdiff_t>(first), sources.end()});
  }
  if (!options.twin.empty()) {
    scenario.twin = config::load_twin(config::find_twin(options.twin, reader), reader);
    scenario.title = scenario.twin.name;
    scenario.description = "You hold the " + scenario.twin.name + " by the handle of the " +
                           scenario.device.name + ".";
    scenario.changes.clear();
    add_sources(scenario.twin.sources);
  }
  if (!options.twin.empty() || !options.device.empty()) {
    scenario.limits = rendering::make_catalogue(scenario.device.model, scenario.twin.model);
    if (const auto repeated = rendering::repeated_names(scenario.limits); !repeated.empty()) {
      throw SetupError("device and twin together must not use a name twice, got '" +
                       repeated.front() + "'");
    }
    scenario.events.clear();
  }
  if (!options.user.empty()) scenario.events.clear();

  if (options.user == "mouse") {
    scenario.person = person::PersonKind::kMouse;
  } else if (options.user == "none") {
    scenario.person = person::PersonKind::kNone;
  } else if (!options.user.empty()) {
    scenario.person = person::PersonKind::kScript;
    scenario.script =
        config::load_script(config::find_script(options.user), scenario.twin.model, reader);
    scenario.duration_s = 0.0;  // as long as this script
    add_sources(scenario.script.sources);
  } else if (!options.twin.empty()) {
    scenario.person = person::PersonKind::kMouse;  // a script is made for one twin
  }
  if (options.rate_Hz) {
    config::check_rate(scenario.device, *options.rate_Hz);
    scenario.device.model.rate_Hz = *options.rate_Hz;
  }
}

// `text` is one of the names of `choices`; empty leaves the value alone
template <class T>
void choose(const char* option, const std::string& text, config::Choices<T> choices, T& value) {
  if (text.empty()) return;
  for (const config::Choice<T>& choice : choices) {
    if (choice.name == text) {
      value = choice.value;
      return;
    }
  }
  throw SetupError(fmt::format("{}: expected one of the names of --help, got '{}'", option, text));
}

// applies --plant, --sensors, --hand, --seed and --step
void apply_to_simulation(const ScenarioOptions& options, config::Scenario& scenario) {
  config::SimulatedDeviceConfig& device = scenario.device;
  if (options.plant == "ideal") {
    device.control.method = tracking::Method::kDrives;
    device.simulation.drives.actuators.clear();
  }
  if (options.plant == "elastic" && config::plant_of(device) == config::PlantKind::kIdeal) {
    throw SetupError("--plant elastic: needs 'actuators' in " + device.sources.front().name +
                     ", or 'drives' with actuators in its simulation");
  }
  if (options.seed) device.simulation.seed = *options.seed;
  device.simulation.sensors.seed = device.simulation.seed;
  if (options.sensors == "ideal") device.simulation.sensors = simulator::ideal_sensors();
  if (options.step_s) device.simulation.step_s = *options.step_s;
  if (!options.hand.empty()) {
    person::HandPreset preset = person::HandPreset::kNormal;
    choose("--hand", options.hand, config::Choices<person::HandPreset>(config::kHandPresets),
           preset);
    scenario.script.hand = person::hand(preset);
  }
}

// the options of to_text() that determine the cycle, and the seed of the simulation
ScenarioOptions recorded_options(const std::string& text) {
  ScenarioOptions options;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = line.find(' ');
    if (space == std::string::npos) continue;
    const std::string option = line.substr(0, space), value = line.substr(space + 1);
    if (option == "--device") options.device = value;
    if (option == "--twin") options.twin = value;
    if (option == "--rate-hz") options.rate_Hz = std::strtod(value.c_str(), nullptr);
    if (option == "--simulation") options.simulation = value;
    if (option == "--seed") options.seed = std::strtoull(value.c_str(), nullptr, 10);
    if (option == "--plant") options.plant = value;
    if (option == "--law") options.law = value;
    if (option == "--bounds") options.bounds = value;
    if (option == "--gantry") options.gantry = value;
    if (option == "--braking") options.braking = value;
    if (option == "--passivity") options.passivity = value;
  }
  return options;
}

void apply_law(const ScenarioOptions& options, config::Scenario& scenario) {
  choose("--law", options.law, config::Choices<rendering::Law>(config::kLaws),
         scenario.device.rendering.law);
  choose("--bounds", options.bounds, config::Choices<rendering::Bounds>(config::kBounds),
         scenario.device.rendering.bounds);
  choose("--gantry", options.gantry, config::Choices<rendering::Gantry>(config::kGantries),
         scenario.device.rendering.gantry);
  choose("--braking", options.braking, config::Choices<rendering::Braking>(config::kBrakings),
         scenario.device.rendering.braking);
  choose("--passivity", options.passivity,
         config::Choices<passivity::Reaction>(config::kPassivityReactions),
         scenario.device.passivity.reaction);
  config::settle_law(scenario);
}

}  // namespace

config::Scenario load(const ScenarioOptions& options) {
  config::Scenario scenario = config::load_scenario(config::find_scenario(options.scenario));
  config::SourceReader reader;
  apply(options, reader, scenario);
  apply_to_simulation(options, scenario);
  apply_law(options, scenario);
  return scenario;
}

std::string to_text(const ScenarioOptions& options) {
  std::string text;
  const auto line = [&](const char* option, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} {}\n", option, value);
  };
  if (!options.device.empty()) {
    line("--device", config::find_device(options.device, {}).string());
  }
  if (!options.twin.empty()) line("--twin", config::find_twin(options.twin, {}).string());
  line("--user", options.user);
  if (options.rate_Hz) line("--rate-hz", fmt::format("{}", *options.rate_Hz));
  line("--plant", options.plant);
  line("--simulation", options.simulation);
  line("--sensors", options.sensors);
  line("--hand", options.hand);
  if (options.seed) line("--seed", fmt::format("{}", *options.seed));
  if (options.step_s) line("--step", fmt::format("{}", *options.step_s));
  line("--law", options.law);
  line("--bounds", options.bounds);
  line("--gantry", options.gantry);
  line("--braking", options.braking);
  line("--passivity", options.passivity);
  return text;
}

config::Scenario load_recorded(std::vector<config::SourceText> sources, const std::string& text) {
  const ScenarioOptions options = recorded_options(text);
  config::Scenario scenario = config::load_scenario(sources);
  config::SourceReader reader(std::move(sources));
  apply(options, reader, scenario);
  apply_to_simulation(options, scenario);
  apply_law(options, scenario);
  return scenario;
}

}  // namespace hg::scenario
