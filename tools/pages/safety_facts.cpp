#include "tools/pages/safety_facts.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "hg/controller/safety/rules.h"
#include "hg/controller/safety/transitions.h"

namespace hg::pages {

using namespace safety;

nlohmann::ordered_json safety_facts() {
  nlohmann::ordered_json facts;
  for (std::size_t s = 0; s < kStateCount; ++s) {
    facts["states"].push_back(to_string(static_cast<SafetyState>(s)));
  }
  for (std::size_t e = 0; e < kEventCount; ++e) {
    const auto event = static_cast<SafetyEvent>(e);
    nlohmann::ordered_json row = {to_string(event)};
    for (std::size_t s = 0; s < kStateCount; ++s) {
      const auto state = static_cast<SafetyState>(s);
      const Transition to = transition(state, event);
      row.push_back(to.refusal != Refusal::kNone ? "refused"
                    : to.next == state           ? "-"
                                                 : to_string(to.next));
    }
    facts["transitions"].push_back(row);
  }
  for (const Rule& rule : kRules) {
    const FaultWords& words = fault_words(rule.code);
    facts["rules"].push_back({{"number", static_cast<int>(rule.code)},
                              {"name", words.name},
                              {"meaning", words.meaning},
                              {"threshold", rule.threshold},
                              {"warn_from", rule.warn_from},
                              {"samples", rule.debounce.samples},
                              {"seconds", rule.debounce.seconds},
                              {"reaction", to_string(rule.reaction)},
                              {"release", rule.release}});
  }
  return facts;
}

}  // namespace hg::pages
