#include "apps/hapticgiant/experiment_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/docs_page.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/progress.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "hg/assembly/assembly.h"
#include "hg/config/scenario.h"
#include "hg/core/error.h"
#include "hg/experiments/contact.h"
#include "hg/experiments/free_space.h"
#include "hg/experiments/impedance.h"
#include "hg/experiments/inertial.h"
#include "hg/experiments/seed_ranges.h"
#include "hg/experiments/stability_map.h"
#include "hg/experiments/workers.h"
#include "hg/haptify/hand_figures.h"

namespace hg::apps {
namespace {

// With another device or simulation where they are given.
config::Scenario walk_scenario(const std::string& device = "", const std::string& simulation = "") {
  return make_scenario({.scenario = "walk", .device = device, .simulation = simulation});
}

config::Scenario scripted_scenario(const RunArguments& run) {
  config::Scenario scenario = make_scenario(run);
  if (assembly::planned_duration_s(scenario) == 0.0) {
    throw SetupError(run.world.scenario + ": no script plays it, so that it has no end");
  }
  return scenario;
}

std::string name_of(const std::string& scenario) {
  return std::filesystem::path(scenario).stem().string();
}

void begin(const ExperimentArguments& arguments, const std::string& what) {
  check_writable(arguments.json, kJson);
  check_writable(arguments.svg, kSvg);
  print_out(fmt::format("HapticGiant {}  {}\n", kVersion, what));
}

// By encoders alone, and with units on all links that the control uses.
std::vector<std::pair<std::string, haptify::HandFigures>> felt_with_units(
    const config::Scenario& walk) {
  config::Scenario with_units = walk;
  estimation::InertialUnitsConfig& units = with_units.device.estimation.units;
  units.frames = experiments::frames_of(walk.device, experiments::unit_sets(walk.device)[0].links);
  experiments::learn_mounting(with_units);
  units.feeds_back = true;
  const std::vector<const config::Scenario*> scenarios = {&walk, &with_units};
  std::vector<std::pair<std::string, haptify::HandFigures>> felt = {{"encoders alone", {}},
                                                                    {"encoders and units", {}}};
  experiments::do_all(
      scenarios.size(),
      [&](std::size_t i) { felt[i].second = haptify::measure_hand_figures(*scenarios[i]); },
      progress_of("hands"));
  return felt;
}

}  // namespace

int experiment_free_space(const ExperimentArguments& arguments) {
  begin(arguments, "Free space: a hand walks a free body round a circle of 0.7 m at 0.25 m/s\n");
  const auto runs = experiments::measure_free_space(walk_scenario(), progress_of("walks"));
  print_out(experiments::to_text(runs));
  write_json(arguments.json, experiments::to_json(runs));
  return 0;
}

int experiment_stability_map(const ExperimentArguments& arguments) {
  const experiments::StabilityConfig config;
  begin(arguments,
        fmt::format("Stability: a kick of {:g} N for {:g} ms on a free body held by a hand\n\n",
                    config.kick.force, 1e3 * config.kick.duration));
  const experiments::StabilityMap map = experiments::make_stability_map(
      walk_scenario(arguments.device, arguments.simulation), config, progress_of("kicks"));
  print_out(experiments::to_text(map));
  write_json(arguments.json, experiments::to_json(map));
  if (!arguments.svg.empty()) write_output(arguments.svg, experiments::to_svg(map));
  return 0;
}

int experiment_impedance(const ExperimentArguments& arguments) {
  const experiments::ImpedanceConfig config;
  begin(arguments,
        fmt::format("Impedance at the handle, pushed to and fro with {:g} N\n\n", config.force));
  const experiments::ImpedanceReport report =
      experiments::measure_impedance(walk_scenario(), config, progress_of("pushes"));
  print_out(experiments::to_text(report));
  write_json(arguments.json, experiments::to_json(report));
  return 0;
}

int experiment_contact(const ContactArguments& arguments) {
  experiments::ContactConfig config;
  config.seeds = arguments.seeds;
  check_writable(arguments.json, kJson);
  print_out(fmt::format("HapticGiant {}  Contact: the arm hits somebody in its way\n\n", kVersion));
  const experiments::ContactMeasures report =
      experiments::measure_contact(walk_scenario(), config, progress_of("cases"));
  print_out(experiments::to_text(report));
  write_json(arguments.json, experiments::to_json(report));
  if (!arguments.docs.empty()) {
    refresh_page(arguments.docs, "contact", experiments::to_markdown(report), {});
  }
  return 0;
}

int experiment_inertial(const InertialArguments& arguments) {
  std::vector<config::Scenario> scenarios;
  std::vector<std::string> names;
  for (const std::string& scenario : arguments.scenarios) {
    RunArguments run;
    run.world.scenario = scenario;
    run.world.simulation = arguments.simulation;
    scenarios.push_back(scripted_scenario(run));
    names.push_back(name_of(scenario));
  }
  check_writable(arguments.json, kJson);
  print_out(fmt::format(
      "HapticGiant {}  Inertial units on links: rms errors, median of seeds 1 to {}\n\n", kVersion,
      arguments.seeds));
  const std::vector<experiments::InertialRun> runs =
      experiments::measure_inertial(scenarios, names, arguments.seeds, progress_of("runs"));
  print_out(experiments::to_text(runs));
  write_json(arguments.json, experiments::to_json(runs));
  if (arguments.feels) {
    print_out("\n" + haptify::to_text(felt_with_units(walk_scenario("", arguments.simulation))));
  }
  return 0;
}

int experiment_seeds(const SeedsArguments& arguments) {
  std::vector<experiments::Trial> trials;
  for (const std::string& scenario : arguments.scenarios) {
    for (const std::string& hand : arguments.hands) {
      RunArguments run;
      run.world.scenario = scenario;
      run.world.hand = hand == "own" ? "" : hand;
      run.law = arguments.law;
      run.bounds = arguments.bounds;
      run.gantry = arguments.gantry;
      run.braking = arguments.braking;
      trials.push_back(
          {.name = name_of(scenario), .hand = run.world.hand, .scenario = scripted_scenario(run)});
    }
  }
  check_writable(arguments.json, kJson);
  check_writable(arguments.markdown, kMarkdown);
  print_out(fmt::format("HapticGiant {}  seeds {} to {}\n\n", kVersion, arguments.first,
                        arguments.first + static_cast<std::uint64_t>(arguments.count) - 1));
  const std::vector<experiments::SeededRun> runs =
      experiments::play_seeds(trials, arguments.first, arguments.count, progress_of("runs"));
  print_out(experiments::to_text(trials, runs));
  write_json(arguments.json, experiments::to_json(trials, runs));
  if (!arguments.markdown.empty()) {
    write_output(arguments.markdown, experiments::to_markdown(trials, runs));
  }
  return experiments::have_all_held(runs) ? 0 : 1;
}

}  // namespace hg::apps
