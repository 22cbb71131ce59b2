/// The last three levels of the rendering law of the paper, with constraint torques as unknowns.
///
/// Source: [HG] sec. VI-C7 to C9, Table II, tasks 9-11: dynamics (20) with (21)-(24), range (26)
/// with (31), and norm of the constraint torques. Decision variable (25): after ddq_m and ddq_a one
/// alpha per limit, those of the twin's joints first, then those of the device in catalogue order.
/// Which limits may push is decided by the result of the previous cycle. No row has a weight.
///
/// No allocation, noexcept after construction.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "hg/controller/rendering/constraint_directions.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/hqp/problem.h"
#include "hg/hqp/solution.h"
#include "hg/model/device_model.h"

namespace hg::rendering {

/// Ends of the limits that the last result touched or exceeded, by catalogue index: "active" in
/// (26). Part of the copyable state of a cycle.
struct TouchedEnds {
  std::array<bool, kMaxLimits> lower{};
  std::array<bool, kMaxLimits> upper{};
};

/// Words of the state hash, in its order.
void hashed(auto& hash, const TouchedEnds& touched) {
  const auto& [lower, upper] = touched;
  hash.mix(lower, upper);
}

class PaperLaw {
 public:
  PaperLaw(const DeviceModel& device, const TwinModel& twin);

  /// Adds levels 9 to 11 to a problem whose variables are (25).
  void add_levels(hqp::Problem& problem);

  /// `L` is the Cholesky factor of M_a, `tau` (n_a) all torques on the twin that are not
  /// constraints, including -c_a. Row `first_limit_row` + i of `problem` is limit i. Finds the
  /// `directions` of all limits of the device.
  void fill(const MatrixA& L, const VectorA& tau, int first_limit_row,
            ConstraintDirections& directions, hqp::Problem& problem) noexcept;

  /// Sets the range of the torques of limit `limit`, (26) and (31).
  void set_range(int limit, bool lower_touched, bool upper_touched, bool is_locked,
                 hqp::Problem& problem) const noexcept;

  /// Index of the constraint force or torque of a limit in x.
  int alpha(int limit) const noexcept;

 private:
  int n_m_, n_a_, device_limits_;
  int dynamics_row_ = 0, range_row_ = 0;
  /// M_a^-1 (directions of all alpha, tau).
  MatrixUpTo<kMaxTwin, kMaxTwin + kMaxLimits + 1> response_;
  std::vector<double> coefficients_;  ///< scratch, one row
};

/// Whether x is at or beyond an end of row `row`; [HG] VI-C8. A missing end is never touched.
bool touches_lower(const hqp::Problem& problem, int row, std::span<const double> x) noexcept;
bool touches_upper(const hqp::Problem& problem, int row, std::span<const double> x) noexcept;

}  // namespace hg::rendering
