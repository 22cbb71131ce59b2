#include "hg/rendering/twin_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/core/error.h"

namespace hg::rendering {

void check(const TwinModel& twin) {
  const auto require = [](bool ok, const std::string& text) {
    if (!ok) throw SetupError("twin" + text);
  };
  const auto n_a = static_cast<std::size_t>(twin.chain.nv());
  require(n_a <= kMaxTwin, ": at most " + std::to_string(kMaxTwin) + " degrees of freedom, got " +
                               std::to_string(n_a));
  require(twin.end_effector >= 0, ": an end effector is needed");
  require(twin.q_start.size() == twin.chain.nq(), ": one start value per coordinate is needed");
  require(twin.dofs.size() == n_a, ": one entry per degree of freedom is needed");
  for (const TwinDof& dof : twin.dofs) {
    limits::check(dof.limits, "twin joint " + dof.name);
    require(dof.closer.stiffness == 0.0 || std::isfinite(dof.limits.q_min),
            " joint " + dof.name + ": a closer with stiffness needs a lower limit");
  }
  require(twin.locks.size() <= static_cast<std::size_t>(kMaxLocks),
          ": at most " + std::to_string(kMaxLocks) + " locks");
  require(twin.conditional_limits.size() <= static_cast<std::size_t>(kMaxConditionalLimits),
          ": at most " + std::to_string(kMaxConditionalLimits) + " conditional limits");
  require(kMassScale.contains(twin.mass_scale), ": mass_scale must be 0.1..10");
}

double position_of(const TwinModel& twin, int dof, const ConfigurationA& q_a) noexcept {
  return q_a[twin.dofs[static_cast<std::size_t>(dof)].q_index];
}

bool are_true(const TwinModel& twin, const std::vector<JointCondition>& conditions,
              const ConfigurationA& q_a) noexcept {
  return std::all_of(conditions.begin(), conditions.end(), [&](const JointCondition& c) {
    return c.range.contains(position_of(twin, c.dof, q_a));
  });
}

}  // namespace hg::rendering
