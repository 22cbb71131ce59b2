#include "hg/tune/evolution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hg/core/interval.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/random.h"

namespace hg::tune {

Eigen::VectorXd minimise(const Costs& costs, const Eigen::VectorXd& start,
                         const EvolutionConfig& config, const Watched& watched) {
  constexpr double kSmallest = 1e-3;  // of the step, times the first one
  const auto n = static_cast<double>(start.size());
  const int parents = config.children / 2;
  Eigen::VectorXd weights(parents);
  for (int i = 0; i < parents; ++i) weights[i] = std::log(parents + 0.5) - std::log(i + 1.0);
  weights /= weights.sum();
  const double mu = 1.0 / weights.squaredNorm();
  // Table 1 of the tutorial
  const double c_sigma = (mu + 2.0) / (n + mu + 5.0);
  const double d_sigma =
      1.0 + 2.0 * std::max(0.0, std::sqrt((mu - 1.0) / (n + 1.0)) - 1.0) + c_sigma;
  const double c_c = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n);
  const double c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu);
  const double c_mu =
      std::min(1.0 - c_1, 2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0) * (n + 2.0) + mu));
  const double expected = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

  Random random(config.seed);
  Eigen::VectorXd mean = start, best = start;
  Eigen::VectorXd path_sigma = Eigen::VectorXd::Zero(start.size()), path_c = path_sigma;
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(start.size(), start.size());
  double sigma = config.step, lowest = costs({start}).front();
  for (int generation = 1; generation <= config.generations; ++generation) {
    const SymmetricEigen eigen = symmetric_eigen(C);
    const Eigen::VectorXd scale = eigen.values.cwiseMax(1e-14).cwiseSqrt();
    std::vector<Eigen::VectorXd> steps, children;
    for (int k = 0; k < config.children; ++k) {
      Eigen::VectorXd z(start.size());
      for (double& value : z) value = random.normal();
      steps.push_back(eigen.vectors * scale.cwiseProduct(z));
      children.push_back(mean + sigma * steps.back());
    }
    std::vector<double> found = costs(children);
    for (double& cost : found) {
      if (std::isnan(cost)) cost = kInfinity;  // what cannot be computed is no solution
    }
    std::vector<std::size_t> order(found.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return found[i]; });
    if (found[order.front()] < lowest) {
      lowest = found[order.front()];
      best = children[order.front()];
    }
    Eigen::VectorXd step = Eigen::VectorXd::Zero(start.size());
    for (int i = 0; i < parents; ++i) step += weights[i] * steps[order[i]];
    mean += sigma * step;

    const Eigen::VectorXd whitened =
        eigen.vectors * (eigen.vectors.transpose() * step).cwiseQuotient(scale);
    path_sigma =
        (1.0 - c_sigma) * path_sigma + std::sqrt(c_sigma * (2.0 - c_sigma) * mu) * whitened;
    const double length =
        path_sigma.norm() / std::sqrt(1.0 - std::pow(1.0 - c_sigma, 2.0 * generation));
    const bool is_short = length < (1.4 + 2.0 / (n + 1.0)) * expected;
    path_c *= 1.0 - c_c;
    if (is_short) path_c += std::sqrt(c_c * (2.0 - c_c) * mu) * step;
    C *= 1.0 - c_1 - c_mu + (is_short ? 0.0 : c_1 * c_c * (2.0 - c_c));
    C += c_1 * path_c * path_c.transpose();
    for (int i = 0; i < parents; ++i) {
      const Eigen::VectorXd& one = steps[order[i]];
      C += c_mu * weights[i] * one * one.transpose();
    }
    sigma *= std::exp(c_sigma / d_sigma * (path_sigma.norm() / expected - 1.0));
    if (watched) watched(generation, lowest);
    if (sigma < kSmallest * config.step) break;
  }
  return best;
}

}  // namespace hg::tune
