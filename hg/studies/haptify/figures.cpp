#include "hg/studies/haptify/figures.h"

#include <fmt/format.h>

#include <cmath>

namespace hg::haptify {

std::string to_text(const Interval& goal) {
  if (!goal.bounded()) return "-";
  if (!std::isfinite(goal.ub)) return fmt::format(">= {:g}", goal.lb);
  if (!std::isfinite(goal.lb)) return fmt::format("<= {:g}", goal.ub);
  return fmt::format("{:g} .. {:g}", goal.lb, goal.ub);
}

const Figure* Benchmark::find(const std::string& id) const {
  for (const std::vector<Figure>* figures : {&table, &beyond}) {
    for (const Figure& figure : *figures) {
      if (figure.id == id) return &figure;
    }
  }
  return nullptr;
}

}  // namespace hg::haptify
