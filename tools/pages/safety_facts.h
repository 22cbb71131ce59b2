/// Rules, states and transitions of rules.h and transitions.h, for docs/concepts/safety.md.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hg::pages {

/// states; transitions: per event its name and, by state, the next state, "refused" or "-"; rules.
nlohmann::ordered_json safety_facts();

}  // namespace hg::pages
