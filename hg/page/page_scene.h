/// Scene and choices of a scenario for a page, fixed during a run.
#pragma once

#include <optional>
#include <vector>

#include "hg/analysis/fault_figures.h"
#include "hg/config/simulation/scenario.h"
#include "hg/config/twin_form.h"
#include "hg/scenario/options.h"
#include "hg/viewer_server/scene.h"
#include "hg/viewer_server/view.h"

namespace hg::page {

/// Scene of a run or of a recording: chains, limits, box and surroundings.
viewer_server::Scene page_scene(const config::Scenario& scenario);

/// Choices of scenarios, twins, devices, surfaces, laws and people: those shipped with the program,
/// those in the working directory, and those of `options` and `given`, with which the program was
/// started. Names are as in scenario::ScenarioOptions; empty ones stand for the scenario's own.
viewer_server::Choices page_choices(const scenario::ScenarioOptions& options,
                                    const scenario::ScenarioOptions& given);

/// True when `name` is one of `choices`.
bool is_choice(const std::vector<viewer_server::Choice>& choices, const std::string& name);

std::vector<viewer_server::Setting> page_settings(const std::vector<config::FormField>& form);

/// The other side of a teleoperation at `sample`; empty = there is none.
std::optional<viewer_server::TeleoperationView> teleoperation_view(const config::Scenario& scenario,
                                                                   const Sample& sample);

/// Text on what stops the device at `sample`.
viewer_server::SafetyView safety_view(const Sample& sample, const analysis::Names& names);

}  // namespace hg::page
