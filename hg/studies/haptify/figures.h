/// Results of a benchmark: figures with repetitions beside those of other devices, tables,
/// failures.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "hg/core/interval.h"
#include "hg/studies/haptify/statistics.h"

namespace hg::haptify {

inline constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// Table III of the paper: its machine, and two commercial devices as it cites them.
struct Published {
  double paper = kNotGiven, touch = kNotGiven, touch_x = kNotGiven;
};

struct Figure {
  std::string id;    ///< identifier for scripts: "free_space_force"
  std::string name;  ///< name for display
  std::string unit;
  int digits = 2;  ///< digits after the decimal point
  Published published;
  Interval goal;               ///< goal range of the mean; unbounded = no goal
  std::vector<double> values;  ///< values per repetition, in the order of their seeds
  std::string note;            ///< conditions of the measurement
  std::string why;             ///< cause of the value, with figures; for a missed goal

  Mean mean() const { return mean_of(values); }
  bool is_measured() const { return !values.empty(); }
  bool meets_goal() const { return is_measured() && goal.contains(mean().value); }
};

/// Goal as text: ">= 3", "<= 3", "3 .. 4" or "-".
std::string to_text(const Interval& goal);

/// Table of numbers, written to one file.
struct Table {
  std::string id;     ///< identifier for the file name
  std::string title;  ///< title, one line
  std::string note;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// A measured curve, for pictures.
struct Curve {
  std::string id;       ///< what is drawn over x: "transparency"
  std::string name;     ///< name among the curves of this id: "x"
  std::string x_label;  ///< with its unit
  std::vector<double> x;
  std::map<std::string, std::vector<double>> y;  ///< columns over x, as many values each
};

/// A cloud of points seen along one axis: the number of points in each cell of a plane.
struct View {
  int across = 0, up = 1;              ///< axes 0..2 of B that are drawn
  double left = 0.0, bottom = 0.0;     ///< corner of the first cell, m
  double cell = 0.0;                   ///< edge of a cell, m
  std::vector<std::vector<int>> rows;  ///< number of points, from the bottom up
  std::vector<double> box;             ///< limits: left, right, bottom, top, m; empty = none
};

struct HaptifyOptions {
  std::uint64_t seed = 1;  ///< seed of the first repetition; the others follow
  int repetitions = 5;
  bool is_quick = false;  ///< quick run: few samples, short runs
};

struct Benchmark {
  HaptifyOptions options;
  std::string device;
  std::vector<Figure> table;   ///< figures of Table III
  std::vector<Figure> beyond;  ///< figures beyond Table III
  std::vector<Table> tables;
  std::vector<Curve> curves;
  std::vector<View> workspace;        ///< the workspace from above and from two sides
  std::vector<std::string> failures;  ///< measurements that failed, in words; empty = none

  const Figure* find(const std::string& id) const;
};

}  // namespace hg::haptify
