// A campaign as JSON.

#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/experiments/fault_campaign.h"

namespace hg::experiments {
namespace {

using nlohmann::ordered_json;

constexpr const char* kOutcomes[] = {"noticed", "harmless", "unnoticed"};
constexpr const char* kPhases[] = {"running", "pair", "stopping", "starting"};

ordered_json json_of(const faults::Injection& injection) {
  return {{"fault", injection.kind->name},
          {"index", injection.index},
          {"magnitude", injection.magnitude},
          {"at_s", injection.from_s}};
}

ordered_json json_of(const Campaign& campaign, const FaultCase& result) {
  ordered_json entry = json_of(result.injection);
  entry["scenario"] = campaign.scenarios[result.scenario];
  entry["phase"] = kPhases[static_cast<int>(result.phase)];
  entry["outcome"] = kOutcomes[static_cast<int>(result.outcome)];
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
  if (result.other) entry["and"] = json_of(*result.other);
  entry["recording_complete"] = result.is_complete;
  return entry;
}

ordered_json json_of(const faults::Kind& kind) {
  return {{"name", kind.name},         {"what", kind.what},          {"unit", kind.unit},
          {"has_sign", kind.has_sign}, {"least", kind.magnitude.lb}, {"most", kind.magnitude.ub}};
}

}  // namespace

ordered_json to_json(const Campaign& campaign) {
  const CampaignConfig& config = campaign.config;
  ordered_json json = {{"kind", "faults"},
                       {"seed", config.seed},
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
