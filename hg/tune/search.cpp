#include "hg/tune/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/experiments/workers.h"
#include "hg/tune/evolution.h"

namespace hg::tune {
namespace {

constexpr double kFirstStep = 0.08;     // of a knob, share of its range
constexpr int kMostProofs = 4;          // evolutions per limit
constexpr double kProofReserve = 1e-4;  // of eigenvalues, against other postures

double with_three_digits(double value, double (*rounding)(double)) {
  if (value == 0.0) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  return rounding(value / unit) * unit;
}

// As they will stand in a file, and within what the device takes.
Values rounded(const LoopDevice& device, const Values& values) {
  Values result = values.unaryExpr([](double x) { return with_three_digits(x, std::round); });
  const Values taken = values_of(with_values(device, result));
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (taken[i] < result[i]) result[i] = with_three_digits(taken[i], std::floor);
  }
  return result;
}

class Search {
 public:
  Search(const TuningProblem& problem, const Progress& progress)
      : problem_(problem), progress_(progress), demands_(demands_of(problem)) {
    // every deviation once, in different postures; what else matters comes with the proofs
    for (const Case& one : demands_.cases(0)) {
      if (one.grasp >= 0) continue;
      hard_.push_back({one.deviation % problem.postures.size(), one.deviation});
    }
  }

  Candidate best(const Values& start, double limit, std::vector<Proof>& everywhere) {
    Values found = start;
    for (int k = 0; k < kMostProofs; ++k) {
      const double step = k == 0 ? kFirstStep : 0.3 * kFirstStep;
      found = rounded(problem_.device, evolved(found, step, limit));
      everywhere = proof_everywhere(with_values(problem_.device, found));
      const Proof proof = worst(everywhere);
      if (proof.holds()) break;
      mind(proof);
    }
    return {found, figures_of(problem_, with_values(problem_.device, found))};
  }

  // The cheapest known candidate under a new limit.
  Values nearest(const TuningResult& result, double limit) const {
    Values least = result.before.values;
    double lowest = cost(least, limit);
    for (const Candidate& candidate : result.front) {
      const double here = cost(candidate.values, limit);
      if (here >= lowest) continue;
      lowest = here;
      least = candidate.values;
    }
    return least;
  }

  // Adds the cases in which a loop came nearest to its limits.
  void mind(const Proof& proof) {
    for (const Case& one : {proof.worst_arm, proof.worst_hand, proof.worst_friction}) {
      if (std::ranges::find(hard_, one) == hard_.end()) hard_.push_back(one);
    }
  }

  // One per posture.
  std::vector<Proof> proof_everywhere(const LoopDevice& device) {
    std::vector<Proof> proofs(problem_.postures.size());
    experiments::do_all(
        proofs.size(),
        [&](std::size_t i) {
          Proof& here = proofs[i];
          for (const Case& one : demands_.cases(i)) take(one, demands_.radius(device, one), here);
        },
        [&](std::size_t done, std::size_t total) { notify("proof", done, total); });
    return proofs;
  }

  Proof worst(const std::vector<Proof>& everywhere) const {
    Proof all;
    for (const Proof& one : everywhere) {
      take(one.worst_arm, one.arm, all);
      take(one.worst_hand, one.hand, all);
      take(one.worst_friction, one.friction, all);
    }
    return all;
  }

 private:
  void notify(const std::string& what, std::size_t done, std::size_t total) const {
    if (progress_) progress_(what, done, total);
  }

  void take(const Case& one, double radius, Proof& proof) const {
    const bool is_friction = demands_.is_friction(one);
    double& worst = is_friction ? proof.friction : one.grasp < 0 ? proof.arm : proof.hand;
    if (!(radius > worst)) return;
    worst = radius;
    (is_friction ? proof.worst_friction : one.grasp < 0 ? proof.worst_arm : proof.worst_hand) = one;
  }

  // Cost to minimise: distortion, plus penalties for violated limits.
  double cost(const Values& values, double limit) const {
    const LoopDevice device = with_values(problem_.device, values);
    const Figures figures = figures_of(problem_, device);
    const double too_much = std::max(0.0, figures.vibration / limit - 1.0);
    double excess = 0.0;
    for (const Case& one : hard_) {
      excess = std::max(excess, demands_.excess(device, one) + kProofReserve);
    }
    const double rough = std::max(0.0, figures.friction_N / problem_.friction_most_N - 1.0);
    return figures.distortion + 5.0 * too_much + 5.0 * rough + 100.0 * excess;
  }

  // By evolution, among places within the range of each knob.
  Values evolved(const Values& start, double step, double limit) {
    const auto costs = [&](const std::vector<Eigen::VectorXd>& places) {
      std::vector<double> result(places.size());
      experiments::do_all(places.size(),
                          [&](std::size_t i) {
                            const Eigen::VectorXd inside = places[i].cwiseMax(0.0).cwiseMin(1.0);
                            result[i] =
                                cost(values_at(inside), limit) + (places[i] - inside).squaredNorm();
                          },
                          {});
      return result;
    };
    const Eigen::VectorXd found =
        minimise(costs, place_of(start), {.step = step, .generations = problem_.most_rounds},
                 [&](int round, double best) {
                   notify(fmt::format("vibration at most {:.3g} m/s^2: cost {:.3f}", limit, best),
                          round, problem_.most_rounds + 1);
                 });
    return values_of(with_values(problem_.device, values_at(found.cwiseMax(0.0).cwiseMin(1.0))));
  }

  const TuningProblem& problem_;
  const Progress& progress_;
  Demands demands_;
  std::vector<Case> hard_;  // cases checked during the search
};

}  // namespace

Demands demands_of(const TuningProblem& problem) {
  return {problem.device.loop, problem.body, problem.postures};
}

Figures figures_of(const TuningProblem& problem, const LoopDevice& device) {
  Figures worst = {.transparency_Hz = kInfinity};
  const std::size_t count = std::min(problem.felt_postures, problem.postures.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Feel now = feel(linearise(device, problem.plant, problem.body, person::HandImpedance{},
                                    problem.noise, problem.postures[i]),
                          problem.body, problem.friction);
    worst.transparency_Hz = std::min(worst.transparency_Hz, now.least_transparency_Hz());
    worst.latency_s = std::max(worst.latency_s, now.largest_latency_s());
    worst.distortion = std::max(worst.distortion, now.distortion);
    worst.friction_N = std::max(worst.friction_N, now.friction_N);
    if (now.vibration > worst.vibration) {
      worst.vibration = now.vibration;
      worst.centroid_Hz = now.centroid_Hz;
    }
  }
  return worst;
}

TuningResult search(const TuningProblem& problem, const std::vector<double>& limits,
                    const Progress& progress) {
  Search searching(problem, progress);
  TuningResult result = {.limits = limits};
  const Values present = values_of(problem.device);
  result.before = {present, figures_of(problem, problem.device)};
  result.everywhere_before = searching.proof_everywhere(problem.device);
  result.proof_before = searching.worst(result.everywhere_before);
  searching.mind(result.proof_before);
  for (const double limit : limits) {
    std::vector<Proof> everywhere;
    result.front.push_back(searching.best(searching.nearest(result, limit), limit, everywhere));
    result.proofs.push_back(searching.worst(everywhere));
    if (result.front.size() == 1) result.everywhere = std::move(everywhere);
  }
  return result;
}

}  // namespace hg::tune
