#include "hg/identify/friction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "hg/identify/friction_fit.h"
#include "hg/signals/presliding.h"

namespace hg::identify {
namespace friction {
namespace {

using Eigen::VectorXd;

// Describes the motion of the joint from the rows.
void describe_motion(const Rows& rows, FrictionEstimate& found) {
  std::vector<double> speeds;
  for (const double v : rows.speed()) {
    speeds.push_back(std::abs(v));
    if (v > kSlidingSpeed) found.forward_s += rows.row_s();
    if (v < -kSlidingSpeed) found.backward_s += rows.row_s();
  }
  if (!speeds.empty()) {
    const auto most =
        speeds.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(speeds.size()));
    std::nth_element(speeds.begin(), most, speeds.end());
    found.speed = *most;
  }
  found.reversals = rows.reversals();
}

// Reason why nothing can be identified.
std::string lack_of(const Rows& rows, const FrictionEstimate& found) {
  const auto slid = [](const char* direction, double seconds) {
    return fmt::format(
        "all friction: it slid {:.1f} s in the {} direction (faster than {:g} rad/s), {:g} s are "
        "needed: move it there",
        seconds, direction, kSlidingSpeed, kSlidingTime);
  };
  if (found.forward_s < kSlidingTime) return slid("positive", found.forward_s);
  if (found.backward_s < kSlidingTime) return slid("negative", found.backward_s);
  const std::size_t blocks = rows.block_begins().size() - 1;
  if (blocks < kFewestBlocks) {
    return fmt::format("all friction: it moved in {} s only, {} are needed: record longer", blocks,
                       kFewestBlocks);
  }
  return "";
}

Model nominal_model(const ActuatorModel& nominal) {
  Model model;
  model.p[kCoulomb] = std::max(nominal.coulomb_friction, 1e-2);
  model.p[kLoad] = nominal.load_friction;
  model.p[kStiction] = nominal.stiction;
  model.p[kStribeck] = std::log(nominal.stribeck_speed);
  model.p[kViscous] = nominal.viscous_friction;
  model.p[kPresliding] = std::log(kRigid);
  return model;
}

constexpr double kWidest = 1e-2;     // rad, of the scan over presliding
constexpr double kNarrowest = 1e-5;  // rad: smaller values are not distinguishable from none

// The best of a grid of presliding, damping, stiction and number of elements. For a rigid joint
// one of all numbers of elements is as good as another.
Model scan(const Fit& fit, const Model& start, bool with_presliding, const Free& free,
           double& deviation) {
  std::optional<Model> best;
  double least = 0.0;
  const auto attempt = [&](Model model) {
    const double loss = fit.solve_linear(model, free, deviation);
    if (best && loss >= least) return;
    best = model;
    least = loss;
  };
  attempt(start);
  for (const double stiction : {1.0, 1.4}) {
    for (const double v_s : {0.02, 0.1}) {
      if (stiction == 1.0 && v_s > 0.05) continue;
      Model model = start;
      model.p[kStiction] = stiction;
      model.p[kStribeck] = std::log(v_s);
      attempt(model);
    }
  }
  if (!with_presliding) return *best;
  const Model rigid = *best;
  for (double x = kNarrowest; x < kWidest; x *= 2.0) {
    for (const double ratio : {0.0, 0.3}) {
      for (int elements = 1; elements <= kSlipElements; ++elements) {
        Model model = rigid;
        model.elements = elements;
        model.p[kPresliding] = std::log(x);
        model.p[kDamping] = ratio;
        attempt(model);
      }
    }
  }
  return *best;
}

// Decides step by step which parameters are identified; unobservable ones are reset to the nominal
// values.
class Decision {
 public:
  Decision(const Rows& rows, const ActuatorModel& nominal)
      : fit_(rows), rows_(rows), nominal_(nominal), start_(nominal_model(nominal)) {
    free_.fill(true);
  }

  void decide(FrictionEstimate& found) {
    const bool may_preslide = found.reversals >= kFewestReversals;
    if (!may_preslide) {
      found.missing.push_back(fmt::format(
          "presliding: {} reversals after {:g} rad and more, {} are needed: move it to and fro",
          found.reversals, kReversalWay, kFewestReversals));
    }
    if (may_preslide) decide_presliding(found);
    if (found.presliding_elements == 0) {
      // the behaviour during sticking is then unknown
      free_[kPresliding] = free_[kDamping] = false;
      fit_.count(rows_.slides());
      deviation_ = 0.0;
      model_ = scan(fit_, start_, false, free_, deviation_);
      improve();
    }
    decide_stiction(found);
    decide_viscous(found);  // first: effects indistinguishable from it do not depend on the load
    decide_load(found);
    report(found);
  }

 private:
  void improve() {
    loss_ = fit_.improve(model_, free_, deviation_);
    deviation_ = deviation_of(fit_.residuals(model_));
    loss_ = fit_.improve(model_, free_, deviation_);
    deviations_ = fit_.deviations(model_, free_, deviation_);
  }
  void keep(Parameter parameter) {
    free_[parameter] = false;
    model_.p[parameter] = start_.p[parameter];
  }

  void decide_presliding(FrictionEstimate& found) {
    constexpr double kSure = 0.35;   // of the logarithm
    constexpr double kBetter = 0.9;  // of the loss of rigid friction
    model_ = scan(fit_, start_, true, free_, deviation_);
    improve();
    decide_elements();
    const bool is_wide = model_.p[kPresliding] > std::log(kNarrowest);
    // the scan may have ended beside the best: without presliding it must fit clearly worse
    Model rigid = model_;
    rigid.p[kPresliding] = std::log(kRigid);
    rigid.p[kDamping] = 0.0;
    Free others = free_;
    others[kPresliding] = others[kDamping] = false;
    const bool is_needed = loss_ < kBetter * fit_.improve(rigid, others, deviation_);
    if (is_wide && is_needed && deviations_[kPresliding] <= kSure) {
      found.presliding_elements = model_.elements;
      return;
    }
    found.missing.push_back(
        fmt::format("presliding: none of {:g} rad and more was seen, in {} reversals", kNarrowest,
                    found.reversals));
  }

  // the neighbours of the best number, improved alike
  void decide_elements() {
    const Model first = model_;
    for (int elements = 1; elements <= kSlipElements; ++elements) {
      if (elements == first.elements) continue;
      Model other = first;
      other.elements = elements;
      const double loss = fit_.improve(other, free_, deviation_);
      if (loss >= loss_) continue;
      model_ = other;
      loss_ = loss;
    }
    improve();
  }

  void decide_stiction(FrictionEstimate& found) {
    constexpr double kSure = 0.1, kSureOfSpeed = 0.5;
    const auto is_sure = [&] { return deviations_[kStiction] <= kSure; };
    const bool has_bump = std::abs(model_.p[kStiction] - 1.0) > 2.0 * deviations_[kStiction];
    if (is_sure() && has_bump && deviations_[kStribeck] <= kSureOfSpeed) return;
    keep(kStribeck);
    improve();
    found.missing.push_back(fmt::format(
        "Stribeck speed: slide slowly, from 0.2 to 3 times {:g} rad/s, both ways; Coulomb friction "
        "assumes the configured one",
        nominal_.stribeck_speed));
    if (is_sure()) return;
    keep(kStiction);
    improve();
    found.missing.push_back("stiction: as for the Stribeck speed, with stops in between");
  }

  void decide_load(FrictionEstimate& found) {
    constexpr double kSure = 0.02;
    if (deviations_[kLoad] <= kSure) return;
    coulomb_least_ = deviations_[kCoulomb];  // the belief about the load does not affect F
    keep(kLoad);
    improve();
    const VectorXd loads = rows_.spring().cwiseAbs();
    found.missing.push_back(
        fmt::format("load friction: its spring carried {:.1f} to {:.1f} Nm, slide with more "
                    "different loads",
                    loads.minCoeff(), loads.maxCoeff()));
  }

  void decide_viscous(FrictionEstimate& found) {
    constexpr double kSure = 0.25, kEnough = 0.1;  // of itself; of F per rad/s
    const double deviation = deviations_[kViscous];
    if (deviation <= kSure * std::abs(model_.p[kViscous]) ||
        deviation <= kEnough * model_.p[kCoulomb]) {
      return;
    }
    keep(kViscous);
    improve();
    found.missing.push_back(fmt::format(
        "viscous friction: 99 % of it was slower than {:.3f} rad/s, slide faster", found.speed));
  }

  void report(FrictionEstimate& found) const {
    constexpr double kSureOfCoulomb = 0.3;
    const auto figure = [&](Parameter parameter) {
      return Figure{model_.p[parameter], deviations_[parameter],
                    free_[parameter] && std::isfinite(deviations_[parameter])};
    };
    const auto of_logarithm = [&](Parameter parameter) {
      const double value = std::exp(model_.p[parameter]);
      return Figure{value, value * deviations_[parameter], free_[parameter]};
    };
    found.load = figure(kLoad);
    found.viscous = figure(kViscous);
    found.coulomb = figure(kCoulomb);
    found.coulomb.deviation = std::max(found.coulomb.deviation, coulomb_least_);
    if (!(found.coulomb.deviation <= kSureOfCoulomb * found.coulomb.value)) {
      found.coulomb = {nominal_.coulomb_friction, 0.0, false};
      found.viscous = {nominal_.viscous_friction, 0.0, false};
      found.missing.push_back(
          "Coulomb friction: cannot be distinguished from load friction, likewise with different "
          "loads");
    }
    found.stiction = figure(kStiction);
    found.stribeck_speed = of_logarithm(kStribeck);
    found.presliding = of_logarithm(kPresliding);
    if (found.presliding_elements == 0) {
      found.presliding = {nominal_.presliding, 0.0, false};
    }
    found.residual = fit_.rms(model_);
  }

  Fit fit_;
  const Rows& rows_;
  const ActuatorModel& nominal_;
  Model start_, model_;
  Free free_{};
  double deviation_ = 0.0, loss_ = 0.0;
  double coulomb_least_ = 0.0;  // deviation of F regardless of the others
  Parameters deviations_ = Parameters::Zero();
};

}  // namespace
}  // namespace friction

FrictionEstimate identify_friction(const FrictionTrace& trace, const ActuatorModel& nominal) {
  const friction::Rows rows(trace, nominal.rotor_inertia);
  FrictionEstimate found;
  found.coulomb.value = nominal.coulomb_friction;
  found.load.value = nominal.load_friction;
  found.viscous.value = nominal.viscous_friction;
  found.stiction.value = nominal.stiction;
  found.stribeck_speed.value = nominal.stribeck_speed;
  found.presliding.value = nominal.presliding;
  friction::describe_motion(rows, found);
  if (std::string lack = friction::lack_of(rows, found); !lack.empty()) {
    found.missing.push_back(std::move(lack));
    return found;
  }
  friction::Decision(rows, nominal).decide(found);
  return found;
}

}  // namespace hg::identify
