#include "hg/experiments/stability_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "hg/experiments/changes.h"
#include "hg/experiments/place.h"
#include "hg/experiments/player.h"
#include "hg/experiments/runs.h"

namespace hg::experiments {
namespace {

using nlohmann::json;

struct NamedHand {
  std::string name;
  person::HandImpedance hand;
};

std::vector<NamedHand> hands_of(const StabilityConfig& config) {
  std::vector<NamedHand> hands;
  for (const double stiffness : config.stiffness) {
    hands.push_back({fmt::format("{:g} N/m", stiffness), spring_hand(config.hand, stiffness)});
  }
  for (const auto& [name, preset] : {std::pair{"relaxed", person::HandPreset::kRelaxed},
                                     std::pair{"normal", person::HandPreset::kNormal},
                                     std::pair{"stiff", person::HandPreset::kStiff}}) {
    person::HandImpedance hand = person::hand(preset);
    hand.tremor_rms = 0.0;
    hands.push_back({name, hand});
  }
  return hands;
}

// the hand stays where the handle is and pushes once
void set_kick(const Kick& kick, config::Scenario& scenario) {
  person::Script script;
  script.start[person::kGripChannel] = 1.0;
  add_kick(kick, kick.settling, script);
  script.duration_s = kick.settling + kick.duration + kick.watched;
  play_script(scenario, script);
}

// From the first stable mass of the ladder downwards.
double stable_from(const StabilityConfig& config, const StabilityRow& row,
                   const std::function<DecayClass(double)>& verdict_at) {
  const auto first = std::ranges::find_if(
      row.outcomes, [](const KickOutcome& outcome) { return is_stable(outcome.verdict); });
  if (first == row.outcomes.end()) return kInfinity;
  const std::size_t index = first - row.outcomes.begin();
  double stable = config.mass[index];
  double unstable = index > 0 ? config.mass[index - 1] : config.least_mass;
  if (index == 0 && is_stable(verdict_at(unstable))) return unstable;
  while (stable > (1.0 + config.mass_tolerance) * unstable) {
    const double middle = std::sqrt(stable * unstable);
    (is_stable(verdict_at(middle)) ? stable : unstable) = middle;
  }
  return stable;
}

KickOutcome play(const config::Scenario& kicked, const StabilityConfig& config) {
  Player player(kicked);
  const double rate_Hz = kicked.device.model.rate_Hz;
  const double begin_s = kicked.script.script.grasp_s + config.kick.settling + config.kick.duration;
  const double last_window_s = begin_s + config.kick.watched - config.calm.window;
  KickOutcome outcome;
  std::vector<double> speed;
  bool was_lost = false;  // in the last window
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    const CycleRecord& record = player.record();
    if (record.time_s >= begin_s) speed.push_back(player.truth().twist.head<3>().norm());
    if (record.time_s > last_window_s && record.tracking.is_clamped) was_lost = true;
  }
  outcome.fault = player.record().fault.code;
  if (!player.is_running()) {
    outcome.was_lost = true;
    outcome.verdict = DecayClass::kDiverges;
    return outcome;
  }
  const auto window = std::llround(config.calm.window * rate_Hz);
  outcome.last_speed = *std::max_element(speed.end() - window, speed.end());
  outcome.was_lost = was_lost;
  outcome.verdict = was_lost ? DecayClass::kDiverges : judge_decay(speed, config.calm, rate_Hz);
  return outcome;
}

std::string control_in_words(tracking::Method method) {
  switch (method) {
    case tracking::Method::kDrives:
      return "drives that follow positions";
    case tracking::Method::kModal:
      return "modal control";
    case tracking::Method::kMotorPd:
      return "motor control";
  }
  return "";
}

json json_of(const StabilityRow& row) {
  json result = {{"hand", row.hand}, {"damping", row.damping}, {"stable_from", row.stable_from}};
  for (const KickOutcome& outcome : row.outcomes) {
    result["outcomes"].push_back({{"verdict", static_cast<int>(outcome.verdict)},
                                  {"last_speed", outcome.last_speed},
                                  {"was_lost", outcome.was_lost},
                                  {"fault", static_cast<int>(outcome.fault)}});
  }
  return result;
}

void take(const json& played, StabilityRow& row) {
  const json& limit = played["stable_from"];
  row.stable_from = limit.is_null() ? kInfinity : limit.get<double>();
  for (std::size_t k = 0; k < row.outcomes.size(); ++k) {
    const json& outcome = played["outcomes"][k];
    row.outcomes[k] = {.verdict = static_cast<DecayClass>(outcome["verdict"].get<int>()),
                       .last_speed = number_of(outcome["last_speed"]),
                       .was_lost = outcome["was_lost"],
                       .fault = static_cast<FaultCode>(outcome["fault"].get<int>())};
  }
}

}  // namespace

void add_kick(const Kick& kick, double at_s, person::Script& script) {
  constexpr double kEdge = 1e-4;  // s: less than a step of the plant
  const double each = kick.force / std::sqrt(3.0);
  for (int axis = 0; axis < 3; ++axis) {
    const int channel = person::kWrenchChannel + axis;
    script.segments.push_back(
        {.start_s = at_s, .duration_s = kEdge, .channel = channel, .value = each});
    script.segments.push_back(
        {.start_s = at_s + kick.duration, .duration_s = kEdge, .channel = channel, .value = 0.0});
  }
  std::ranges::stable_sort(script.segments, {}, &person::Segment::start_s);
}

person::HandImpedance spring_hand(const SpringHand& hand, double stiffness) {
  const auto damping = [&](double ratio, double spring) {
    return 2.0 * ratio * std::sqrt(spring * hand.mass);
  };
  person::HandImpedance result;
  result.stiffness.setConstant(stiffness);
  result.damping.setConstant(damping(hand.damping_ratio, stiffness));
  result.mass.setConstant(hand.mass);
  result.grip_stiffness = hand.grip;
  result.grip_damping = damping(hand.grip_ratio, hand.grip);
  result.force_max = kInfinity;
  result.tremor_rms = 0.0;
  return result;
}

config::Scenario kicked(const config::Scenario& scenario, const StabilityConfig& config,
                        const person::HandImpedance& hand, double mass, double damping) {
  config::Scenario kicked = scenario;
  set_free_twin(kicked, {.mass = mass, .damping = damping});
  kicked.twin.model.q_start.head<3>() = config.position;
  kicked.person = person::PersonKind::kScript;
  kicked.device.passivity.reaction = config.reaction;
  kicked.script.hand = hand;
  set_kick(config.kick, kicked);
  return kicked;
}

KickOutcome kick(const config::Scenario& scenario, const StabilityConfig& config,
                 const person::HandImpedance& hand, double mass, double damping) {
  config::Scenario played = kicked(scenario, config, hand, mass, damping);
  KickOutcome outcome = play(played, config);
  if (!is_stable(outcome.verdict) && !outcome.was_lost) {
    take_friction(played.device.model);
    if (is_stable(play(played, config).verdict)) outcome.verdict = DecayClass::kHunts;
  }
  return outcome;
}

std::size_t rows_of(const StabilityConfig& config) {
  return config.damping.size() * hands_of(config).size();
}

StabilityMap make_stability_map(const config::Scenario& given, const StabilityConfig& how,
                                Runs& runs) {
  const Place place = place_of(given.device);
  const config::Scenario scenario = at_place(given, place);
  StabilityConfig config = how;
  if (place.is_found) config.position = place.middle;
  StabilityMap map = {
      .config = config,
      .device = scenario.device.name + ", " + control_in_words(scenario.device.control.method)};
  const std::vector<NamedHand> hands = hands_of(config);
  for (const double damping : config.damping) {
    for (const NamedHand& hand : hands) {
      map.rows.push_back({.hand = hand.name,
                          .damping = damping,
                          .outcomes = std::vector<KickOutcome>(config.mass.size())});
    }
  }
  const std::vector<json> played = runs.next(map.rows.size(), [&](std::size_t i) {
    StabilityRow& row = map.rows[i];
    const person::HandImpedance& hand = hands[i % hands.size()].hand;
    for (std::size_t k = 0; k < config.mass.size(); ++k) {
      row.outcomes[k] = kick(scenario, config, hand, config.mass[k], row.damping);
    }
    row.stable_from = stable_from(config, row, [&](double mass) {
      return kick(scenario, config, hand, mass, row.damping).verdict;
    });
    return json_of(row);
  });
  for (std::size_t i = 0; i < played.size(); ++i) {
    if (!played[i].is_null()) take(played[i], map.rows[i]);
  }
  return map;
}

nlohmann::ordered_json to_json(const StabilityMap& map) {
  nlohmann::ordered_json json;
  json["experiment"] = "stability-map";
  json["device"] = map.device;
  json["mass_kg"] = map.config.mass;
  json["least_mass_kg"] = map.config.least_mass;
  json["arm_kg"] = map.config.hand.mass;
  json["kick_N"] = map.config.kick.force;
  json["kick_s"] = map.config.kick.duration;
  json["watched_s"] = map.config.kick.watched;
  json["calm_m_per_s"] = map.config.calm.calm_speed;
  json["rows"] = nlohmann::ordered_json::array();
  for (const StabilityRow& row : map.rows) {
    nlohmann::ordered_json entry;
    entry["hand"] = row.hand;
    entry["damping_Ns_per_m"] = row.damping;
    if (std::isfinite(row.stable_from)) {
      entry["stable_from_kg"] = row.stable_from;
    } else {
      entry["stable_from_kg"] = nullptr;
    }
    entry["cells"] = nlohmann::ordered_json::array();
    for (const KickOutcome& outcome : row.outcomes) {
      nlohmann::ordered_json cell;
      cell["verdict"] = to_string(outcome.verdict);
      cell["was_lost"] = outcome.was_lost;
      cell["last_speed_m_per_s"] = outcome.last_speed;
      if (outcome.fault != FaultCode::kNone) cell["fault"] = to_string(outcome.fault);
      entry["cells"].push_back(cell);
    }
    json["rows"].push_back(entry);
  }
  return json;
}

}  // namespace hg::experiments
