#include "hg/identify/friction_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hg/signals/presliding.h"

namespace hg::identify::friction {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStill = 5e-6;  // rad: a joint that moves less shows no friction
constexpr double kBlock = 1.0;   // s

// Hann's window; its weights add up to 1.
std::array<double, 2 * kSmoothing + 1> window() {
  std::array<double, 2 * kSmoothing + 1> w{};
  for (int i = -kSmoothing; i <= kSmoothing; ++i) {
    w[i + kSmoothing] =
        (1.0 + std::cos(std::numbers::pi * i / (kSmoothing + 1))) / (2.0 * (kSmoothing + 1));
  }
  return w;
}

}  // namespace

template <typename Do>
void Rows::for_each_part(Do&& take) const {
  for (std::size_t i = 0; i < trace_.cuts.size(); ++i) {
    const std::size_t end = i + 1 < trace_.cuts.size() ? trace_.cuts[i + 1] : trace_.theta.size();
    if (end > trace_.cuts[i]) take(trace_.cuts[i], end);
  }
}

Rows::Rows(const FrictionTrace& trace, double rotor_inertia)
    : trace_(trace), window_(window()), J_m_(rotor_inertia) {
  const std::size_t n = trace.theta.size();
  speed_.assign(n, 0.0);
  const double h = trace.period_s;
  std::vector<double> raw(n, 0.0), acceleration(n, 0.0), driven(n, 0.0);
  for_each_part([&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      driven[k] = trace.tau_motor[k] - trace.tau_J[k];
      if (k == begin || k + 1 == end) continue;
      raw[k] = (trace.theta[k + 1] - trace.theta[k - 1]) / (2.0 * h);
      acceleration[k] = (trace.theta[k + 1] - 2.0 * trace.theta[k] + trace.theta[k - 1]) / (h * h);
    }
    for (std::size_t k = begin + kSmoothing + 1; k + kSmoothing + 1 < end; ++k) {
      speed_[k] = smoothed(raw, k);
      if ((k - begin) % kSamplesPerRow == 0 && way(k) > kStill) at_.push_back(k);
    }
  });
  const auto rows = static_cast<Eigen::Index>(at_.size());
  y_.resize(rows);
  v_.resize(rows);
  tau_.resize(rows);
  ddtheta_.resize(rows);
  slides_.resize(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const std::size_t k = at_[i];
    ddtheta_[i] = smoothed(acceleration, k);
    y_[i] = smoothed(driven, k) - J_m_ * ddtheta_[i];
    v_[i] = speed_[k];
    tau_[i] = smoothed(trace.tau_J, k);
    slides_[i] = slides(k) ? 1.0 : 0.0;
    const int block = static_cast<int>(static_cast<double>(k) * h / kBlock);
    if (blocks_.empty() || blocks_.back() != block) {
      blocks_.push_back(block);
      block_begins_.push_back(i);
    }
  }
  block_begins_.push_back(rows);
}

VectorXd Rows::dry(const Model& model) const {
  const double F = std::max(1e-6, model.p[kCoulomb]), x = std::exp(model.p[kPresliding]);
  const double over = model.p[kStiction] - 1.0, v_s = std::exp(model.p[kStribeck]);
  const double h = trace_.period_s;
  const double d = 2.0 * std::max(0.0, model.p[kDamping]) * std::sqrt(F / x * J_m_);
  std::vector<double> f(trace_.theta.size(), 0.0);
  for_each_part([&](std::size_t begin, std::size_t end) {
    std::array<double, kSlipElements> way{};
    for (std::size_t k = begin; k < end; ++k) {
      const double moved = k == begin ? 0.0 : trace_.theta[k] - trace_.theta[k - 1];
      const double share = speed_[k] / v_s;
      const double bound = std::max(1e-9, (F + model.p[kLoad] * std::abs(trace_.tau_J[k])) *
                                              (1.0 + over * std::exp(-share * share))) /
                           model.elements;
      for (int e = 0; e < model.elements; ++e) {
        const double s = F / (x * (e + 1)), damper = d / model.elements / h;
        double& z = way[e];
        const double stuck = s * (z + moved) + damper * moved;
        if (std::abs(stuck) <= bound) {
          z += moved;
          f[k] += stuck;
        } else {
          const double slips = std::copysign(bound, stuck);
          z = (slips + damper * z) / (s + damper);
          f[k] += slips;
        }
      }
    }
  });
  VectorXd rows(size());
  for (Eigen::Index i = 0; i < size(); ++i) rows[i] = smoothed(f, at_[i]);
  return rows;
}

MatrixXd Rows::linear() const {
  MatrixXd columns(size(), kParameters - kViscous);
  columns << v_, VectorXd::Ones(size()), tau_, J_m_ * ddtheta_;
  return columns;
}

int Rows::reversals() const {
  int count = 0;
  for_each_part([&](std::size_t begin, std::size_t end) {
    double low = trace_.theta[begin], high = low, peak = low;
    int direction = 0;
    for (std::size_t k = begin; k < end; ++k) {
      const double theta = trace_.theta[k];
      if (direction == 0) {
        low = std::min(low, theta);
        high = std::max(high, theta);
        if (high - low > kReversalWay) direction = theta == high ? 1 : -1;
        peak = theta;
      } else if (direction * (peak - theta) > kReversalWay) {
        ++count;
        direction = -direction;
        peak = theta;
      } else {
        peak = direction * std::max(direction * peak, direction * theta);
      }
    }
  });
  return count;
}

double Rows::smoothed(const std::vector<double>& x, std::size_t k) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < window_.size(); ++i) sum += window_[i] * x[k + i - kSmoothing];
  return sum;
}

double Rows::way(std::size_t k) const {
  const auto first = trace_.theta.begin() + static_cast<std::ptrdiff_t>(k - kSmoothing);
  const auto [low, high] = std::minmax_element(first, first + 2 * kSmoothing + 1);
  return *high - *low;
}

bool Rows::slides(std::size_t k) const {
  constexpr std::size_t kPart = 5;  // samples; an encoder shows no way from one to the next
  int direction = 0;
  for (std::size_t i = k - kSmoothing; i + kPart <= k + kSmoothing; i += kPart) {
    const double moved = trace_.theta[i + kPart] - trace_.theta[i];
    if (std::abs(moved) < kStill) return false;
    const int now = moved > 0.0 ? 1 : -1;
    if (direction != 0 && now != direction) return false;
    direction = now;
  }
  return true;
}

}  // namespace hg::identify::friction
