/// Conditions of expected events, in words and as data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/signals/event_rule.h"

namespace hg::apps {

/// Conditions in words: "elbow x within 2 mm of its upper limit, which acts"; conditions of one
/// rule joined by "and".
std::string condition_text(const EventRule& rule, const config::Scenario& scenario);

/// Conditions as data: [{"kind": "limit", "of": "elbow x", "side": "upper"}, {"kind":
/// "force_above", "value": 10}, ...].
nlohmann::ordered_json condition_json(const EventRule& rule, const config::Scenario& scenario);

/// Name of the event in the paper: its name "t_b", or the one its sentence begins with ("t_a: the
/// locked door ..."); otherwise its name.
std::string paper_label(const EventRule& rule);

}  // namespace hg::apps
