/// The independent runs of a measurement, played in this process or in others.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "hg/experiments/workers.h"

namespace hg::experiments {

/// A share of all runs: each `count`-th unit from the `index`-th on, from 1 to `count`.
struct Part {
  std::size_t index = 1;
  std::size_t count = 1;
};

/// What a measurement asks for its runs, one after another, always in the same order. It plays all
/// of them, or the share of a part; or it plays none and has the results of other processes.
class Runs {
 public:
  /// Plays all runs, on all processors, and reports how many of those of a next() are done.
  explicit Runs(Progress progress = {}) : progress_(std::move(progress)), is_threaded_(true) {}
  /// Plays the runs of a part. What is made of them is of no use; results() are.
  explicit Runs(const Part& part) : part_(part) {}
  /// Plays nothing; `results` by number, from 0 on.
  explicit Runs(std::map<std::size_t, nlohmann::json> results)
      : results_(std::move(results)), plays_(false) {}

  /// Results of the next `count` runs; null for those of other parts. play(i) is run i of them,
  /// with others at the same time. `together` runs that follow each other are a unit: they are
  /// always played by the same thread, in their order.
  std::vector<nlohmann::json> next(std::size_t count,
                                   const std::function<nlohmann::json(std::size_t)>& play,
                                   std::size_t together = 1);

  /// Results so far, by number from 0 on.
  const std::map<std::size_t, nlohmann::json>& results() const { return results_; }

 private:
  void play_units(std::size_t count, const std::function<void(std::size_t)>& play_unit);

  Progress progress_;
  Part part_;
  std::map<std::size_t, nlohmann::json> results_;
  bool plays_ = true;
  bool is_threaded_ = false;
  std::size_t next_ = 0;   // number of the next run
  std::size_t units_ = 0;  // before it
};

/// A number of a result; null stands for those that JSON does not have, which become NaN.
double number_of(const nlohmann::json& value);

}  // namespace hg::experiments
