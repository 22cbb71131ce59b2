/// What a benchmark says: figures with repetitions beside those of other devices, tables, failures.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "hg/core/interval.h"
#include "hg/haptify/statistics.h"

namespace hg::haptify {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Table III of the paper: its machine, and two commercial devices as it cites them.
struct Published {
  double paper = kNotGiven, touch = kNotGiven, touch_x = kNotGiven;
};

struct Figure {
  std::string id;    ///< for scripts: "free_space_force"
  std::string name;  ///< for people
  std::string unit;
  int digits = 2;  ///< after the point
  Published published;
  Interval goal;               ///< where the mean should be; unbounded = no goal
  std::vector<double> values;  ///< one per repetition, in the order of their seeds
  std::string note;            ///< under which conditions
  std::string why;             ///< what makes it what it is, with figures; for a missed goal

  Mean mean() const { return mean_of(values); }
  bool is_measured() const { return !values.empty(); }
  bool meets_goal() const { return is_measured() && goal.contains(mean().value); }
};

/// ">= 3", "<= 3", "3 .. 4" or "-".
std::string to_text(const Interval& goal);

/// Numbers in rows, one file each.
struct Table {
  std::string id;     ///< of the file
  std::string title;  ///< one line
  std::string note;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct Options {
  std::uint64_t seed = 1;  ///< of the first repetition; the others follow
  int repetitions = 5;
  bool is_quick = false;  ///< a look: few samples, short runs
};

struct Benchmark {
  Options options;
  std::string device;
  std::vector<Figure> table;   ///< Table III
  std::vector<Figure> beyond;  ///< what it does not have
  std::vector<Table> tables;
  std::vector<std::string> failures;  ///< measurements that failed, in words; empty = none

  const Figure* find(const std::string& id) const;
};

}  // namespace hg::haptify
