#include "apps/offline/experiment_command.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/scenario_options.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/campaign.h"
#include "apps/offline/hands_command.h"
#include "apps/offline/paper_experiment_command.h"
#include "apps/offline/remote_experiment.h"
#include "apps/offline/subcommand.h"
#include "apps/offline/teleoperation_experiment.h"
#include "apps/offline/walking_experiment.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/core/error.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/contact.h"
#include "hg/experiments/haptify/benchmark.h"
#include "hg/experiments/haptify/free_space_variants.h"
#include "hg/experiments/haptify/hand_figures.h"
#include "hg/experiments/haptify/impedance.h"
#include "hg/experiments/inertial.h"
#include "hg/experiments/moved_scenario.h"
#include "hg/experiments/place.h"
#include "hg/experiments/seed_ranges.h"
#include "hg/experiments/stability_map.h"
#include "hg/experiments/workers.h"
#include "hg/scenario/assembly.h"

namespace hg::apps {
namespace {

struct ExperimentArguments {
  std::string json;  ///< file for all figures; empty = none
  std::string svg;   ///< file for the drawing; empty = none
  /// Files that replace those of the scenario; empty = those of the scenario
  std::string device, twin, simulation;
  CampaignOptions played;  ///< of the stability map
};

struct ContactArguments {
  std::string json;    ///< file for all figures; empty = none
  std::string docs;    ///< folder of documentation to refresh; empty = none
  std::string device;  ///< device.yaml; empty = the reference device's
  int seeds = 4;
};

struct InertialArguments {
  std::vector<std::string> scenarios;  ///< scenarios; empty: see scripted_scenarios()
  std::string device, twin;  ///< files that replace those of the scenarios; empty = their own
  std::string simulation;    ///< simulation, see find_simulation(); empty = that of the device
  int seeds = 4;
  bool feels = false;  ///< also measures what a hand feels
  std::string json;    ///< file for all figures; empty = none
};

struct SeedsArguments {
  std::vector<std::string> scenarios;        ///< scenarios; empty: see scripted_scenarios()
  std::vector<std::string> hands = {"own"};  ///< hands: "own" or presets
  int count = 16;
  scenario::ScenarioOptions world;  ///< device, twin and law of all runs
  std::string json;                 ///< file for all runs; empty = none
  std::string markdown;             ///< file for the table; empty = none
};

// of the first repetition of `hapticgiant haptify`, whose numbers are repeated
constexpr std::uint64_t kSeed = haptify::HaptifyOptions{}.seed;

// With another device or simulation where they are given.
config::Scenario walk_scenario(const std::string& device = "", const std::string& simulation = "",
                               const std::string& twin = "") {
  return scenario::load(
      {.scenario = "walk", .device = device, .twin = twin, .simulation = simulation});
}

config::Scenario walk_scenario(const ExperimentArguments& arguments) {
  return walk_scenario(arguments.device, arguments.simulation, arguments.twin);
}

config::Scenario scripted_scenario(const scenario::ScenarioOptions& world) {
  config::Scenario scenario = scenario::load(world);
  if (scenario::planned_duration_s(scenario) == 0.0) {
    throw SetupError(world.scenario + ": no script plays it, so that it has no end");
  }
  return scenario;
}

std::string name_of(const std::string& scenario) {
  return std::filesystem::path(scenario).stem().string();
}

struct NamedScenario {
  std::string name;
  config::Scenario scenario;
};

// The scenarios `given`, each with `world`. Without any a hand moves the device and twin of `world`
// through their ranges; where that has neither, the scenarios are `shipped`.
std::vector<NamedScenario> scripted_scenarios(std::vector<std::string> given,
                                              const scenario::ScenarioOptions& world,
                                              const std::vector<std::string>& shipped) {
  const bool has_own = !world.device.empty() || !world.twin.empty();
  if (given.empty() && has_own) {
    const config::Scenario moved = experiments::moved_scenario(world);
    return {{moved.title, moved}};
  }
  if (given.empty()) given = shipped;
  std::vector<NamedScenario> all;
  for (const std::string& scenario : given) {
    scenario::ScenarioOptions named = world;
    named.scenario = scenario;
    all.push_back({name_of(scenario), scripted_scenario(named)});
  }
  return all;
}

void begin(const ExperimentArguments& arguments, const std::string& what) {
  check_writable(arguments.json, kJson);
  check_writable(arguments.svg, kSvg);
  print_out(fmt::format("HapticGiant {}  {}\n", kVersion, what));
}

// Says which device is measured and where, if it is not the reference device.
void print_place(const config::Scenario& scenario) {
  const std::string place = experiments::to_text(experiments::place_of(scenario.device));
  if (!place.empty()) print_out(fmt::format("{}. {}\n\n", scenario.device.name, place));
}

// Refuses at once what would be measured for nothing: no report can be made, and nothing is kept.
void check_output(const std::string& json) {
  check_writable(json, kJson);
  if (json.empty()) check_report_program();
}

// Writes the results to `json` and makes the report on them, whose file `name` is written to
// `file`; each may be empty. The exit code.
int report(nlohmann::ordered_json results, const std::string& kind, const std::string& json,
           const std::string& docs = "", const char* name = "", const std::string& file = "") {
  write_json(json, results);
  results["kind"] = kind;
  return become_reports({{.results = results,
                          .docs = docs,
                          .files = {{name, file}},
                          .kept = json.empty() ? "" : json + " has the results\n"}});
}

// What a hand feels with encoders alone, and with units on all links that the control uses.
nlohmann::ordered_json felt_with_units(const config::Scenario& walk) {
  config::Scenario with_units = walk;
  estimation::InertialUnitsConfig& units = with_units.device.estimation.units;
  units.frames = experiments::frames_of(walk.device, experiments::unit_sets(walk.device)[0].links);
  experiments::learn_mounting(with_units);
  units.feeds_back = true;
  const std::array<const config::Scenario*, 2> scenarios = {&walk, &with_units};
  std::array<haptify::HandFigures, 2> felt;
  experiments::do_all(
      scenarios.size(),
      [&](std::size_t i) { felt[i] = haptify::measure_hand_figures(*scenarios[i]); },
      progress_of("hands"));
  return {{"encoders alone", to_json(felt[0])}, {"encoders and units", to_json(felt[1])}};
}

int experiment_free_space(const ExperimentArguments& arguments) {
  const haptify::FreeSpaceConfig config;
  check_output(arguments.json);
  begin(arguments,
        fmt::format("Free space: a hand leads a free body on random strokes for {:g} s, seed {}, "
                    "as in `hapticgiant haptify`\n\n",
                    config.duration_s, kSeed));
  const config::Scenario scenario = walk_scenario(arguments);
  print_place(scenario);
  const auto runs = haptify::measure_variants(scenario, config, kSeed, progress_of("variants"));
  return report(haptify::to_json(runs), "free-space", arguments.json);
}

int experiment_stability_map(const ExperimentArguments& arguments) {
  const experiments::StabilityConfig config;
  const bool is_part = !arguments.played.part.empty();
  if (!is_part) {
    check_output(arguments.json);
    check_sweep_program(arguments.played);
    begin(arguments,
          fmt::format("Stability: a kick of {:g} N for {:g} ms on a free body held by a hand\n\n",
                      config.kick.force, 1e3 * config.kick.duration));
  }
  const config::Scenario scenario = walk_scenario(arguments);
  if (!is_part) print_place(scenario);
  std::vector<std::string> words = {"experiment", "stability-map"};
  const auto hand_on = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, file_or_name(value)});
  };
  hand_on("--device", arguments.device);
  hand_on("--twin", arguments.twin);
  hand_on("--simulation", arguments.simulation);
  experiments::StabilityMap map;
  const auto play = [&](experiments::Runs& runs) {
    map = experiments::make_stability_map(scenario, config, runs);
  };
  const std::size_t rows = experiments::rows_of(config);
  if (play_campaign({words, rows, {scenario}, play}, arguments.played)) return 0;
  return report(experiments::to_json(map), "stability-map", arguments.json, "", "map.svg",
                arguments.svg);
}

int experiment_impedance(const ExperimentArguments& arguments) {
  const haptify::ImpedanceConfig config;
  check_output(arguments.json);
  begin(arguments, fmt::format("Impedance at the handle, pushed to and fro with {:g} N, as in "
                               "`hapticgiant haptify`\n\n",
                               config.response.force));
  const config::Scenario scenario = walk_scenario(arguments);
  print_place(scenario);
  const experiments::FreeTwin twin = experiments::free_twin_of(scenario);
  const auto runs = haptify::measure_impedance(scenario, config, kSeed, progress_of("pushes"));
  return report(haptify::to_json(runs, config, twin), "impedance", arguments.json);
}

int experiment_contact(const ContactArguments& arguments) {
  experiments::ContactConfig config;
  config.seeds = arguments.seeds;
  const config::Scenario scenario = walk_scenario(arguments.device);
  if (!scenario.device.model.has_closed_form) {
    throw SetupError(fmt::format(
        "experiment contact: not possible with {}: a person stands in the way of elbow and wrist "
        "of a HapticGiant; how another device stops show `hapticgiant check` of its file and "
        "`hapticgiant faults --device FILE`",
        scenario.device.name));
  }
  check_output(arguments.json);
  print_out(fmt::format("HapticGiant {}  Contact: the arm hits a person in its way\n\n", kVersion));
  const experiments::ContactMeasures measures =
      experiments::measure_contact(scenario, config, progress_of("cases"));
  return report(experiments::to_json(measures), "contact", arguments.json, arguments.docs);
}

int experiment_inertial(const InertialArguments& arguments) {
  std::vector<config::Scenario> scenarios;
  std::vector<std::string> names;
  const scenario::ScenarioOptions world = {
      .device = arguments.device, .twin = arguments.twin, .simulation = arguments.simulation};
  for (NamedScenario& it : scripted_scenarios(arguments.scenarios, world, {"walk", "door"})) {
    scenarios.push_back(std::move(it.scenario));
    names.push_back(std::move(it.name));
  }
  check_output(arguments.json);
  print_out(fmt::format(
      "HapticGiant {}  Inertial units on links: rms errors, median of seeds 1 to {}\n\n", kVersion,
      arguments.seeds));
  const std::vector<experiments::InertialRun> runs =
      experiments::measure_inertial(scenarios, names, arguments.seeds, progress_of("runs"));
  nlohmann::ordered_json results = experiments::to_json(runs);
  if (arguments.feels) {
    results["felt"] = felt_with_units(walk_scenario(arguments.device, arguments.simulation));
  }
  return report(results, "inertial", arguments.json);
}

int experiment_seeds(const SeedsArguments& arguments) {
  std::vector<experiments::Trial> trials;
  std::vector<std::vector<NamedScenario>> by_hand;
  std::vector<std::string> hands;
  for (const std::string& hand : arguments.hands) {
    scenario::ScenarioOptions world = arguments.world;
    world.hand = hand == "own" ? "" : hand;
    hands.push_back(world.hand);
    by_hand.push_back(scripted_scenarios(arguments.scenarios, world,
                                         {"door", "free_space", "excavator", "walk"}));
  }
  for (std::size_t i = 0; i < by_hand.front().size(); ++i) {
    for (std::size_t k = 0; k < hands.size(); ++k) {
      const auto& [name, scenario] = by_hand[k][i];
      trials.push_back({.name = name, .hand = hands[k], .scenario = scenario});
    }
  }
  check_output(arguments.json);
  check_writable(arguments.markdown, kMarkdown);
  print_out(fmt::format("HapticGiant {}  seeds 1 to {}\n\n", kVersion, arguments.count));
  const std::vector<experiments::SeededRun> runs =
      experiments::play_seeds(trials, 1, arguments.count, progress_of("runs"));
  return report(experiments::to_json(trials, runs), "seeds", arguments.json, "", "seeds.md",
                arguments.markdown);
}

void add_seeds(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<SeedsArguments>();
  const Command command = experiment.add_subcommand(
      "seeds", "what scenarios show over many seeds and hands: limits, faults, events, errors");
  command.add_option("scenarios", arguments->scenarios,
                     "scenario files or names; default: door, free_space, excavator, walk, or with "
                     "--device or --twin a hand that moves it through its ranges");
  command.add_option("--device", arguments->world.device, "device.yaml instead of the scenarios'");
  command.add_option("--twin", arguments->world.twin,
                     "twin.yaml, or the name of a shipped one, instead of the scenarios'");
  std::vector<std::string> hands = names_of(config::kHandPresets);
  hands.insert(hands.begin(), "own");
  command.add_option("--hands", arguments->hands, "own: that of each scenario; or presets")
      .delimiter(',')
      .one_of(hands)
      .capture_default_str();
  command.add_option("--count", arguments->count, "seeds per scenario and hand, from 1 on")
      .check(whole_number(1.0, 1e6))
      .capture_default_str();
  add_law_option(command, arguments->world.law);
  command.add_option("--json", arguments->json, "write all runs as JSON to this file");
  command.add_option("--markdown", arguments->markdown, "write the table as Markdown to this file");
  command.callback([arguments, &exit_code] { exit_code = experiment_seeds(*arguments); });
}

void add_contact(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<ContactArguments>();
  const Command command = experiment.add_subcommand(
      "contact",
      "the arm hits a person in its way: force and pressure, with and without giving way");
  command.add_option("--device", arguments->device,
                     "device.yaml of a HapticGiant instead of the reference device's");
  command.add_option("--seeds", arguments->seeds, "seeds per case, from 1 on")
      .check(whole_number(1.0, 1e3))
      .capture_default_str();
  command.add_option("--json", arguments->json, "write all figures as JSON to this file");
  command.add_option("--docs", arguments->docs,
                     "refresh the page contact.md of this folder (make experiments)");
  command.callback([arguments, &exit_code] { exit_code = experiment_contact(*arguments); });
}

void add_inertial(Command experiment, int& exit_code) {
  const auto arguments = std::make_shared<InertialArguments>();
  const Command command = experiment.add_subcommand(
      "inertial", "what inertial units on the links measure that encoders do not");
  command.add_option("scenarios", arguments->scenarios,
                     "scenario files or names; default: walk, door, or with --device or --twin a "
                     "hand that moves it through its ranges");
  command.add_option("--device", arguments->device, "device.yaml instead of the scenarios'");
  command.add_option("--twin", arguments->twin,
                     "twin.yaml, or the name of a shipped one, instead of the scenarios'");
  command.add_option("--simulation", arguments->simulation, kSimulationHelp);
  command.add_option("--seeds", arguments->seeds, "seeds per case, from 1 on")
      .check(whole_number(1.0, 1e3))
      .capture_default_str();
  command.add_option("--json", arguments->json, "write all figures as JSON to this file");
  command.add_flag(
      "--feel", arguments->feels,
      "what a hand feels where the control uses them: transparency, light bodies, wall");
  command.callback([arguments, &exit_code] { exit_code = experiment_inertial(*arguments); });
}

}  // namespace

void add_experiment(Command app, int& exit_code) {
  const auto arguments = std::make_shared<ExperimentArguments>();
  const Command command = add_offline(app, "experiment");
  command.require_subcommand(1);
  command.footer(
      "Examples:\n"
      "  hapticgiant experiment all               Figs. 6, 8 and 9 of the paper, and its path\n"
      "  hapticgiant experiment door --law both --out results\n"
      "  hapticgiant experiment free-space        force and vibration on a slow walk, what makes "
      "them\n"
      "  hapticgiant experiment stability-map --svg stability.svg\n"
      "  hapticgiant experiment impedance --json impedance.json\n"
      "  hapticgiant experiment contact           the arm hits a person in its way\n"
      "  hapticgiant experiment inertial --simulation harder\n"
      "  hapticgiant experiment impedance --device arm.yaml\n"
      "  hapticgiant experiment seeds free_space --hands own,stiff --count 16\n"
      "  hapticgiant experiment hands fr3/move_tool --force 30\n"
      "  hapticgiant experiment teleoperation --full --csv teleoperation.csv\n"
      "  hapticgiant experiment remote --count 40");
  add_paper_experiments(command, exit_code);
  const auto add = [&](const char* name, const char* text, int (*run)(const ExperimentArguments&)) {
    const Command what = command.add_subcommand(name, text);
    what.add_option("--device", arguments->device, "device.yaml instead of the reference device's");
    what.add_option("--twin", arguments->twin,
                    "free body that is held, as a file or a shipped name");
    what.add_option("--simulation", arguments->simulation, kSimulationHelp);
    what.add_option("--json", arguments->json, "write all figures as JSON to this file");
    what.callback([arguments, &exit_code, run] { exit_code = run(*arguments); });
    return what;
  };
  add("free-space", "force and vibration at the handle of a free body, and what makes them",
      experiment_free_space);
  const Command map = add(
      "stability-map", "how stiff a hand may be for how light a body, before contact is unstable",
      experiment_stability_map);
  add_campaign_options(map, arguments->played);
  map.add_option("--svg", arguments->svg, "draw the map to this file");
  add("impedance", "how far the handle gives way, by frequency and under a constant push",
      experiment_impedance);
  add_contact(command, exit_code);
  add_inertial(command, exit_code);
  add_seeds(command, exit_code);
  add_hands(command, exit_code);
  add_teleoperation(command, exit_code);
  add_walking(command, exit_code);
  add_remote_operation(command, exit_code);
}

}  // namespace hg::apps
