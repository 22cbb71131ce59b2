/// How long joints take to follow their commands, from commanded and measured positions alone.
///
/// Both are averaged over 10 ms. Once a second, the lag at which the last 1.5 s of what was
/// measured agree best with what was commanded, over all joints, is one result; a constant offset
/// of a joint has no effect. It counts where the arm moved enough for it to be certain to 3 ms.
/// Outside any loop: it allocates.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>

#include "hg/core/types.h"

namespace hg::analysis {

/// Median of the newest results of a quantity, at most 60.
class NewestResults {
 public:
  void add(double value);
  bool is_empty() const noexcept { return values_.empty(); }
  /// Value below which `share` of the results are; NaN without any.
  double at(double share) const;
  double median() const { return at(0.5); }
  /// Half of the range of the middle 80 %.
  double spread() const { return 0.5 * (at(0.9) - at(0.1)); }

 private:
  std::deque<double> values_;
};

class DriveDelay {
 public:
  explicit DriveDelay(double rate_Hz);

  /// Positions of all joints of one sample, rad or m: as its answer commands them, and as measured,
  /// which may be wrapped to one turn.
  void add(const VectorM& commanded, const VectorM& measured);
  /// Samples are missing, or the drives are off: what came before is forgotten, the results stay.
  void interrupt();

  /// Times from sending a command to the moment at which the joints are where it wants them, s.
  const NewestResults& results() const noexcept { return results_; }

 private:
  struct Point {
    VectorM commanded, measured;
  };
  std::optional<double> find() const;

  int samples_per_point_;
  double step_s_;  ///< between two points
  int samples_ = 0, fresh_ = 0;
  Point sum_;
  VectorM last_measured_;
  std::deque<Point> points_;
  NewestResults results_;
};

}  // namespace hg::analysis
