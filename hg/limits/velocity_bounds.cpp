#include "hg/limits/velocity_bounds.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "hg/core/error.h"

namespace hg::limits {
namespace {

void require_positive(std::string_view item, const char* field, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  std::ostringstream message;
  message << item << ": " << field << " must be finite and positive, got " << value;
  throw SetupError(message.str());
}

// Largest velocity towards a limit at distance d.
double max_velocity(double d, const DriveResponse& drive) noexcept {
  const double damped = d / (4.0 * drive.tau);
  if (d <= 0.0) return damped;
  const double a_tau = drive.ddq_max * drive.tau;
  return std::min(std::sqrt(a_tau * a_tau + 2.0 * drive.ddq_max * d) - a_tau, damped);
}

}  // namespace

void check_drive_response(const DriveResponse& drive, std::string_view item) {
  require_positive(item, "tau", drive.tau);
  require_positive(item, "ddq_max", drive.ddq_max);
}

Interval braking_velocity_bounds(Interval q_limits, const DriveResponse& drive, double q) noexcept {
  const double ub = max_velocity(q_limits.ub - q, drive);
  const double lb = -max_velocity(q - q_limits.lb, drive);
  if (lb <= ub) return {lb, ub};

  // a return from far outside must still stop before the opposite limit
  const double slower = std::abs(ub) < std::abs(lb) ? ub : lb;
  return {slower, slower};
}

}  // namespace hg::limits
