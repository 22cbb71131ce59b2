#include "hg/identify/drive_delay.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hg/core/interval.h"
#include "hg/identify/block_regression.h"

namespace hg::identify {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kSmoothing_s = 0.01;  // half width
constexpr double kRow_s = 0.01;        // distance of rows
constexpr double kLongest_s = 0.2;     // longest delay
constexpr double kSure_s = 2e-3;       // of the delay
constexpr double kModel_s = 5e-5;      // deviation by friction of another shape, [V]
constexpr double kMoving = 0.02;       // rad/s: a slower command has no direction

struct Signals {
  VectorXd q, r, dr, ddr;
};

// Value between the samples k and k + 1 at `at`, linear; the signals are smooth.
double between(const VectorXd& x, double at) {
  const double floor = std::floor(at);
  const auto k = static_cast<Eigen::Index>(floor);
  return x[k] + (at - floor) * (x[k + 1] - x[k]);
}

// Ages of the friction that the position still shows, s: a loop that integrates forgets it slowly.
constexpr std::array<double, 5> kAges_s = {0.0, 0.02, 0.04, 0.08, 0.15};
constexpr Eigen::Index kColumns = 3 + kAges_s.size();

// One step: parameters are the error of d, L^2 / 2, o, and f by age.
Regressed regress(const std::vector<Signals>& parts, double period_s, double d, int& blocks) {
  BlockRegression regression(kColumns);
  MatrixXd row(1, kColumns);
  const auto step = std::max<Eigen::Index>(1, std::lround(kRow_s / period_s));
  const auto block = std::max<Eigen::Index>(1, std::lround(kBlock_s / kRow_s));
  const auto edge = static_cast<Eigen::Index>(std::lround(kSmoothing_s / period_s)) + 2;
  const auto first =
      edge + static_cast<Eigen::Index>(std::lround((kLongest_s + kAges_s.back()) / period_s));
  for (const Signals& s : parts) {
    Eigen::Index rows = 0;
    for (Eigen::Index k = first; k + edge < s.q.size(); k += step) {
      if (rows++ % block == 0) regression.begin_block();
      const double at = static_cast<double>(k) - d / period_s;
      row.leftCols<3>() << -between(s.dr, at), between(s.ddr, at), 1.0;
      for (std::size_t age = 0; age < kAges_s.size(); ++age) {
        const double then = between(s.dr, at - kAges_s[age] / period_s);
        row(0, 3 + static_cast<Eigen::Index>(age)) = std::tanh(then / kMoving);
      }
      regression.add(row, VectorXd::Constant(1, s.q[k] - between(s.r, at)));
    }
  }
  blocks = regression.blocks();
  if (blocks < kFewestOfBlocks) return {};
  return regression.solve(VectorXd::Constant(kColumns, kInfinity));
}

double rms_speed(const std::vector<Signals>& parts) {
  double squares = 0.0, count = 0.0;
  for (const Signals& s : parts) {
    squares += s.dr.squaredNorm();
    count += static_cast<double>(s.dr.size());
  }
  return std::sqrt(squares / std::max(1.0, count));
}

void report(const Regressed& found, double d, DriveDelay& joint) {
  constexpr double kSureOfLag = 4.0;  // deviations
  const double deviation = std::hypot(std::sqrt(found.covariance(0, 0)), kModel_s);
  joint.residual = found.residual;
  if (!(deviation <= kSure_s)) {
    joint.missing.push_back(
        fmt::format("delay: its command moved with {:.2g} rad/s rms; move it faster", joint.speed));
    return;
  }
  joint.delay = {d, deviation, true};
  const double square = 2.0 * found.x[1], dsquare = 2.0 * std::sqrt(found.covariance(1, 1));
  const double most = std::sqrt(std::max(0.0, square) + 2.0 * dsquare);
  if (square > kSureOfLag * dsquare && square < d * d) {
    const double lag = std::sqrt(square);
    joint.lag = {lag, 0.5 * dsquare / lag, true};
  } else {
    joint.lag = {0.0, most, false};
  }
}

}  // namespace

DriveDelay identify_delay(const std::vector<JointMotion>& parts, int joint, double period_s) {
  constexpr int kRounds = 8;
  const int half = std::max(1, static_cast<int>(std::lround(kSmoothing_s / period_s)));
  std::vector<Signals> signals;
  for (const JointMotion& part : parts) {
    Signals s;
    s.q = smoothed(part.q.col(joint), half);
    s.r = smoothed(part.command.col(joint), half);
    s.dr = slope(s.r, period_s);
    s.ddr = slope(s.dr, period_s);
    signals.push_back(std::move(s));
  }
  DriveDelay result;
  result.speed = rms_speed(signals);
  double d = 0.0;
  Regressed found;
  for (int round = 0; round < kRounds; ++round) {
    int blocks = 0;
    found = regress(signals, period_s, d, blocks);
    if (blocks < kFewestOfBlocks) {
      result.missing.push_back(
          fmt::format("delay: it moved for {} s only, {} are needed", blocks, kFewestOfBlocks));
      return result;
    }
    d = std::clamp(d + found.x[0], 0.0, kLongest_s);
  }
  report(found, d, result);
  return result;
}

Figure common_delay(const std::vector<DriveDelay>& joints) {
  double weights = 0.0, sum = 0.0, scatter = 0.0;
  int count = 0;
  for (const DriveDelay& joint : joints) {
    if (!joint.delay.is_found) continue;
    const double weight = 1.0 / (joint.delay.deviation * joint.delay.deviation);
    weights += weight;
    sum += weight * joint.delay.value;
    ++count;
  }
  if (count == 0) return {};
  const double mean = sum / weights;
  for (const DriveDelay& joint : joints) {
    if (!joint.delay.is_found) continue;
    const double away = joint.delay.value - mean;
    scatter += away * away / (joint.delay.deviation * joint.delay.deviation);
  }
  const double birge = count > 1 ? std::sqrt(std::max(1.0, scatter / (count - 1))) : 1.0;
  return {mean, birge / std::sqrt(weights), true};
}

}  // namespace hg::identify
