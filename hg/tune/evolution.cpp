#include "hg/tune/evolution.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hg/core/interval.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/random.h"

namespace hg::tune {

namespace {

// Constants of Table 1 of the tutorial, for n variables.
struct Constants {
  Constants(double variables, int parents) : n(variables), weights(parents) {
    for (int i = 0; i < parents; ++i) weights[i] = std::log(parents + 0.5) - std::log(i + 1.0);
    weights /= weights.sum();
    mu = 1.0 / weights.squaredNorm();
    c_sigma = (mu + 2.0) / (n + mu + 5.0);
    d_sigma = 1.0 + 2.0 * std::max(0.0, std::sqrt((mu - 1.0) / (n + 1.0)) - 1.0) + c_sigma;
    c_c = (4.0 + mu / n) / (n + 4.0 + 2.0 * mu / n);
    c_1 = 2.0 / ((n + 1.3) * (n + 1.3) + mu);
    c_mu = std::min(1.0 - c_1, 2.0 * (mu - 2.0 + 1.0 / mu) / ((n + 2.0) * (n + 2.0) + mu));
    expected = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
  }

  double n;
  Eigen::VectorXd weights;
  double mu = 0.0, c_sigma = 0.0, d_sigma = 0.0, c_c = 0.0, c_1 = 0.0, c_mu = 0.0;
  double expected = 0.0;  // length of a normally distributed vector
};

// The distribution from which children are drawn, and the paths of its mean.
struct Distribution {
  Distribution(const Eigen::VectorXd& start, double step)
      : mean(start),
        path_sigma(Eigen::VectorXd::Zero(start.size())),
        path_c(path_sigma),
        C(Eigen::MatrixXd::Identity(start.size(), start.size())),
        sigma(step) {}

  Eigen::VectorXd mean, path_sigma, path_c;
  Eigen::MatrixXd C;  // covariance
  double sigma;
};

// Children of one generation: eigenvectors and standard deviations of C, steps from the mean.
struct Children {
  Children(const Distribution& from, int count, Random32& random) {
    const SymmetricEigen eigen = symmetric_eigen(from.C);
    vectors = eigen.vectors;
    scale = eigen.values.cwiseMax(1e-14).cwiseSqrt();
    for (int k = 0; k < count; ++k) {
      Eigen::VectorXd z(from.mean.size());
      for (double& value : z) value = random.normal();
      steps.push_back(vectors * scale.cwiseProduct(z));
      points.push_back(from.mean + from.sigma * steps.back());
    }
  }

  Eigen::MatrixXd vectors;
  Eigen::VectorXd scale;
  std::vector<Eigen::VectorXd> steps, points;
};

// Moves the distribution to the best children; `order`: children by cost.
void update(const Constants& c, const Children& children, const std::vector<std::size_t>& order,
            int generation, Distribution& next) {
  const Eigen::Index parents = c.weights.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(next.mean.size());
  for (int i = 0; i < parents; ++i) step += c.weights[i] * children.steps[order[i]];
  next.mean += next.sigma * step;

  const Eigen::VectorXd whitened =
      children.vectors * (children.vectors.transpose() * step).cwiseQuotient(children.scale);
  next.path_sigma = (1.0 - c.c_sigma) * next.path_sigma +
                    std::sqrt(c.c_sigma * (2.0 - c.c_sigma) * c.mu) * whitened;
  const double length =
      next.path_sigma.norm() / std::sqrt(1.0 - std::pow(1.0 - c.c_sigma, 2.0 * generation));
  const bool is_short = length < (1.4 + 2.0 / (c.n + 1.0)) * c.expected;
  next.path_c *= 1.0 - c.c_c;
  if (is_short) next.path_c += std::sqrt(c.c_c * (2.0 - c.c_c) * c.mu) * step;
  next.C *= 1.0 - c.c_1 - c.c_mu + (is_short ? 0.0 : c.c_1 * c.c_c * (2.0 - c.c_c));
  next.C += c.c_1 * next.path_c * next.path_c.transpose();
  for (int i = 0; i < parents; ++i) {
    const Eigen::VectorXd& one = children.steps[order[i]];
    next.C += c.c_mu * c.weights[i] * one * one.transpose();
  }
  next.sigma *= std::exp(c.c_sigma / c.d_sigma * (next.path_sigma.norm() / c.expected - 1.0));
}

}  // namespace

Eigen::VectorXd minimise(const Costs& costs, const Eigen::VectorXd& start,
                         const EvolutionConfig& config, const Watched& watched) {
  constexpr double kSmallest = 1e-3;  // of the step, times the first one
  const Constants constants(static_cast<double>(start.size()), config.children / 2);
  Random32 random(config.seed);
  Distribution distribution(start, config.step);
  Eigen::VectorXd best = start;
  double lowest = costs({start}).front();
  for (int generation = 1; generation <= config.generations; ++generation) {
    const Children children(distribution, config.children, random);
    std::vector<double> found = costs(children.points);
    for (double& cost : found) {
      if (std::isnan(cost)) cost = kInfinity;  // what cannot be computed is no solution
    }
    std::vector<std::size_t> order(found.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return found[i]; });
    if (found[order.front()] < lowest) {
      lowest = found[order.front()];
      best = children.points[order.front()];
    }
    update(constants, children, order, generation, distribution);
    if (watched) watched(generation, lowest);
    if (distribution.sigma < kSmallest * config.step) break;
  }
  return best;
}

}  // namespace hg::tune
