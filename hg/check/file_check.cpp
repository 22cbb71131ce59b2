#include "hg/check/file_check.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <list>
#include <optional>
#include <tuple>
#include <utility>

#include "hg/check/device_inspection.h"
#include "hg/check/light_twin.h"
#include "hg/check/machine_inspection.h"
#include "hg/check/scenario_inspection.h"
#include "hg/check/stiffness.h"
#include "hg/check/twin_bodies.h"
#include "hg/check/twin_inspection.h"
#include "hg/check/unit_inspection.h"
#include "hg/config/bus/machine_file.h"
#include "hg/config/file_kind.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/script.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/tool.h"
#include "hg/config/twin.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/model/urdf.h"
#include "hg/workspace/survey.h"

namespace hg::check {
namespace {

using config::FileKind;

// Everything that could be loaded, and what was found on the way.
struct Check {
  CheckReport report = {};
  std::list<config::SimulatedDeviceConfig> devices;
  std::list<config::Twin> twins;
  std::list<config::Scenario> scenarios;
  std::vector<std::string> scripts;
  std::vector<std::string> machines;
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
    add(findings_of(error, file), check);
    return false;
  }
}

// Numbers of files that no device or twin brings along.
void inspect_units_of(const std::vector<config::SourceText>& sources, Check& check) {
  const config::Places places;
  Collector out(sources, places);
  inspect_units(sources, {}, out);
  add(std::move(out.findings), check);
}

// A URDF alone: nothing says which of its parts are used, so all count.
void load_urdf(const std::string& file, Check& check) {
  check.report.files.push_back({file, "URDF"});
  const auto add_fault = [&](const std::optional<InputFault>& fault, Severity severity) {
    if (!fault) return;
    Finding finding = finding_of(*fault, file);
    finding.severity = severity;
    check.report.findings.push_back(std::move(finding));
  };
  try_to(file, check, [&] {
    const model::Urdf urdf = model::read_urdf_file(file);
    for (const model::UrdfJoint& joint : urdf.joints) add_fault(joint.fault, Severity::kFault);
    for (const model::UrdfLink& link : urdf.links) {
      if (model::is_point_mass(link)) continue;
      add_fault(link.inertial_fault, Severity::kWarning);  // it may stand still
    }
    const std::vector<config::SourceText> sources = {{file, read_file(file)}};
    const config::Places places;
    Collector out(sources, places);
    inspect_bodies(sources, {}, out);
    add(std::move(out.findings), check);
    inspect_units_of(sources, check);
  });
}

void load(const std::string& file, Check& check) {
  if (std::filesystem::path(file).extension() == ".urdf") return load_urdf(file, check);
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
        inspect_units_of(reader.texts(), check);
        break;
      }
      case FileKind::kSimulation: {
        config::SourceReader reader;
        config::load_simulation(file, reader, {});
        inspect_units_of(reader.texts(), check);
        break;
      }
      case FileKind::kMachine: {
        config::SourceReader reader;
        config::load_machine(file, reader, {});
        check.machines.push_back(file);
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
    for (Finding& finding : fewest) {
      if (finding.item == "frame") finding.fix = "check the script together with its twin";
    }
    add(fewest, check);
  }
}

// A machine beside the device is its own, and one elsewhere where it has its joints.
void check_machines(const config::DeviceConfig& device, Check& check) {
  const auto folder = std::filesystem::path(device.sources.front().name).parent_path();
  for (const std::string& machine : check.machines) {
    const auto inspect = [&] { add(inspect_machine(machine, device), check); };
    if (std::filesystem::path(machine).parent_path() == folder) {
      try_to(machine, check, inspect);
      continue;
    }
    try {
      inspect();
    } catch (const SetupError&) {  // a machine of another device
    }
  }
}

void check_devices(Check& check) {
  const auto inspect = [&](const config::DeviceConfig& device, bool has_datasheet) {
    const workspace::Survey found = workspace::survey(device);
    add(check::inspect(device, found), check);
    if (has_datasheet) check.report.datasheets.push_back(make_datasheet(device, found));
    if (has_datasheet) check_machines(device, check);
  };
  for (const config::DeviceConfig& device : check.devices) inspect(device, true);
  for (const config::Scenario& scenario : check.scenarios) inspect(scenario.device, false);
}

void check_twins(Check& check) {
  constexpr double kUsualPeriod = 1e-3;  // s, where no device is given
  const double dt = check.devices.empty() ? kUsualPeriod : check.devices.front().model.dt();
  for (const config::Twin& twin : check.twins) {
    add(inspect(twin, dt), check);
    for (const config::SimulatedDeviceConfig& device : check.devices) {
      add(inspect(device, twin), check);
    }
  }
  for (const config::Scenario& scenario : check.scenarios) {
    add(inspect(scenario.twin, scenario.device.model.dt()), check);
    add(inspect(scenario.device, scenario.twin, scenario.surfaces), check);
    add(inspect_surfaces(scenario), check);
    add(inspect_light_twin(scenario), check);
    add(inspect_spheres(scenario), check);
  }
}

auto key(const Finding& finding) {
  return std::tie(finding.file, finding.place.line, finding.place.column, finding.item,
                  finding.what);
}

// orders by file and line; duplicates are merged
void sort_and_merge(Findings& findings) {
  std::ranges::stable_sort(findings,
                           [](const Finding& a, const Finding& b) { return key(a) < key(b); });
  const auto rest = std::ranges::unique(
      findings, [](const Finding& a, const Finding& b) { return key(a) == key(b); });
  findings.erase(rest.begin(), rest.end());
}

}  // namespace

CheckReport check_files(const std::vector<std::string>& files) {
  Check check;
  for (const std::string& file : files) load(file, check);
  check_scripts(check);
  check_devices(check);
  check_twins(check);
  sort_and_merge(check.report.findings);
  if (!check.devices.empty()) {
    check.report.first_device = check.devices.front();
  } else if (!check.scenarios.empty()) {
    check.report.first_device = check.scenarios.front().device;
  }
  return std::move(check.report);
}

}  // namespace hg::check
