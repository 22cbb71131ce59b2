#include "apps/design/optimiser.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/gaco.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/utils/multi_objective.hpp>
#include <system_error>
#include <thread>
#include <tuple>
#include <utility>

#include "hg/core/error.h"

namespace hg::search {
namespace {

constexpr unsigned kEpochs = 10;  // exchanges between islands

// The problem as pagmo wants it: without variables that are kept, which its algorithms refuse.
struct UserProblem {
  Problem problem;

  bool is_free(std::size_t i) const { return problem.lower[i] < problem.upper[i]; }
  pagmo::vector_double reduced(const pagmo::vector_double& x) const {
    pagmo::vector_double result;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (is_free(i)) result.push_back(x[i]);
    }
    return result;
  }
  pagmo::vector_double full(const pagmo::vector_double& x) const {
    pagmo::vector_double result = problem.lower;
    auto next = x.begin();
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (is_free(i)) result[i] = *next++;
    }
    return result;
  }

  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    return problem.evaluate(full(x));
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {reduced(problem.lower), reduced(problem.upper)};
  }
  pagmo::vector_double::size_type get_nobj() const { return problem.objectives; }
  pagmo::vector_double::size_type get_nix() const {
    pagmo::vector_double::size_type count = 0;
    for (std::size_t i = problem.lower.size() - problem.integers; i < problem.lower.size(); ++i) {
      count += is_free(i) ? 1 : 0;
    }
    return count;
  }
  pagmo::thread_safety get_thread_safety() const { return pagmo::thread_safety::constant; }
  // pagmo wants it of every problem; islands are never sent anywhere
  template <class Archive>
  void serialize(Archive&, unsigned) {}
};

// seeds that differ by island and epoch
unsigned seed_of(std::uint64_t seed, unsigned island, unsigned epoch) {
  std::uint64_t x = seed * 1'000'003u + island * 1009u + epoch + 1;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return static_cast<unsigned>(x >> 32);
}

pagmo::algorithm make(Algorithm algorithm, unsigned generations, unsigned population,
                      unsigned seed) {
  switch (algorithm) {
    case Algorithm::kGenetic:
      break;
    case Algorithm::kAntColony:
      return pagmo::algorithm(pagmo::gaco(generations, std::min(13u, population), 1.0, 0.0, 0.01, 1,
                                          7, 100'000, 100'000, 0.0, false, seed));
  }
  return pagmo::algorithm(
      pagmo::sga(generations, 0.9, 15.0, 0.1, 20.0, 3, "sbx", "polynomial", "tournament", seed));
}

// Runs all tasks on some threads; throws what a task threw, the first by number.
void in_parallel(unsigned workers, std::size_t tasks, const std::function<void(std::size_t)>& run) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> errors(tasks);
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks; i = next++) {
      try {
        run(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  std::vector<std::thread> threads;
  const std::size_t most = std::min<std::size_t>(workers, tasks);
  try {
    while (threads.size() + 1 < most) threads.emplace_back(work);
  } catch (const std::system_error&) {
    // fewer threads than wanted do the same
  }
  work();
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

std::vector<pagmo::population> first_populations(const Problem& problem, const Options& options) {
  std::vector<pagmo::population> islands(options.islands);
  in_parallel(options.workers, options.islands, [&](std::size_t i) {
    const auto island = static_cast<unsigned>(i);
    const std::size_t given =
        i == 0 ? std::min<std::size_t>(options.start.size(), options.population) : 0;
    islands[i] = pagmo::population(pagmo::problem(UserProblem{problem}), options.population - given,
                                   seed_of(options.seed, island, 0));
    for (std::size_t k = 0; k < given; ++k)
      islands[i].push_back(UserProblem{problem}.reduced(options.start[k]));
  });
  return islands;
}

// The best of an island takes the place of the worst of the next one.
void exchange(std::vector<pagmo::population>& islands) {
  if (islands.size() < 2) return;
  std::vector<std::pair<pagmo::vector_double, pagmo::vector_double>> best;
  for (const pagmo::population& island : islands) {
    const auto index = island.best_idx();
    best.emplace_back(island.get_x()[index], island.get_f()[index]);
  }
  for (std::size_t i = 0; i < islands.size(); ++i) {
    const auto& [x, f] = best[(i + islands.size() - 1) % islands.size()];
    islands[i].set_xf(islands[i].worst_idx(), x, f);
  }
}

void refuse_without_choice(const Problem& problem) {
  if (problem.lower == problem.upper) throw SetupError("design: no variable is free");
}

}  // namespace

std::string to_string(Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::kGenetic:
      return "sga";
    case Algorithm::kAntColony:
      return "gaco";
  }
  return "unknown";
}

Best minimise(const Problem& problem, const std::vector<Algorithm>& algorithms,
              const Options& options) {
  refuse_without_choice(problem);
  std::vector<pagmo::population> islands = first_populations(problem, options);
  const unsigned generations = std::max(1u, options.generations / kEpochs);
  Best best;
  const auto algorithm_of = [&](std::size_t island) {
    return algorithms[island % algorithms.size()];
  };
  for (unsigned epoch = 1; epoch <= kEpochs; ++epoch) {
    in_parallel(options.workers, islands.size(), [&](std::size_t i) {
      const unsigned seed = seed_of(options.seed, static_cast<unsigned>(i), epoch);
      islands[i] = make(algorithm_of(i), generations, options.population, seed).evolve(islands[i]);
    });
    for (std::size_t i = 0; i < islands.size(); ++i) {
      const auto index = islands[i].best_idx();
      const double value = islands[i].get_f()[index][0];
      best.progress.push_back({to_string(algorithm_of(i)), static_cast<int>(i),
                               islands[i].get_problem().get_fevals(), value});
      if (!best.x.empty() && value >= best.value) continue;
      best.x = UserProblem{problem}.full(islands[i].get_x()[index]);
      best.value = value;
      best.algorithm = to_string(algorithm_of(i));
    }
    exchange(islands);
    if (options.progress) options.progress(static_cast<double>(epoch) / kEpochs);
  }
  return best;
}

std::vector<FrontPoint> front(const Problem& problem, const Options& options) {
  refuse_without_choice(problem);
  std::vector<pagmo::population> islands = first_populations(problem, options);
  const unsigned generations = std::max(1u, options.generations / kEpochs);
  for (unsigned epoch = 1; epoch <= kEpochs; ++epoch) {
    in_parallel(options.workers, islands.size(), [&](std::size_t i) {
      const unsigned seed = seed_of(options.seed, static_cast<unsigned>(i), epoch);
      islands[i] = pagmo::algorithm(pagmo::nsga2(generations, 0.95, 10.0, 0.1, 20.0, seed))
                       .evolve(islands[i]);
    });
    if (options.progress) options.progress(static_cast<double>(epoch) / kEpochs);
  }
  std::vector<pagmo::vector_double> values, points;
  for (const pagmo::population& island : islands) {
    values.insert(values.end(), island.get_f().begin(), island.get_f().end());
    points.insert(points.end(), island.get_x().begin(), island.get_x().end());
  }
  std::vector<FrontPoint> result;
  const auto add = [&](std::size_t i) {
    result.push_back({UserProblem{problem}.full(points[i]), values[i]});
  };
  if (values.size() < 2) {
    add(0);
    return result;
  }
  const auto sorted = pagmo::fast_non_dominated_sorting(values);
  for (const auto i : std::get<0>(sorted)[0]) add(i);
  std::sort(result.begin(), result.end(), [](const FrontPoint& a, const FrontPoint& b) {
    return std::tie(a.values, a.x) < std::tie(b.values, b.x);
  });
  const auto is_same = [](const FrontPoint& a, const FrontPoint& b) {
    return a.values == b.values;
  };
  result.erase(std::unique(result.begin(), result.end(), is_same), result.end());
  return result;
}

}  // namespace hg::search
