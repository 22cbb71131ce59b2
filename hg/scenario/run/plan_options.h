/// The options of `hapticgiant run` that make a RunPlan, in one table: names, places, rules.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/config/law_names.h"
#include "hg/config/simulation/script_schema.h"
#include "hg/scenario/run/run_plan.h"

namespace hg::scenario {

/// Rule for a number: `words` complete "must be ...".
struct NumberRule {
  const char* words;
  bool (*holds)(double value);
};

inline constexpr NumberRule kSeedRule = {
    "a whole number from 0 to 9007199254740992",
    [](double v) { return v >= 0.0 && v <= 9007199254740992.0 && v == std::floor(v); }};
inline constexpr NumberRule kStepRule = {"from 1e-5 to 2e-3",
                                         [](double v) { return v >= 1e-5 && v <= 2e-3; }};
inline constexpr NumberRule kRateRule = {"from 100 to 20000",
                                         [](double v) { return v >= 100.0 && v <= 20000.0; }};
inline constexpr NumberRule kDurationRule = {"more than 0", [](double v) { return v > 0.0; }};
inline constexpr NumberRule kPortRule = {"a whole number from 0 to 65535", [](double v) {
                                           return v >= 0.0 && v <= 65535.0 && v == std::floor(v);
                                         }};
inline constexpr NumberRule kSlowSolveRule = {"at least 1", [](double v) { return v >= 1.0; }};
inline constexpr NumberRule kPriorityRule = {"from 0 to 99",
                                             [](double v) { return v >= 0.0 && v <= 99.0; }};
inline constexpr NumberRule kCpuRule = {"at least 0", [](double v) { return v >= 0.0; }};

/// The names that a text may have.
using NameRule = std::vector<std::string>;

template <typename List>
NameRule names_in(const List& choices) {
  NameRule names;
  for (const auto& choice : choices) names.emplace_back(choice.name);
  return names;
}

/// Rule for a text without one: it must not be empty.
struct AnyText {};

/// Calls visitor(option, value, rule) for every option, with the value in `plan`.
template <class Plan, class Visitor>
void visit_options(Plan& plan, Visitor&& v) {
  auto& [world, machine, timing, records, page] = plan;
  v("scenario", world.scenario, AnyText{});
  v("device", world.device, AnyText{});
  v("twin", world.twin, AnyText{});
  v("surfaces", world.surfaces, AnyText{});
  v("user", world.user, AnyText{});
  v("rate-hz", world.rate_Hz, kRateRule);
  v("plant", world.plant, NameRule{"elastic", "ideal"});
  v("simulation", world.simulation, AnyText{});
  v("sensors", world.sensors, NameRule{"real", "ideal"});
  v("hand", world.hand, names_in(config::kHandPresets));
  v("seed", world.seed, kSeedRule);
  v("step", world.step_s, kStepRule);
  v("law", world.law, names_in(config::kLawPresets));
  v("set", world.changes, AnyText{});
  v("device-address", machine.address, AnyText{});
  v("machine", machine.machine_file, AnyText{});
  v("key-file", machine.key_file, AnyText{});
  v("despite", machine.despite, AnyText{});
  v("posture-confirmed", machine.confirmed_joints, AnyText{});
  v("without-start-test", machine.without_start_test, AnyText{});
  v("move-to-start", machine.moves_to_start, AnyText{});
  v("duration", timing.duration_s, kDurationRule);
  v("fast", timing.is_fast, AnyText{});
  v("priority", timing.priority, kPriorityRule);
  v("cpu", timing.cpu, kCpuRule);
  v("recordings", records.folder, AnyText{});
  v("recording", records.has_recording, AnyText{});
  v("flight-recorder", records.flight_recorder, NameRule{"fault", "always", "off"});
  v("slow-solve", records.slow_solve, kSlowSolveRule);
  v("lsl", records.has_lab_streams, AnyText{});
  v("viewer", page.is_served, AnyText{});
  v("bind", page.address, AnyText{});
  v("port", page.port, kPortRule);
  v("token-file", page.token_file, AnyText{});
  v("embedded-in", page.embedders, AnyText{});
  v("browser", page.opens_browser, AnyText{});
}

/// Throws SetupError naming the option that is out of range, or that another one rules out.
void check_plan(const RunPlan& plan);

/// A plan from the text of one JSON object, whose keys are the options with _ for -:
/// {"scenario": "door", "fast": true, "set": ["twin.mass_scale=2"]};
/// docs/reference/run_protocol.md. Options that are missing keep their defaults. Throws SetupError:
/// not such an object, an unknown key with the nearest one, or as check_plan().
RunPlan plan_of_request(std::string_view json);

}  // namespace hg::scenario
