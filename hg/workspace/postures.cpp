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
constexpr int kSteps = 120;         // in which a range is searched
constexpr double kSame = 1e-5;      // rad, between two values that are one

// Searches the singular values of what `set` moves: a joint or a sum of joints.
template <class Set>
class SingularSearch {
 public:
  SingularSearch(const model::ChainModel& chain, int frame, int first,
                 const std::vector<Interval>& ranges, Set set)
      : chain_(chain), frame_(frame), first_(first), set_(set) {
    PostureSampler sampler(ranges);
    for (int i = 0; i < kWitnesses; ++i) witnesses_.push_back(sampler.draw());
  }

  std::vector<double> in(const Interval& range) {
    constexpr std::array<double, 9> kQuarters = {-2 * M_PI, -1.5 * M_PI, -M_PI,      -M_PI_2, 0,
                                                 M_PI_2,    M_PI,        1.5 * M_PI, 2 * M_PI};
    std::vector<double> found;
    for (const double value : kQuarters) {
      if (range.contains(value) && is_always_singular(value)) found.push_back(value);
    }
    for (const double value : lowest(range)) {
      const bool is_known =
          std::ranges::any_of(found, [&](double f) { return std::abs(f - value) < kSame; });
      if (!is_known && is_always_singular(value)) found.push_back(value);
    }
    return found;
  }

 private:
  double dexterity_at(double value, const Eigen::VectorXd& witness) {
    Eigen::VectorXd q = witness;
    set_(q, value);
    return dexterity(chain_, frame_, first_, q);
  }

  bool is_always_singular(double value) {
    return std::ranges::all_of(witnesses_, [&](const Eigen::VectorXd& witness) {
      return dexterity_at(value, witness) <= kSingular;
    });
  }

  // Values at which the first witness is singular: the ends of its dips. One may lie beside an end
  // of the range, which is its own neighbour.
  std::vector<double> lowest(const Interval& range) {
    const Eigen::VectorXd& witness = witnesses_.front();
    const auto place = [&](int i) {
      return std::lerp(range.lb, range.ub, std::clamp(i, 0, kSteps) / double{kSteps});
    };
    std::vector<double> found;
    double before = dexterity_at(range.lb, witness), here = before;
    for (int i = 0; i <= kSteps; ++i) {
      const double next = dexterity_at(place(i + 1), witness);
      if (here <= before && here <= next) {
        const double value = bottom(place(i - 1), place(i + 1));
        if (dexterity_at(value, witness) <= kSingular) found.push_back(value);
      }
      before = here;
      here = next;
    }
    return found;
  }

  // The value between `lb` and `ub` at which the first witness is the least dexterous, by golden
  // sections.
  double bottom(double lb, double ub) {
    constexpr int kSections = 50;
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < kSections; ++i) {
      const double low = ub - kGolden * (ub - lb), high = lb + kGolden * (ub - lb);
      if (dexterity_at(low, witnesses_.front()) < dexterity_at(high, witnesses_.front())) {
        ub = high;
      } else {
        lb = low;
      }
    }
    return 0.5 * (lb + ub);
  }

  model::ChainData chain_;
  int frame_, first_;
  Set set_;
  std::vector<Eigen::VectorXd> witnesses_;
};

}  // namespace

PostureSampler::PostureSampler(std::vector<Interval> ranges, std::uint32_t seed)
    : ranges_(std::move(ranges)), random_(seed) {}

Eigen::VectorXd PostureSampler::draw() {
  Eigen::VectorXd q(static_cast<Eigen::Index>(ranges_.size()));
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    q[i] = std::lerp(ranges_[i].lb, ranges_[i].ub, random_.share());
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
  const int n = chain.nv();
  std::vector<SingularValue> found;
  const auto turns = [&](int joint) { return !chain.joints()[joint].is_slide(); };
  for (int i = first; i < n; ++i) {
    if (!turns(i)) continue;
    SingularSearch search(chain, frame, first, ranges,
                          [i](Eigen::VectorXd& q, double value) { q[i] = value; });
    for (const double value : search.in(ranges[i])) found.push_back({i, -1, value});
  }
  for (int i = first; i + 1 < n; ++i) {
    if (!turns(i) || !turns(i + 1)) continue;
    SingularSearch search(chain, frame, first, ranges,
                          [i](Eigen::VectorXd& q, double value) { q[i + 1] = value - q[i]; });
    const Interval sums = {ranges[i].lb + ranges[i + 1].lb, ranges[i].ub + ranges[i + 1].ub};
    for (const double value : search.in(sums)) found.push_back({i, i + 1, value});
  }
  return found;
}

}  // namespace hg::workspace
