#include "hg/controller/safety/rules.h"

namespace hg::safety {
namespace {

constexpr Rule kUnknown = {
    .threshold = "none", .reaction = Stop::kSto, .release = "the run is started again"};

constexpr bool is_ordered() noexcept {
  for (std::size_t i = 1; i < kRuleCount; ++i) {
    if (kRules[i - 1].code >= kRules[i].code) return false;
  }
  return true;
}
static_assert(is_ordered(), "one rule per fault, in the order of their numbers");

}  // namespace

const Rule& rule_of(FaultCode code) noexcept {
  const std::size_t index = rule_index(code);
  return index < kRuleCount ? kRules[index] : kUnknown;
}

}  // namespace hg::safety
