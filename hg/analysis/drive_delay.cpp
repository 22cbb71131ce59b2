#include "hg/analysis/drive_delay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace hg::analysis {
namespace {

constexpr std::size_t kMostResults = 60;
constexpr double kStep = 10e-3;  // s, of a point
constexpr int kWindow = 150;     // points
constexpr int kEvery = 100;      // points between two results
constexpr int kLeast = -5;       // lags, points; below 0, so that a maximum near 0 has neighbours
constexpr int kMost = 45;
constexpr int kLags = kMost - kLeast + 1;
constexpr std::size_t kPoints = kWindow + kLags - 1;
constexpr double kCertain = 3e-3;   // s
constexpr double kLikeness = 0.98;  // correlation below which it is no delay
constexpr double kFree = 0.1;       // independent points of all: errors of neighbours are alike

}  // namespace

void NewestResults::add(double value) {
  values_.push_back(value);
  if (values_.size() > kMostResults) values_.pop_front();
}

double NewestResults::at(double share) const {
  if (values_.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted(values_.begin(), values_.end());
  std::ranges::sort(sorted);
  return sorted[static_cast<std::size_t>(
      std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

DriveDelay::DriveDelay(double rate_Hz)
    : samples_per_point_(std::max(1, static_cast<int>(std::lround(kStep * rate_Hz)))),
      step_s_(samples_per_point_ / rate_Hz) {}

void DriveDelay::interrupt() {
  points_.clear();
  samples_ = fresh_ = 0;
  last_measured_.resize(0);
}

void DriveDelay::add(const VectorM& commanded, const VectorM& measured) {
  if (commanded.size() != measured.size() || !commanded.allFinite() || !measured.allFinite()) {
    return interrupt();
  }
  VectorM unwrapped = measured;
  if (last_measured_.size() == measured.size()) {
    for (Eigen::Index i = 0; i < measured.size(); ++i) {
      const double turns = (last_measured_[i] - measured[i]) / (2.0 * std::numbers::pi);
      unwrapped[i] += 2.0 * std::numbers::pi * std::round(turns);
    }
  }
  last_measured_ = unwrapped;
  if (samples_ == 0) sum_ = {VectorM::Zero(measured.size()), VectorM::Zero(measured.size())};
  sum_.commanded += commanded;
  sum_.measured += unwrapped;
  if (++samples_ < samples_per_point_) return;
  samples_ = 0;
  points_.push_back({sum_.commanded / samples_per_point_, sum_.measured / samples_per_point_});
  if (points_.size() > kPoints) points_.pop_front();
  if (++fresh_ < kEvery || points_.size() < kPoints) return;
  fresh_ = 0;
  if (const std::optional<double> delay = find()) results_.add(*delay);
}

// The measured window ends -kLeast points before the newest command.
std::optional<double> DriveDelay::find() const {
  const auto points = [&](int lag, VectorM Point::*kind) {
    Eigen::MatrixXd window(points_.front().measured.size(), kWindow);
    for (int k = 0; k < kWindow; ++k) window.col(k) = points_[kMost - lag + k].*kind;
    window.colwise() -= window.rowwise().mean().eval();
    return window;
  };
  const Eigen::MatrixXd measured = points(0, &Point::measured);
  std::array<double, kLags> likeness{};
  for (int lag = kLeast; lag <= kMost; ++lag) {
    const Eigen::MatrixXd commanded = points(lag, &Point::commanded);
    const double size = measured.norm() * commanded.norm();
    likeness[lag - kLeast] = size > 0.0 ? measured.cwiseProduct(commanded).sum() / size : 0.0;
  }
  const auto best = std::ranges::max_element(likeness);
  if (best == likeness.begin() || best == likeness.end() - 1 || !(*best > kLikeness)) return {};
  // the correlation of a smooth motion is a parabola near its maximum
  const double bend = best[1] - 2.0 * best[0] + best[-1], slope = 0.5 * (best[1] - best[-1]);
  // what is left of the correlation, shifted in time
  const double lost = std::sqrt(2.0 * std::max(0.0, 1.0 - *best) / (kFree * kWindow));
  const double uncertain = step_s_ * lost / std::sqrt(std::max(-bend, 1e-12));
  if (!(bend < 0.0) || !(uncertain < kCertain)) return {};
  const auto lag = static_cast<double>(best - likeness.begin() + kLeast);
  return step_s_ * (lag - slope / bend);
}

}  // namespace hg::analysis
