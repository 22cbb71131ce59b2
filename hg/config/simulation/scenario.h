/// A whole run from its YAML file: scenario.yaml, described in docs/reference/configuration.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/simulation/script.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/sources.h"
#include "hg/config/twin.h"
#include "hg/controller/rendering/surfaces/surface.h"
#include "hg/signals/event_rule.h"
#include "hg/signals/limit.h"
#include "hg/signals/timed_changes.h"
#include "hg/signals/timed_panel.h"
#include "hg/simulator/faults/injection.h"
#include "hg/simulator/moving_base.h"
#include "hg/simulator/person/person.h"
#include "hg/simulator/plant/bystander.h"
#include "hg/teleoperation/teleoperation.h"

namespace hg::config {

/// A bystander in the way of the simulated arm.
struct BystanderInTheWay {
  simulator::BystanderConfig config;  ///< bystander, without its frame
  std::string hit_by;                 ///< frame that hits: a link of the device's URDF
};

struct Scenario {
  std::string title;
  std::string description;  ///< description in one sentence
  /// Duration of the run, even if the script is longer; 0 = as the script
  double duration_s = 0.0;
  SimulatedDeviceConfig device;
  Twin twin;
  person::PersonKind person = person::PersonKind::kNone;
  Script script;  ///< script, empty unless person is kScript
  LimitCatalogue limits;
  std::vector<EventRule> events;            ///< expected events, in this order
  std::vector<TimedChange> changes;         ///< changes of the twin, in the order of their times
  std::vector<TimedPanel> panel;            ///< inputs of the operator, in the order of their times
  std::vector<faults::Injection> faults;    ///< injected faults
  std::vector<surfaces::Surface> surfaces;  ///< surfaces that the twin meets
  std::optional<BystanderInTheWay> bystander;
  std::optional<teleoperation::TeleoperationConfig> teleoperation;  ///< with a remote machine
  std::optional<simulator::MovingBaseConfig> twin_motion;           ///< of the twin's root link
  std::vector<SourceText> sources;  ///< source texts of all files, the scenario first
  Places places;                    ///< places of the keys of the YAML file
};

/// Loads a scenario. Throws SetupError with the faults of the scenario, its device, twin and
/// script, one per line.
Scenario load_scenario(const std::filesystem::path& file);
/// Loads a scenario from a recording, without the disk: `recorded` is Scenario::sources of that
/// run.
Scenario load_scenario(std::vector<SourceText> recorded);

/// Loads a scenario from the files that `reader` has.
Scenario load_scenario(const std::filesystem::path& file, SourceReader& reader);

/// Throws SetupError where the end effector of the twin, or a collision sphere before a stop,
/// starts inside of a surface.
void check_start_outside(const std::vector<surfaces::Surface>& surfaces,
                         const rendering::TwinModel& twin);

/// Updates the limits; call it after changing law, bounds or control method of the device. Its
/// motors are limits of the scenario if the law models them; events still name the same limits.
/// Throws SetupError where an event waits for a motor that is no limit any more.
void settle_law(Scenario& scenario);

}  // namespace hg::config
