#include "hg/controller/rendering/twin_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hg/core/error.h"
#include "hg/core/linear_algebra.h"
#include "hg/model/chain_data.h"

namespace hg::rendering {

void check_twin_model(const TwinModel& twin) {
  const auto require = [](bool ok, const std::string& text) {
    if (!ok) throw SetupError("twin" + text);
  };
  const std::size_t n_a = twin.chain.nv();
  require(n_a <= kMaxTwin, ": at most " + std::to_string(kMaxTwin) + " degrees of freedom, got " +
                               std::to_string(n_a));
  require(twin.end_effector >= 0, ": an end effector is needed");
  require(twin.q_start.size() == twin.chain.nq(), ": one start value per coordinate is needed");
  require(twin.dofs.size() == n_a, ": one entry per degree of freedom is needed");
  for (const TwinDof& dof : twin.dofs) {
    limits::check_joint_limits(dof.limits, "twin joint " + dof.name);
    require(dof.closer.stiffness == 0.0 || std::isfinite(dof.limits.q_min),
            " joint " + dof.name + ": a closer with stiffness needs a lower limit");
  }
  require(std::ssize(twin.locks) <= kMaxLocks, ": at most " + std::to_string(kMaxLocks) + " locks");
  require(std::ssize(twin.conditional_limits) <= kMaxConditionalLimits,
          ": at most " + std::to_string(kMaxConditionalLimits) + " conditional limits");
  require(std::ssize(twin.spheres) <= kMaxSpheres,
          ": at most " + std::to_string(kMaxSpheres) + " collision spheres");
  for (const CollisionSphere& sphere : twin.spheres) {
    require(sphere.frame >= 0 && sphere.p.allFinite() && sphere.radius >= 0.0 &&
                std::isfinite(sphere.radius),
            ": a collision sphere needs a frame, a finite centre and a finite radius >= 0");
  }
  require(kMassScale.contains(twin.mass_scale), ": mass_scale must be 0.1..10");
  for (const double scale : twin.felt_scale) {
    require(kFeltScale.contains(scale), ": felt_scale must be 0.1..10");
  }
}

FeltMass felt_mass(const TwinModel& twin, const Eigen::Vector3d& scale) {
  constexpr double kStuck = 1e-6;  // of the largest mobility
  model::ChainData chain(twin.chain);
  const VectorA at_rest = VectorA::Zero(chain.model().nv());
  chain.update(twin.q_start, at_rest);
  const Eigen::MatrixXd J =
      scale.cwiseSqrt().asDiagonal() * chain.jacobian(twin.end_effector).topRows<3>();
  const Eigen::MatrixXd inverse_mass = inverse(Eigen::MatrixXd(chain.M()));
  const Eigen::Matrix3d mobility = J * inverse_mass * J.transpose();
  const SymmetricEigen eigen = symmetric_eigen(mobility);  // the smallest first
  const double most = eigen.values[2];
  if (!(most > 0.0)) return {.dq = at_rest};
  const double least =
      *std::ranges::find_if(eigen.values, [&](double value) { return value > kStuck * most; });
  return {{twin.mass_scale / most, twin.mass_scale / least},
          inverse_mass * J.transpose() * eigen.vectors.col(2) / most};
}

double position_of(const TwinModel& twin, int dof, const ConfigurationA& q_a) noexcept {
  return q_a[twin.dofs[dof].q_index];
}

bool are_true(const TwinModel& twin, const std::vector<JointCondition>& conditions,
              const ConfigurationA& q_a) noexcept {
  return std::all_of(conditions.begin(), conditions.end(), [&](const JointCondition& c) {
    return c.range.contains(position_of(twin, c.dof, q_a));
  });
}

}  // namespace hg::rendering
