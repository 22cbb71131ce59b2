/// Mixed-integer search by pagmo, behind plain types: pagmo's Boost and Eigen are those of the
/// system, so that this header and optimiser.cpp know nothing else of the project.
///
/// Source: [HG] III-B (evolutionary algorithm), pagmo 2.18. The islands are evolved by worker
/// threads between exchanges in a fixed order: the result depends on seeds, never on threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace hg::search {

using Point = std::vector<double>;  ///< Continuous variables first, then whole numbers

struct Problem {
  Point lower, upper;          ///< Bounds of the variables, both included
  std::size_t integers = 0;    ///< Number of whole variables, the last ones
  std::size_t objectives = 1;  ///< Number of values to be minimised
  /// Values of a point; called from several threads at once. The penalty of broken constraints is
  /// part of the values.
  std::function<std::vector<double>(const Point&)> evaluate;
};

/// Algorithms for one objective; kGenetic is pagmo's sga, kAntColony its gaco.
enum class Algorithm { kGenetic, kAntColony };

std::string to_string(Algorithm algorithm);

struct Options {
  unsigned population = 40;   ///< Individuals per island
  unsigned generations = 60;  ///< Per island, between exchanges: a tenth
  unsigned islands = 4;
  unsigned workers = 2;  ///< Threads
  std::uint64_t seed = 1;
  std::vector<Point> start = {};  ///< Points that the first island begins with
  /// Called by the main thread after each tenth, with the share that is done.
  std::function<void(double)> progress = {};
};

/// Best value after some generations.
struct Progress {
  std::string algorithm;
  int island = 0;
  std::size_t evaluations = 0;  ///< Of this island
  double best = 0.0;
};

struct Best {
  Point x;
  double value = 0.0;
  std::string algorithm;  ///< That found it
  std::vector<Progress> progress;
};

/// Minimises one objective: islands take the algorithms in turn and pass their best to the next.
Best minimise(const Problem& problem, const std::vector<Algorithm>& algorithms,
              const Options& options);

struct FrontPoint {
  Point x;
  std::vector<double> values;
};

/// Approximates the set of points that no other one beats in all objectives (nsga2); sorted by the
/// first objective.
std::vector<FrontPoint> front(const Problem& problem, const Options& options);

}  // namespace hg::search
