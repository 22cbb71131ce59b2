#include "hg/workspace/postures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "hg/core/linear_algebra.h"
#include "hg/model/joint_range.h"

namespace hg::workspace {
namespace {

constexpr double kWrist = 0.3;      // m, makes rotations comparable with translations
constexpr double kSingular = 1e-6;  // m/rad
constexpr int kWitnesses = 12;      // random postures that must all be singular

// whether every posture with this value is singular; the value is put in by `set`
template <class Set>
bool is_always_singular(model::ChainData& chain, int frame, int first,
                        const std::vector<Interval>& ranges, Set set) {
  PostureSampler sampler(ranges);
  for (int i = 0; i < kWitnesses; ++i) {
    Eigen::VectorXd q = sampler.draw();
    set(q);
    if (dexterity(chain, frame, first, q) > kSingular) return false;
  }
  return true;
}

}  // namespace

PostureSampler::PostureSampler(std::vector<Interval> ranges, std::uint32_t seed)
    : ranges_(std::move(ranges)), random_(seed) {}

Eigen::VectorXd PostureSampler::draw() {
  Eigen::VectorXd q(static_cast<Eigen::Index>(ranges_.size()));
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    q[i] = std::lerp(ranges_[i].lb, ranges_[i].ub, random_.next());
  }
  return q;
}

std::vector<Interval> joint_ranges(const model::ChainModel& chain) {
  std::vector<Interval> ranges;
  for (const model::Joint& joint : chain.joints()) {
    ranges.push_back(model::finite_range(joint.position, !joint.is_slide()));
  }
  return ranges;
}

double dexterity(model::ChainData& chain, int frame, int first, const Eigen::VectorXd& q) {
  const Eigen::VectorXd at_rest = Eigen::VectorXd::Zero(chain.model().nv());
  chain.update_kinematics(q, at_rest);
  Eigen::MatrixXd J = chain.jacobian(frame).rightCols(chain.model().nv() - first);
  J.bottomRows<3>() *= kWrist;
  const Eigen::VectorXd sigma = singular_value_decomposition(J).sigma;
  return sigma.size() < 6 ? 0.0 : sigma[5];
}

std::vector<SingularValue> singular_values(const model::ChainModel& chain, int frame, int first,
                                           const std::vector<Interval>& ranges) {
  constexpr std::array<double, 9> kQuarters = {-2 * M_PI, -1.5 * M_PI, -M_PI,      -M_PI_2, 0,
                                               M_PI_2,    M_PI,        1.5 * M_PI, 2 * M_PI};
  model::ChainData probe(chain);
  const int n = chain.nv();
  std::vector<SingularValue> found;
  const auto turns = [&](int joint) { return !chain.joints()[joint].is_slide(); };
  const auto range = [&](int joint) { return ranges[joint]; };

  for (int i = first; i < n; ++i) {
    if (!turns(i)) continue;
    for (double value : kQuarters) {
      if (!range(i).contains(value)) continue;
      const auto set = [&](Eigen::VectorXd& q) { q[i] = value; };
      if (is_always_singular(probe, frame, first, ranges, set)) found.push_back({i, -1, value});
    }
  }
  for (int i = first; i + 1 < n; ++i) {
    if (!turns(i) || !turns(i + 1)) continue;
    const Interval sums = {range(i).lb + range(i + 1).lb, range(i).ub + range(i + 1).ub};
    for (double value : kQuarters) {
      if (!sums.contains(value)) continue;
      const auto set = [&](Eigen::VectorXd& q) { q[i + 1] = value - q[i]; };
      if (is_always_singular(probe, frame, first, ranges, set)) found.push_back({i, i + 1, value});
    }
  }
  return found;
}

}  // namespace hg::workspace
