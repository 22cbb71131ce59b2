/// A whole run from its YAML file: scenario.yaml, described in docs/configuration.md.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/faults.h"
#include "hg/config/script.h"
#include "hg/config/sources.h"
#include "hg/config/twin.h"
#include "hg/environment/surface.h"
#include "hg/evaluation/events.h"
#include "hg/injection/injection.h"
#include "hg/signals/limit.h"
#include "hg/signals/timed_changes.h"
#include "hg/signals/timed_panel.h"
#include "hg/simulation/bystander.h"
#include "hg/user/person.h"

namespace hg::config {

/// Somebody who stands in the way of the simulated arm.
struct BystanderInTheWay {
  simulation::BystanderConfig config;  ///< without its frame
  std::string hit_by;                  ///< that frame: a link of the device's URDF
};

struct Scenario {
  std::string title;
  std::string description;  ///< one sentence
  double duration_s = 0.0;  ///< of the run, also where the script is longer; 0 = as the script
  Device device;
  Twin twin;
  user::PersonKind person = user::PersonKind::kNone;
  Script script;  ///< empty unless person is kScript
  LimitCatalogue limits;
  std::vector<evaluation::EventRule> events;   ///< expected, in this order
  std::vector<TimedChange> changes;            ///< of the twin, in the order of their times
  std::vector<TimedPanel> panel;               ///< of the operator, likewise
  std::vector<injection::Injection> faults;    ///< on purpose
  std::vector<environment::Surface> surfaces;  ///< that the twin meets
  std::optional<BystanderInTheWay> bystander;
  std::vector<SourceText> sources;  ///< of all files, the scenario first
  Places places;                    ///< of the keys of the YAML file
};

/// Throws SetupError with the faults of the scenario, its device, twin and script, one per line.
Scenario load_scenario(const std::filesystem::path& file);
/// The same from a recording, without the disk: `recorded` is Scenario::sources of that run.
Scenario load_scenario(std::vector<SourceText> recorded);

/// To be called after law, bounds or method of control of the device have been chosen anew: its
/// motors are limits of the scenario where the law knows them; events still name the same limits.
/// Throws SetupError where an event waits for a motor that is no limit any more.
void settle_law(Scenario& scenario);

}  // namespace hg::config
