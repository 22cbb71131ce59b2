// Verdicts on the cases of a campaign, and all of it as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/experiments/fault_campaign.h"

namespace hg::experiments {
namespace {

using nlohmann::ordered_json;

// Once the power is off, no software holds an axis whose brake fails: this has to be reported.
bool has_fallen(const FaultCase& result) {
  const auto is_weak = [](const faults::Injection& injection) {
    return injection.kind->part == faults::Part::kBrake &&
           injection.kind->effect == faults::Effect::kDropped;
  };
  return result.has_reported_slip && result.travel_share > 1.0 &&
         (is_weak(result.injection) || (result.other && is_weak(*result.other)));
}

bool is_within_bounds(const CampaignConfig& config, const FaultCase& result) {
  if (!(result.peak_force <= config.force_bound && result.is_complete)) return false;
  if (has_fallen(result)) return true;
  return result.worst_excess <= config.excess_bound && result.travel_share <= 1.0 &&
         result.energy <= config.energy_bound;
}

bool is_good(const CampaignConfig& config, const FaultCase& result) {
  return result.outcome != Outcome::kUnnoticed && is_within_bounds(config, result);
}

constexpr const char* kOutcomes[] = {"noticed", "harmless", "unnoticed"};
constexpr const char* kPhases[] = {"running", "pair", "stopping", "starting"};

std::string fault_text(const faults::Injection& injection) {
  return fmt::format("{} of {} by {:.4g} {} at {:.3f} s", injection.kind->name, injection.index,
                     injection.magnitude, injection.kind->unit, injection.from_s);
}

ordered_json json_of(const Campaign& campaign, const FaultCase& result) {
  const faults::Injection& injection = result.injection;
  ordered_json entry = {{"scenario", campaign.scenarios[result.scenario]},
                        {"fault", injection.kind->name},
                        {"index", injection.index},
                        {"magnitude", injection.magnitude},
                        {"at_s", injection.from_s},
                        {"in_words", fault_text(injection)},
                        {"phase", kPhases[static_cast<int>(result.phase)]},
                        {"outcome", kOutcomes[static_cast<int>(result.outcome)]}};
  if (result.outcome == Outcome::kNoticed) {
    entry["code"] = static_cast<int>(result.fault);
    entry["code_in_words"] = hg::to_string(result.fault);
    entry["stop"] = hg::to_string(result.stop);
    entry["noticed_s"] = result.noticed_s;
    if (!std::isnan(result.stopped_s)) entry["at_rest_after_s"] = result.stopped_s;
  }
  entry["peak_force_N"] = result.peak_force;
  entry["worst_excess"] = result.worst_excess;
  entry["worst_distance_m"] = result.worst_distance;
  entry["travel_share"] = result.travel_share;
  entry["energy_J"] = result.energy;
  if (result.has_reported_slip) entry["brake_slips"] = true;
  if (result.other) entry["and"] = fault_text(*result.other);
  entry["recording_complete"] = result.is_complete;
  entry["has_fallen"] = has_fallen(result);
  entry["passed"] = is_good(campaign.config, result);
  return entry;
}

ordered_json json_of(const faults::Kind& kind) {
  return {{"name", kind.name},         {"what", kind.what},          {"unit", kind.unit},
          {"has_sign", kind.has_sign}, {"least", kind.magnitude.lb}, {"most", kind.magnitude.ub}};
}

}  // namespace

bool is_passed(const Campaign& campaign) {
  return std::ranges::all_of(
      campaign.cases, [&](const FaultCase& result) { return is_good(campaign.config, result); });
}

ordered_json to_json(const Campaign& campaign) {
  const CampaignConfig& config = campaign.config;
  ordered_json json = {{"kind", "faults"},
                       {"seed", config.seed},
                       {"passed", is_passed(campaign)},
                       {"scenarios", campaign.scenarios},
                       {"excess_bound", config.excess_bound},
                       {"force_bound_N", config.force_bound},
                       {"energy_bound_J", config.energy_bound}};
  for (const faults::Kind& kind : faults::kinds()) json["kinds"].push_back(json_of(kind));
  for (const auto& [kind, why] : campaign.impossible) {
    json["impossible"].push_back({{"fault", kind->name}, {"why", why}});
  }
  for (const FaultCase& result : campaign.cases) json["cases"].push_back(json_of(campaign, result));
  return json;
}

}  // namespace hg::experiments
