#include "hg/scenario/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "hg/config/changed_text.h"
#include "hg/config/law_names.h"
#include "hg/config/shipped_files.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/controller/rendering/catalogue.h"
#include "hg/core/input_fault.h"
#include "hg/core/nearest_name.h"
#include "hg/scenario/names.h"

namespace hg::scenario {
namespace {

constexpr char kNoSurfaces[] = "none";

// applies --surfaces; returns the files that were read
std::vector<config::SourceText> apply_surfaces(const std::string& name,
                                               config::SourceReader& reader,
                                               config::Scenario& scenario) {
  if (name == kNoSurfaces) {
    scenario.surfaces.clear();
    return {};
  }
  const std::size_t read = reader.texts().size();
  config::Scenario other = config::load_scenario(config::find_surfaces(name, reader), reader);
  if (other.surfaces.empty()) {
    throw SetupError(fmt::format("--surfaces {}: this scenario has no surfaces", name));
  }
  scenario.surfaces = std::move(other.surfaces);
  return reader.since(read);
}

// applies --user, and who holds the handle of another twin; returns the files that were read
std::vector<config::SourceText> apply_person(const ScenarioOptions& options,
                                             config::SourceReader& reader,
                                             config::Scenario& scenario) {
  if (!options.user.empty()) {
    scenario.events.clear();
    // times of its own script
    if (scenario.teleoperation) scenario.teleoperation->clutch_open.clear();
  }
  if (options.user == "mouse") {
    scenario.person = person::PersonKind::kMouse;
  } else if (options.user == "none") {
    scenario.person = person::PersonKind::kNone;
  } else if (!options.user.empty()) {
    scenario.person = person::PersonKind::kScript;
    scenario.script =
        config::load_script(config::find_script(options.user), scenario.twin.model, reader);
    scenario.duration_s = 0.0;  // as long as this script
    return scenario.script.sources;
  } else if (!options.twin.empty()) {
    scenario.person = person::PersonKind::kMouse;  // a script is made for one twin
  }
  return {};
}

// applies --device, --simulation, --twin, --surfaces, --user and --rate-hz; expected events belong
// to the scenario as it stands
void apply(const ScenarioOptions& options, config::SourceReader& reader,
           config::Scenario& scenario) {
  const auto add_sources = [&](const std::vector<config::SourceText>& sources) {
    scenario.sources.insert(scenario.sources.end(), sources.begin(), sources.end());
  };
  if (!options.device.empty()) {
    if (!scenario.faults.empty() || scenario.bystander) {
      throw SetupError(
          "--device: the scenario's faults and bystander are of its own device; leave them out");
    }
    scenario.title = without_device(std::move(scenario.title), scenario.device.name);
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
  if (!options.surfaces.empty()) {
    add_sources(apply_surfaces(options.surfaces, reader, scenario));
    scenario.events.clear();
  }
  if (!options.surfaces.empty() || !options.twin.empty()) {
    config::check_start_outside(scenario.surfaces, scenario.twin.model);
  }
  if (!options.twin.empty() || !options.device.empty()) {
    scenario.limits = rendering::make_catalogue(scenario.device.model, scenario.twin.model);
    if (const auto repeated = rendering::repeated_names(scenario.limits); !repeated.empty()) {
      throw SetupError("device and twin together must not use a name twice, got '" +
                       repeated.front() + "'");
    }
    scenario.events.clear();
  }
  add_sources(apply_person(options, reader, scenario));
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
    device.model.actuators.clear();
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
    if (option == "--surfaces") options.surfaces = value;
    if (option == "--rate-hz") options.rate_Hz = std::strtod(value.c_str(), nullptr);
    if (option == "--simulation") options.simulation = value;
    if (option == "--seed") options.seed = std::strtoull(value.c_str(), nullptr, 10);
    if (option == "--plant") options.plant = value;
    if (option == "--law") options.law = value;
  }
  return options;
}

// applies the options of earlier versions for single parts of the law and for passivity
void apply_earlier(const std::string& text, config::Scenario& scenario) {
  rendering::RenderingOptions& law = scenario.device.rendering;
  std::istringstream words(text);
  for (std::string option, value; words >> option;) {
    if (!std::getline(words >> std::ws, value)) return;
    const auto is = [&](const char* name) { return option == name; };
    if (is("--bounds")) choose("--bounds", value, {config::kBounds}, law.bounds);
    if (is("--gantry")) choose("--gantry", value, {config::kGantries}, law.gantry);
    if (is("--braking")) choose("--braking", value, {config::kBrakings}, law.braking);
    if (is("--passivity")) {
      choose("--passivity", value, {config::kPassivityReactions},
             scenario.device.passivity.reaction);
    }
  }
  config::settle_law(scenario);
}

// applies --law; parts of the law that device.yaml gives by keys of their own stay
void apply_law(const ScenarioOptions& options, config::Scenario& scenario) {
  if (!options.law.empty()) {
    config::LawPreset preset = config::LawPreset::kTogether;
    choose("--law", options.law, {config::kLawPresets}, preset);
    rendering::RenderingOptions& law = scenario.device.rendering;
    const rendering::RenderingOptions own = law;
    set_parts(law, preset);
    const auto is_given = [&](const char* key) {  // else its place is that of the map around it
      const config::Places& places = scenario.device.places;
      const config::Place place = places.nearest(key), around = places.nearest("rendering");
      return place.line != around.line || place.column != around.column;
    };
    if (is_given("rendering.bounds")) law.bounds = own.bounds;
    if (is_given("rendering.gantry")) law.gantry = own.gantry;
    if (is_given("rendering.braking")) law.braking = own.braking;
  }
  config::settle_law(scenario);
}

config::Scenario apply_all(const ScenarioOptions& options, config::SourceReader& reader,
                           config::Scenario scenario) {
  apply(options, reader, scenario);
  apply_to_simulation(options, scenario);
  apply_law(options, scenario);
  return scenario;
}

// A file of a scenario whose keys --set can change.
struct Part {
  std::string name;
  std::string file;  ///< empty = the scenario has none
  std::vector<config::ChangedValue> changes;
};

std::string first_of(const std::vector<config::SourceText>& sources) {
  return sources.empty() ? "" : sources.front().name;
}

std::vector<Part> parts_of(const ScenarioOptions& options, const config::Scenario& scenario) {
  const config::SimulatedDeviceConfig& device = scenario.device;
  std::filesystem::path simulation = device.simulation_file;
  if (!options.simulation.empty()) {
    simulation = config::find_simulation(options.simulation, device, {});
  }
  std::vector<Part> parts = {{"scenario", first_of(scenario.sources), {}},
                             {"device", first_of(device.sources), {}},
                             {"simulation", simulation.lexically_normal().generic_string(), {}},
                             {"twin", first_of(scenario.twin.sources), {}},
                             {"script", first_of(scenario.script.sources), {}}};
  std::vector<std::string> names;
  for (const Part& part : parts) names.push_back(part.name);
  for (const std::string& change : options.changes) {
    const std::size_t dot = change.find('.'), equals = change.find('=');
    if (dot >= equals || equals == std::string::npos) {
      throw SetupError(
          fmt::format("--set {}: expected PART.KEY=VALUE, as twin.mass_scale=2; a part is {}",
                      change, fmt::join(names, ", ")));
    }
    const std::string name = change.substr(0, dot);
    const auto part = std::ranges::find(parts, name, &Part::name);
    if (part == parts.end()) {
      throw SetupError(fmt::format("--set {}: no such part, did you mean '{}'?", change,
                                   nearest_name(name, names)));
    }
    if (part->file.empty()) {
      throw SetupError(fmt::format("--set {}: this run has no {} file", change, name));
    }
    part->changes.push_back({change.substr(dot + 1, equals - dot - 1), change.substr(equals + 1)});
  }
  std::erase_if(parts, [](const Part& part) { return part.changes.empty(); });
  return parts;
}

constexpr char kKnownFilesOnly[] =
    "; --set reads no file that the scenario did not read without it: change the file that names "
    "it, "
    "or give --twin or --device";

// A fault in a file with changed values, as one of these values: before them there was none.
std::string as_change(const InputFault& fault, const std::vector<Part>& parts) {
  const auto part = std::ranges::find(parts, fault.file, &Part::file);
  if (part == parts.end()) return to_text(fault);
  std::string text = fmt::format("--set {}{}{}", part->name, fault.item.empty() ? ": " : ".",
                                 text_without_place(fault));
  if (fault.is_missing_file) {
    text += kKnownFilesOnly;
  } else if (fault.meant.find_first_of(".[") != std::string::npos) {
    text += "; a name with a dot or bracket stands in quotes, as in joints.\"arm.1\".start_rad";
  }
  return text;
}

// The files of `scenario`, which options have made, with the values of --set.
config::Scenario load_changed(const ScenarioOptions& options, const config::Scenario& scenario) {
  const std::vector<Part> parts = parts_of(options, scenario);
  std::vector<config::SourceText> sources = scenario.sources;
  for (const Part& part : parts) {
    try {
      for (config::SourceText& source : sources) {
        if (source.name == part.file) {
          source.content = config::changed_text(source.content, part.changes);
        }
      }
    } catch (const SetupError& error) {
      throw SetupError(fmt::format("--set {}.{}", part.name, error.what()));
    }
  }
  ScenarioOptions known = options;  // as the files are called in `sources`
  if (!options.device.empty()) known.device = first_of(scenario.device.sources);
  if (!options.twin.empty()) known.twin = first_of(scenario.twin.sources);
  if (!options.surfaces.empty() && options.surfaces != kNoSurfaces) {
    known.surfaces =
        config::find_surfaces(options.surfaces, {}).lexically_normal().generic_string();
  }
  try {
    config::SourceReader reader(sources);
    return apply_all(known, reader, config::load_scenario(sources));
  } catch (const SetupError& error) {
    std::vector<std::string> faults;
    for (const InputFault& fault : faults_of(error)) faults.push_back(as_change(fault, parts));
    throw SetupError(fmt::format("{}", fmt::join(faults, "\n")));
  }
}

}  // namespace

config::Scenario load(const ScenarioOptions& options) {
  config::SourceReader reader;
  const config::Scenario scenario =
      apply_all(options, reader, config::load_scenario(config::find_scenario(options.scenario)));
  return options.changes.empty() ? scenario : load_changed(options, scenario);
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
  line("--surfaces", options.surfaces.empty() || options.surfaces == kNoSurfaces
                         ? options.surfaces
                         : config::find_surfaces(options.surfaces, {}).string());
  line("--user", options.user);
  if (options.rate_Hz) line("--rate-hz", fmt::format("{}", *options.rate_Hz));
  line("--plant", options.plant);
  line("--simulation", options.simulation);
  line("--sensors", options.sensors);
  line("--hand", options.hand);
  if (options.seed) line("--seed", fmt::format("{}", *options.seed));
  if (options.step_s) line("--step", fmt::format("{}", *options.step_s));
  line("--law", options.law);
  for (const std::string& change : options.changes) line("--set", change);
  return text;
}

std::string hash_of(const std::vector<config::SourceText>& sources) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto mix = [&](unsigned char byte) { hash = (hash ^ byte) * 0x100000001b3; };
  for (const config::SourceText& source : sources) {
    for (const char byte : source.content) mix(static_cast<unsigned char>(byte));
    mix(0);  // ends the text
  }
  return fmt::format("{:016x}", hash);
}

config::Scenario load_recorded(std::vector<config::SourceText> sources, const std::string& text) {
  const ScenarioOptions options = recorded_options(text);
  config::SourceReader reader(sources);
  config::Scenario scenario = apply_all(options, reader, config::load_scenario(std::move(sources)));
  apply_earlier(text, scenario);
  return scenario;
}

}  // namespace hg::scenario
