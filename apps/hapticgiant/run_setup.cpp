#include "apps/hapticgiant/run_setup.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/version.h"
#include "hg/config/law_names.h"
#include "hg/config/script_schema.h"
#include "hg/controller/rendering/catalogue.h"
#include "hg/core/error.h"
#include "hg/recording/recording_folder.h"

namespace hg::apps {
namespace {

constexpr char kArguments[] = "arguments";  // attachment of a recording

// applies --device, --simulation, --twin, --user and --rate-hz; expected events belong to the
// scenario as it stands
void apply(const ScenarioArguments& arguments, config::SourceReader& reader,
           config::Scenario& scenario) {
  const auto add_sources = [&](const std::vector<config::SourceText>& sources) {
    scenario.sources.insert(scenario.sources.end(), sources.begin(), sources.end());
  };
  if (!arguments.device.empty()) {
    scenario.device = config::load_device(arguments.device, reader);
    add_sources(scenario.device.sources);
  }
  if (!arguments.simulation.empty()) {
    const std::size_t first = scenario.device.sources.size();
    config::take_simulation(scenario.device,
                            find_simulation(arguments.simulation, scenario.device, reader), reader);
    const auto& sources = scenario.device.sources;
    add_sources({sources.begin() + static_cast<std::ptrdiff_t>(first), sources.end()});
  }
  if (!arguments.twin.empty()) {
    scenario.twin = config::load_twin(find_twin(arguments.twin, reader), reader);
    scenario.title = scenario.twin.name;
    scenario.description = "You hold the " + scenario.twin.name + " by the handle of the " +
                           scenario.device.name + ".";
    scenario.changes.clear();
    add_sources(scenario.twin.sources);
  }
  if (!arguments.twin.empty() || !arguments.device.empty()) {
    scenario.limits = rendering::make_catalogue(scenario.device.model, scenario.twin.model);
    if (const auto repeated = rendering::repeated_names(scenario.limits); !repeated.empty()) {
      throw SetupError("device and twin together must not use a name twice, got '" +
                       repeated.front() + "'");
    }
    scenario.events.clear();
  }
  if (!arguments.user.empty()) scenario.events.clear();

  if (arguments.user == "mouse") {
    scenario.person = person::PersonKind::kMouse;
  } else if (arguments.user == "none") {
    scenario.person = person::PersonKind::kNone;
  } else if (!arguments.user.empty()) {
    scenario.person = person::PersonKind::kScript;
    scenario.script = config::load_script(find_script(arguments.user), scenario.twin.model, reader);
    scenario.duration_s = 0.0;  // as long as this script
    add_sources(scenario.script.sources);
  } else if (!arguments.twin.empty()) {
    scenario.person = person::PersonKind::kMouse;  // a script is made for one twin
  }
  if (arguments.rate_Hz) config::set_rate(scenario.device, *arguments.rate_Hz);
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
void apply_to_simulation(const ScenarioArguments& arguments, config::Scenario& scenario) {
  config::Device& device = scenario.device;
  if (arguments.plant == "ideal") device.control.method = tracking::Method::kDrives;
  if (arguments.plant == "elastic" && device.control.actuators.empty()) {
    throw SetupError("--plant elastic: needs 'actuators' in " + device.sources.front().name);
  }
  if (arguments.seed) device.simulation.seed = *arguments.seed;
  device.simulation.sensors.seed = device.simulation.seed;
  if (arguments.sensors == "ideal") device.simulation.sensors = simulator::ideal_sensors();
  if (arguments.step_s) device.simulation.step_s = *arguments.step_s;
  if (!arguments.hand.empty()) {
    person::HandPreset preset = person::HandPreset::kNormal;
    choose("--hand", arguments.hand, config::Choices<person::HandPreset>(config::kHandPresets),
           preset);
    scenario.script.hand = person::hand(preset);
  }
  config::settle_law(scenario);
}

// a remote device has its own seed, step, hand and sensors
void refuse_what_is_simulated(const ScenarioArguments& arguments) {
  std::vector<std::string> given;
  if (arguments.seed) given.push_back("--seed");
  if (arguments.step_s) given.push_back("--step");
  if (!arguments.hand.empty()) given.push_back("--hand");
  if (!arguments.simulation.empty()) given.push_back("--simulation");
  if (!arguments.sensors.empty()) given.push_back("--sensors");
  if (given.empty()) return;
  throw SetupError(
      fmt::format("{}: the device of --device-address is simulated elsewhere; give this to "
                  "'hapticgiant simulate' there",
                  fmt::join(given, ", ")));
}

std::vector<std::string> joint_names(const rendering::DeviceModel& device, int first, int count) {
  std::vector<std::string> names;
  for (int i = first; i < first + count; ++i) {
    names.push_back(device.chain.joints()[static_cast<std::size_t>(i)].name);
  }
  return names;
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

// the arguments of changes() below that determine the cycle
RunArguments recorded_arguments(const std::string& text) {
  RunArguments arguments;
  ScenarioArguments& world = arguments.world;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = line.find(' ');
    if (space == std::string::npos) continue;
    const std::string option = line.substr(0, space), value = line.substr(space + 1);
    if (option == "--device") world.device = value;
    if (option == "--twin") world.twin = value;
    if (option == "--rate-hz") world.rate_Hz = std::strtod(value.c_str(), nullptr);
    if (option == "--simulation") world.simulation = value;
    if (option == "--plant") world.plant = value;
    if (option == "--law") arguments.law = value;
    if (option == "--bounds") arguments.bounds = value;
    if (option == "--gantry") arguments.gantry = value;
    if (option == "--braking") arguments.braking = value;
    if (option == "--passivity") arguments.passivity = value;
  }
  return arguments;
}

void apply_law(const RunArguments& arguments, config::Scenario& scenario) {
  choose("--law", arguments.law, config::Choices<rendering::Law>(config::kLaws),
         scenario.device.rendering.law);
  choose("--bounds", arguments.bounds, config::Choices<rendering::Bounds>(config::kBounds),
         scenario.device.rendering.bounds);
  choose("--gantry", arguments.gantry, config::Choices<rendering::Gantry>(config::kGantries),
         scenario.device.rendering.gantry);
  choose("--braking", arguments.braking, config::Choices<rendering::Braking>(config::kBrakings),
         scenario.device.rendering.braking);
  choose("--passivity", arguments.passivity,
         config::Choices<passivity::Reaction>(config::kPassivityReactions),
         scenario.device.passivity.reaction);
  config::settle_law(scenario);
}

// the options that change what the scenario says, one per line
std::string changes(const RunArguments& arguments) {
  std::string text;
  const auto line = [&](const char* option, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} {}\n", option, value);
  };
  const ScenarioArguments& world = arguments.world;
  line("--device", world.device);
  if (!world.twin.empty()) line("--twin", find_twin(world.twin, {}).string());
  line("--user", world.user);
  if (world.rate_Hz) line("--rate-hz", fmt::format("{}", *world.rate_Hz));
  line("--plant", world.plant);
  line("--simulation", world.simulation);
  line("--sensors", world.sensors);
  line("--hand", world.hand);
  if (world.seed) line("--seed", fmt::format("{}", *world.seed));
  if (world.step_s) line("--step", fmt::format("{}", *world.step_s));
  line("--law", arguments.law);
  line("--bounds", arguments.bounds);
  line("--gantry", arguments.gantry);
  line("--braking", arguments.braking);
  line("--passivity", arguments.passivity);
  return text;
}

}  // namespace

config::Scenario make_scenario(const ScenarioArguments& arguments) {
  config::Scenario scenario = config::load_scenario(find_scenario(arguments.scenario));
  config::SourceReader reader;
  apply(arguments, reader, scenario);
  apply_to_simulation(arguments, scenario);
  return scenario;
}

config::Scenario make_scenario(const RunArguments& arguments) {
  if (!arguments.device_address.empty()) refuse_what_is_simulated(arguments.world);
  config::Scenario scenario = make_scenario(arguments.world);
  apply_law(arguments, scenario);
  scenario.device.rendering.slow_solve = arguments.slow_solve;
  return scenario;
}

config::Scenario recorded_scenario(const std::vector<recording::NamedText>& configuration) {
  std::vector<config::SourceText> sources;
  RunArguments arguments;
  for (const recording::NamedText& text : configuration) {
    if (text.name == kArguments) {
      arguments = recorded_arguments(text.text);
    } else {
      sources.push_back({text.name, text.text});
    }
  }
  config::Scenario scenario = config::load_scenario(sources);
  config::SourceReader reader(std::move(sources));
  apply(arguments.world, reader, scenario);
  apply_to_simulation(arguments.world, scenario);
  apply_law(arguments, scenario);
  return scenario;
}

ProblemDumps problem_dumps(const config::Scenario& scenario, const RunArguments& arguments,
                           const recording::Recorder* recorder) {
  const analysis::RunFacts facts = facts_of_scenario(scenario);
  const auto now = std::chrono::system_clock::now();
  return ProblemDumps(
      {.folder = arguments.has_recording ? arguments.recordings : "",
       .stem = recorder != nullptr
                   ? recorder->stem()
                   : recording::stamped(recording_name(arguments.world.scenario), now),
       .origin = fmt::format("{}, law {}, bounds {}, gantry {}, braking {}", facts.scenario,
                             facts.law, facts.bounds, facts.gantry, facts.braking),
       .program = arguments.program});
}

analysis::RunFacts facts_of_scenario(const config::Scenario& scenario) {
  using rendering::Braking;
  using rendering::Gantry;
  const rendering::DeviceModel& device = scenario.device.model;
  const rendering::Options& law = scenario.device.rendering;
  const Gantry gantry = rendering::leads_gantry(device, law) ? Gantry::kLaw : Gantry::kRule;
  const Braking braking =
      rendering::brakes_together(device, law) ? Braking::kTogether : Braking::kAlone;
  return {.scenario = scenario.title,
          .law = std::string(rendering::to_string(law.law)),
          .bounds = std::string(rendering::to_string(law.bounds)),
          .gantry = std::string(rendering::to_string(gantry)),
          .braking = std::string(rendering::to_string(braking))};
}

analysis::Names part_names(const config::Scenario& scenario) {
  const rendering::DeviceModel& device = scenario.device.model;
  return {.joints = joint_names(device, device.n_p, device.n_m),
          .gantry = joint_names(device, 0, device.n_p),
          .pairs = collision::pair_names(scenario.device.collision),
          .limits = scenario.limits};
}

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const RunArguments& arguments) {
  const rendering::DeviceModel& device = scenario.device.model;
  recording::RecordingInfo info;
  info.folder = arguments.recordings;
  info.name = recording_name(arguments.world.scenario);
  info.gantry_joints = joint_names(device, 0, device.n_p);
  info.manipulator_joints = joint_names(device, device.n_p, device.n_m);
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    info.twin_joints.push_back({joint.name, joint.type == model::JointType::kFloating});
  }
  info.limits = scenario.limits;
  for (const auto& source : scenario.sources) {
    info.configuration.push_back({source.name, source.content});
  }
  if (const std::string options = changes(arguments); !options.empty()) {
    info.configuration.push_back({kArguments, options});
  }
  info.version = kVersion;
  info.rate_Hz = scenario.device.rate_Hz;
  return info;
}

}  // namespace hg::apps
