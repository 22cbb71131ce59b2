/// Minimises a non-smooth function of a few variables without derivatives.
///
/// CMA-ES with its usual constants: N. Hansen, The CMA Evolution Strategy: A Tutorial,
/// arXiv 1604.00772, without restarts and negative weights.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

namespace hg::tune {

struct EvolutionConfig {
  double step = 0.1;     ///< initial standard deviation of every variable
  int generations = 60;  ///< largest number of generations
  int children = 12;     ///< children per generation, >= 4
  std::uint32_t seed = 1;
};

/// Values of the function for all of `x`, which may be computed in parallel.
using Costs = std::function<std::vector<double>(const std::vector<Eigen::VectorXd>& x)>;
/// Callback after every generation: number of generations, and the lowest cost so far.
using Watched = std::function<void(int generation, double best)>;

/// Returns the best of all tried x, including `start`. The same arguments give the same result.
Eigen::VectorXd minimise(const Costs& costs, const Eigen::VectorXd& start,
                         const EvolutionConfig& config, const Watched& watched);

}  // namespace hg::tune
