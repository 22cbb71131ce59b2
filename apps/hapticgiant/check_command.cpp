#include "apps/hapticgiant/check_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/hapticgiant/check_report.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "hg/commissioning/checks/capability_map.h"
#include "hg/commissioning/checks/datasheet.h"
#include "hg/commissioning/checks/device_inspection.h"
#include "hg/commissioning/checks/scenario_inspection.h"
#include "hg/commissioning/checks/stiffness.h"
#include "hg/commissioning/checks/twin_inspection.h"
#include "hg/config/device.h"
#include "hg/config/file_kind.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/script.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/tool.h"
#include "hg/config/twin.h"
#include "hg/core/error.h"
#include "hg/core/scratch_folder.h"

namespace hg::apps {
namespace {

using checks::Findings;
using config::FileKind;

// Everything that could be loaded, and what was found on the way.
struct Check {
  CheckReport report;
  std::list<config::SimulatedDevice> devices;
  std::list<config::Twin> twins;
  std::list<config::Scenario> scenarios;
  std::vector<std::string> scripts;
};

void add(Findings findings, Check& check) {
  Findings& all = check.report.findings;
  all.insert(all.end(), findings.begin(), findings.end());
}

// Runs `load`; what it refuses becomes faults.
bool try_to(const std::string& file, Check& check, const std::function<void()>& load) {
  try {
    load();
    return true;
  } catch (const SetupError& error) {
    add(checks::findings_of_message(error.what(), file), check);
    return false;
  }
}

void load(const std::string& file, Check& check) {
  FileKind kind = FileKind::kDevice;
  const bool is_known = try_to(file, check, [&] {
    config::SourceReader reader;
    kind = config::kind_of(file, reader);
  });
  check.report.files.push_back({file, is_known ? std::string(to_string(kind)) : "unknown"});
  if (!is_known) return;
  try_to(file, check, [&] {
    switch (kind) {
      case FileKind::kDevice:
        check.devices.push_back(config::load_simulated_device(file));
        break;
      case FileKind::kTwin:
        check.twins.push_back(config::load_twin(file));
        break;
      case FileKind::kScenario:
        check.scenarios.push_back(config::load_scenario(file));
        break;
      case FileKind::kScript:
        check.scripts.push_back(file);
        break;
      case FileKind::kTool: {
        config::SourceReader reader;
        config::load_tool(file, reader);
        break;
      }
      case FileKind::kSimulation: {
        config::SourceReader reader;
        config::load_simulation(file, reader, {});
        break;
      }
    }
  });
}

// What is wrong with a script if it is made for this twin.
Findings script_findings(const std::string& file, const rendering::TwinModel& twin) {
  Check check;
  try_to(file, check, [&] { config::load_script(file, twin); });
  return check.report.findings;
}

// A script is made for one twin: for one of those at hand, or for a body that moves freely.
void check_scripts(Check& check) {
  for (const std::string& file : check.scripts) {
    Findings fewest =
        script_findings(file, {.chain = model::ChainModel::free_body({}), .q_start = {}});
    const auto try_twin = [&](const config::Twin& twin) {
      const Findings findings = script_findings(file, twin.model);
      if (findings.size() < fewest.size()) fewest = findings;
    };
    for (const config::Twin& twin : check.twins) try_twin(twin);
    for (const config::Scenario& scenario : check.scenarios) try_twin(scenario.twin);
    for (checks::Finding& finding : fewest) {
      if (finding.item == "frame") finding.fix = "check the script together with its twin";
    }
    add(fewest, check);
  }
}

void check_devices(Check& check) {
  const auto inspect = [&](const config::Device& device, bool has_datasheet) {
    const checks::Survey survey = checks::survey(device);
    add(checks::inspect(device, survey), check);
    if (has_datasheet) {
      check.report.datasheets.push_back(checks::make_datasheet(device, survey));
    }
  };
  for (const config::Device& device : check.devices) inspect(device, true);
  for (const config::Scenario& scenario : check.scenarios) inspect(scenario.device, false);
}

void draw_map(const std::string& file, const Check& check) {
  if (check.devices.empty() && check.scenarios.empty()) {
    throw SetupError("--map: needs a device that could be read");
  }
  const config::Device& device =
      check.devices.empty() ? check.scenarios.front().device : check.devices.front();
  check_report_program();
  const ScratchFolder scratch;
  write_output(file, report_text(scratch.path(), checks::capability_map(device), "map.svg"));
}

void check_twins(Check& check) {
  constexpr double kUsualPeriod = 1e-3;  // s, where no device is given
  const double dt = check.devices.empty() ? kUsualPeriod : check.devices.front().model.dt();
  for (const config::Twin& twin : check.twins) {
    add(checks::inspect(twin, dt), check);
    for (const config::SimulatedDevice& device : check.devices) {
      add(checks::inspect(device, twin), check);
    }
  }
  for (const config::Scenario& scenario : check.scenarios) {
    add(checks::inspect(scenario.twin, scenario.device.model.dt()), check);
    add(checks::inspect(scenario.device, scenario.twin), check);
    add(checks::inspect_surfaces(scenario), check);
  }
}

}  // namespace

int run_check(const CheckArguments& arguments) {
  check_writable(arguments.json, kJson);
  check_writable(arguments.map, kSvg);
  Check check;
  for (const std::string& file : arguments.files) load(file, check);
  check_scripts(check);
  check_devices(check);
  check_twins(check);
  sort_and_merge(check.report);
  print(check.report);
  if (!arguments.json.empty()) write_output(arguments.json, to_json(check.report));
  if (!arguments.map.empty()) draw_map(arguments.map, check);
  return count(check.report, checks::Severity::kFault) > 0 ? 2 : 0;
}

void add_check(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand(
      "check",
      "What is wrong with configuration files, and how to mend it; datasheet of a device.");
  command->footer(
      "Examples:\n"
      "  hapticgiant check models/scenarios/door.yaml\n"
      "  hapticgiant check my_device.yaml my_twin.yaml   each, and whether they fit together\n"
      "  hapticgiant check models/haptic_giant/device.yaml --map capability.svg");
  command
      ->add_option("files", arguments->files,
                   "device, twin, scenario, tool or script files; the kind is told from their keys")
      ->required();
  command->add_option("--json", arguments->json,
                      "write findings and datasheets as JSON to this file");
  command->add_option("--map", arguments->map,
                      "draw the force over the workspace of the first device to this SVG file");
  command->callback([arguments, &exit_code] { exit_code = run_check(*arguments); });
}

}  // namespace hg::apps
