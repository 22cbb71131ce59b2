// Report of a campaign, as text and JSON.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "hg/studies/fault_campaign.h"

namespace hg::studies {
namespace {

// Once the power is off, no software holds an axis whose brake fails: this has to be reported.
bool has_fallen(const FaultCase& result) {
  const auto is_weak = [](const faults::Injection& injection) {
    return injection.kind->part == faults::Part::kBrake &&
           injection.kind->effect == faults::Effect::kDropped;
  };
  return result.is_told_to_fall && result.travel_share > 1.0 &&
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

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kNoticed:
      return "noticed";
    case Outcome::kHarmless:
      return "harmless";
    case Outcome::kUnnoticed:
      return "unnoticed";
  }
  return "unknown";
}

std::string_view to_string(Phase phase) {
  switch (phase) {
    case Phase::kRunning:
      return "running";
    case Phase::kPair:
      return "pair";
    case Phase::kStopping:
      return "stopping";
    case Phase::kStarting:
      return "starting";
  }
  return "unknown";
}

std::string fault_text(const faults::Injection& injection) {
  return fmt::format("{} of {} by {:.4g} {} at {:.3f} s", injection.kind->name, injection.index,
                     injection.magnitude, injection.kind->unit, injection.from_s);
}

std::string case_text(const Campaign& campaign, std::size_t index) {
  const FaultCase& result = campaign.cases[index];
  return fmt::format(
      "case {}: {}{} in {}, {}: {} {}, {:.0f} N, {:.3f} outside, {:.3f} m, way {:.0f} %, {:.1f} "
      "J{}\n",
      index, fault_text(result.injection), result.other ? " and " + fault_text(*result.other) : "",
      campaign.scenarios[result.scenario], to_string(result.phase), to_string(result.outcome),
      static_cast<int>(result.fault), result.peak_force, result.worst_excess, result.worst_distance,
      100.0 * result.travel_share, result.energy,
      result.is_complete ? "" : ", its recording has lost cycles");
}

// Results of all cases of one kind.
struct Row {
  int cases = 0, noticed = 0, harmless = 0, unnoticed = 0;
  std::vector<double> noticed_ms, stopped_ms;
  std::map<FaultCode, int> faults;
  std::map<Stop, int> stops;
  double peak_force = 0.0, worst_excess = 0.0, travel_share = 0.0, energy = 0.0;
};

Row row_of(const Campaign& campaign, const faults::Kind& kind) {
  Row row;
  for (const FaultCase& result : campaign.cases) {
    if (result.injection.kind != &kind) continue;
    ++row.cases;
    row.peak_force = std::max(row.peak_force, result.peak_force);
    row.worst_excess = std::max(row.worst_excess, result.worst_excess);
    row.travel_share = std::max(row.travel_share, result.travel_share);
    row.energy = std::max(row.energy, result.energy);
    if (result.outcome == Outcome::kHarmless) ++row.harmless;
    if (result.outcome == Outcome::kUnnoticed) ++row.unnoticed;
    if (result.outcome != Outcome::kNoticed) continue;
    ++row.noticed;
    ++row.faults[result.fault];
    ++row.stops[result.stop];
    if (result.other) continue;  // it may be the other that stopped the device
    row.noticed_ms.push_back(1e3 * result.noticed_s);
    if (!std::isnan(result.stopped_s)) row.stopped_ms.push_back(1e3 * result.stopped_s);
  }
  std::ranges::sort(row.noticed_ms);
  std::ranges::sort(row.stopped_ms);
  return row;
}

template <typename Key>
Key most_frequent(const std::map<Key, int>& counts) {
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
  return most == counts.end() ? Key{} : most->first;
}

std::string range_text(const std::vector<double>& sorted) {
  if (sorted.empty()) return "-";
  return fmt::format("{:.0f} / {:.0f}", sorted[sorted.size() / 2], sorted.back());
}

using Cells = std::array<std::string, 13>;

const Cells kHead = {"fault",      "cases",      "noticed",   "harmless", "unnoticed",
                     "noticed ms", "at rest ms", "stop",      "N",        "outside",
                     "way %",      "J",          "most often"};

Cells cells_of(const faults::Kind& kind, const Row& row) {
  const FaultCode fault = most_frequent(row.faults);
  return {std::string(kind.name),
          std::to_string(row.cases),
          std::to_string(row.noticed),
          std::to_string(row.harmless),
          std::to_string(row.unnoticed),
          range_text(row.noticed_ms),
          range_text(row.stopped_ms),
          std::string(hg::to_string(most_frequent(row.stops))),
          fmt::format("{:.0f}", row.peak_force),
          fmt::format("{:.4f}", row.worst_excess),
          fmt::format("{:.0f}", 100.0 * row.travel_share),
          fmt::format("{:.1f}", row.energy),
          row.noticed == 0 ? ""
          : fault == FaultCode::kNone
              ? "no fault"
              : fmt::format("{} {}", static_cast<int>(fault), hg::to_string(fault))};
}

std::vector<Cells> table_of(const Campaign& campaign) {
  std::vector<Cells> table;
  for (const faults::Kind& kind : faults::kinds()) {
    const Row row = row_of(campaign, kind);
    if (row.cases > 0) table.push_back(cells_of(kind, row));
  }
  return table;
}

std::string list_of_kinds() {
  std::string text = "| fault | what goes wrong | magnitude |\n| --- | --- | --- |\n";
  for (const faults::Kind& kind : faults::kinds()) {
    const std::string magnitude =
        kind.unit.empty() ? "-"
                          : fmt::format("{}{:g} .. {:g} {}", kind.has_sign ? "+- " : "",
                                        kind.magnitude.lb, kind.magnitude.ub, kind.unit);
    text += fmt::format("| {} | {} | {} |\n", kind.name, kind.what, magnitude);
  }
  return text;
}

std::string verdict_of(const Campaign& campaign) {
  const auto bad = std::ranges::count_if(
      campaign.cases, [&](const FaultCase& result) { return !is_good(campaign.config, result); });
  const auto fallen = std::ranges::count_if(campaign.cases, has_fallen);
  const std::string besides =
      fallen == 0
          ? ""
          : fmt::format(
                "; {} of {} cases fell because a brake did not hold, and were told so (323): "
                "no software holds such an axis",
                fallen, campaign.cases.size());
  return fmt::format(
      "{} of {} cases went unnoticed, took the device farther than {:g} rad or m outside a limit "
      "or "
      "an axis farther than its stopping distance, pushed the person with more than {:g} N, gave "
      "more than {:g} J in a stop, or are missing from their recording{}",
      bad, campaign.cases.size(), campaign.config.excess_bound, campaign.config.force_bound,
      campaign.config.energy_bound, besides);
}

}  // namespace

bool is_passed(const Campaign& campaign) {
  return std::ranges::all_of(
      campaign.cases, [&](const FaultCase& result) { return is_good(campaign.config, result); });
}

std::string to_text(const Campaign& campaign) {
  std::string text;
  const auto add = [&](const Cells& c) {
    text += fmt::format(
        "{:24} {:>5} {:>7} {:>8} {:>9}  {:>14} {:>14}  {:>5} {:>6} {:>8} {:>6} {:>6}  {}\n", c[0],
        c[1], c[2], c[3], c[4], c[5], c[6], c[7], c[8], c[9], c[10], c[11], c[12]);
  };
  add(kHead);
  for (const Cells& cells : table_of(campaign)) add(cells);
  text +=
      "\nnoticed and at rest: median / longest of faults alone, in ms after they began and after "
      "they were "
      "noticed; N: largest force of the person;\noutside: furthest true position outside a "
      "limit of the device, rad or m; way: longest that nobody asked for, of the stopping "
      "distance; "
      "J: largest energy\ngiven to the person in a stop\n\n";
  for (std::size_t i = 0; i < campaign.cases.size(); ++i) {
    if (!is_good(campaign.config, campaign.cases[i])) text += case_text(campaign, i);
  }
  return text + verdict_of(campaign) + "\n";
}

std::string to_markdown(const Campaign& campaign) {
  const auto line = [](const auto& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
  };
  std::string text = line(kHead);
  Cells rule;
  rule.fill("---");
  text += line(rule);
  for (const Cells& cells : table_of(campaign)) text += line(cells);
  return fmt::format(
      "# Results of {} cases with injected faults\n\n"
      "Written by `hapticgiant faults --markdown`; "
      "[safety.md](../concepts/safety.md#injected-faults) "
      "explains the columns.\n"
      "Seed {}; {}: {}.\n\n{}\n"
      "## The faults\n\n"
      "For `faults` of a scenario and the drawn sizes of this campaign; a torque of the force "
      "sensor is in Nm and gets a\ntenth.\n\n{}",
      campaign.cases.size(), campaign.config.seed, fmt::join(campaign.scenarios, ", "),
      verdict_of(campaign), text, list_of_kinds());
}

nlohmann::ordered_json to_json(const Campaign& campaign) {
  nlohmann::ordered_json json = {{"seed", campaign.config.seed}, {"passed", is_passed(campaign)}};
  for (const FaultCase& result : campaign.cases) {
    const faults::Injection& injection = result.injection;
    nlohmann::ordered_json entry = {{"scenario", campaign.scenarios[result.scenario]},
                                    {"fault", injection.kind->name},
                                    {"index", injection.index},
                                    {"magnitude", injection.magnitude},
                                    {"at_s", injection.from_s},
                                    {"phase", to_string(result.phase)},
                                    {"outcome", to_string(result.outcome)}};
    if (result.outcome == Outcome::kNoticed) {
      entry["code"] = static_cast<int>(result.fault);
      entry["stop"] = hg::to_string(result.stop);
      entry["noticed_s"] = result.noticed_s;
      if (!std::isnan(result.stopped_s)) entry["at_rest_after_s"] = result.stopped_s;
    }
    entry["peak_force_N"] = result.peak_force;
    entry["worst_excess"] = result.worst_excess;
    entry["worst_distance_m"] = result.worst_distance;
    entry["travel_share"] = result.travel_share;
    entry["energy_J"] = result.energy;
    if (result.is_told_to_fall) entry["brake_slips"] = true;
    if (result.other) entry["and"] = fault_text(*result.other);
    entry["recording_complete"] = result.is_complete;
    json["cases"].push_back(std::move(entry));
  }
  return json;
}

}  // namespace hg::studies
