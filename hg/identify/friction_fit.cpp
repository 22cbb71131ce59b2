#include "hg/identify/friction_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "hg/core/interval.h"

namespace hg::identify::friction {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kHuber = 1.5;  // deviations from which on a residual counts less
// Largest inflation of a variance before two effects are indistinguishable
constexpr double kMostInflation = 1e3;
constexpr double kGainPrior = 0.02, kInertiaPrior = 0.2;  // deviations of sensors and rotor

VectorXd weights_of(const VectorXd& residuals, double deviation) {
  return residuals.unaryExpr([&](double r) {
    const double size = std::abs(r) / deviation;
    return size <= kHuber ? 1.0 : kHuber / size;
  });
}

// Sum of Huber's losses, in squared deviations.
double loss_of(const VectorXd& residuals, double deviation) {
  double sum = 0.0;
  for (const double r : residuals) {
    const double size = std::abs(r) / deviation;
    sum += size <= kHuber ? 0.5 * size * size : kHuber * (size - 0.5 * kHuber);
  }
  return sum;
}

}  // namespace

double deviation_of(const VectorXd& residuals) {
  std::vector<double> sizes;
  for (const double r : residuals) {
    if (r != 0.0) sizes.push_back(std::abs(r));
  }
  if (sizes.empty()) return 1e-9;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return std::max(1e-9, 1.4826 * *middle);
}

VectorXd Fit::residuals(const Model& model) const {
  return counts_.cwiseProduct(rows_.y() - rows_.dry(model) -
                              linear_ * model.p.tail<kParameters - kViscous>());
}

double Fit::rms(const Model& model) const {
  return std::sqrt(residuals(model).squaredNorm() / std::max(1.0, counts_.sum()));
}

double Fit::solve_linear(Model& model, const Free& free, double& deviation) const {
  const double ratio = model.p[kLoad] / model.p[kCoulomb];
  MatrixXd A(rows_.size(), 1 + linear_.cols());
  A << rows_.dry(model) / model.p[kCoulomb], linear_;
  A = counts_.asDiagonal() * A;
  VectorXd y = counts_.cwiseProduct(rows_.y());
  if (!free[kViscous]) {
    y -= model.p[kViscous] * A.col(1);
    A.col(1).setZero();
  }
  VectorXd w = VectorXd::Ones(rows_.size()), x;
  for (int round = 0; round < 4; ++round) {
    const MatrixXd W_A = w.asDiagonal() * A;
    MatrixXd H = A.transpose() * W_A;
    H.diagonal().array() += 1e-9 * H.trace();
    H(3, 3) += precision(kGainPrior, deviation);
    H(4, 4) += precision(kInertiaPrior, deviation);
    x = H.ldlt().solve(W_A.transpose() * y);
    const VectorXd r = y - A * x;
    if (deviation <= 0.0 || round == 0) deviation = deviation_of(r);
    w = weights_of(r, deviation);
  }
  model.p[kCoulomb] = std::max(1e-3, x[0]);
  model.p[kLoad] = ratio * model.p[kCoulomb];
  if (free[kViscous]) model.p[kViscous] = x[1];
  model.p.tail<3>() = x.tail<3>();
  return loss_of(y - A * x, deviation);
}

double Fit::improve(Model& model, const Free& free, double deviation) const {
  double loss = total(model, deviation), damping = 1e-3;
  for (int round = 0; round < 40; ++round) {
    const Normal normal = normal_of(model, free, deviation);
    bool is_better = false;
    double gained = 0.0;
    for (int attempt = 0; attempt < 8 && !is_better; ++attempt) {
      MatrixXd H = normal.H;
      H.diagonal() *= 1.0 + damping;
      H.diagonal().array() += 1e-12 * H.trace();
      const VectorXd step = H.ldlt().solve(normal.g);
      Model next = model;
      for (std::size_t i = 0; i < normal.of.size(); ++i) {
        next.p[normal.of[i]] += step[i];
      }
      confine(next);
      const double tried = total(next, deviation);
      is_better = tried < loss;
      damping *= is_better ? 0.2 : 6.0;
      if (!is_better) continue;
      gained = loss - tried;
      model = next;
      loss = tried;
    }
    if (!is_better || gained < 1e-6 * loss) break;
  }
  return loss;
}

Parameters Fit::deviations(const Model& model, const Free& free, double deviation) const {
  const Normal normal = normal_of(model, free, deviation);
  const auto count = static_cast<Eigen::Index>(normal.of.size());
  const std::vector<Eigen::Index>& begins = rows_.block_begins();
  const std::size_t blocks = begins.size() - 1;
  MatrixXd steps(count, blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    const Eigen::Index first = begins[b], rows = begins[b + 1] - first;
    const auto J = normal.J.middleRows(first, rows);
    const MatrixXd W_J = normal.w.segment(first, rows).asDiagonal() * J;
    MatrixXd H = normal.H - J.transpose() * W_J;
    H.diagonal().array() += 1e-9 * H.trace() / static_cast<double>(count);
    steps.col(b) = H.ldlt().solve(normal.g - W_J.transpose() * normal.r.segment(first, rows));
  }
  const VectorXd mean = steps.rowwise().mean();
  const VectorXd sum = (steps.colwise() - mean).rowwise().squaredNorm();
  const VectorXd inflation = inflation_of(normal.H);
  Parameters result = Parameters::Zero();
  for (std::size_t i = 0; i < normal.of.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double share = static_cast<double>(blocks - 1) / static_cast<double>(blocks);
    result[normal.of[i]] = inflation[at] < kMostInflation ? std::sqrt(share * sum[at]) : kInfinity;
  }
  return result;
}

double Fit::precision(double prior, double deviation) const {
  const double scaled = std::max(deviation, 1e-9) / prior;
  const auto blocks = static_cast<double>(rows_.block_begins().size() - 1);
  return scaled * scaled * static_cast<double>(rows_.size()) / blocks;
}

VectorXd Fit::inflation_of(const MatrixXd& H) {
  const VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
  scaled.diagonal().array() += 1e-12;
  VectorXd inflation = scaled.ldlt().solve(MatrixXd::Identity(H.rows(), H.cols())).diagonal();
  for (Eigen::Index i = 0; i < inflation.size(); ++i) {
    const bool shows = H(i, i) > 1e-20 * H.diagonal().maxCoeff();
    if (!shows || !(inflation[i] > 0.0)) inflation[i] = kInfinity;
  }
  return inflation;
}

double Fit::total(const Model& model, double deviation) const {
  const double gain = model.p[kGain], inertia = model.p[kInertia], scale = deviation * deviation;
  return loss_of(residuals(model), deviation) +
         0.5 / scale *
             (precision(kGainPrior, deviation) * gain * gain +
              precision(kInertiaPrior, deviation) * inertia * inertia);
}

void Fit::confine(Model& model) {
  Parameters& p = model.p;
  p[kCoulomb] = std::max(p[kCoulomb], 1e-3);
  p[kLoad] = std::clamp(p[kLoad], 0.0, 1.0);
  p[kStiction] = std::clamp(p[kStiction], 1.0, 4.0);
  p[kStribeck] = std::clamp(p[kStribeck], std::log(2e-3), std::log(0.3));
  p[kPresliding] = std::clamp(p[kPresliding], std::log(kRigid), std::log(0.01));
  p[kDamping] = std::clamp(p[kDamping], 0.0, 2.0);
  p[kViscous] = std::max(p[kViscous], 0.0);
}

Fit::Normal Fit::normal_of(const Model& model, const Free& free, double deviation) const {
  constexpr double kStep = 1e-3;
  Normal normal;
  normal.r = residuals(model);
  normal.w = weights_of(normal.r, deviation).cwiseProduct(counts_);
  for (int i = 0; i < kParameters; ++i) {
    if (free[i]) normal.of.push_back(i);
  }
  const auto count = static_cast<Eigen::Index>(normal.of.size());
  normal.J.resize(rows_.size(), count);
  const VectorXd dry = rows_.dry(model);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int parameter = normal.of[i];
    if (parameter >= kViscous) {
      normal.J.col(i) = linear_.col(parameter - kViscous);
      continue;
    }
    Model more = model;
    const double step = parameter == kCoulomb ? kStep * model.p[kCoulomb] : kStep;
    more.p[parameter] += step;
    normal.J.col(i) = (rows_.dry(more) - dry) / step;
  }
  const MatrixXd W_J = normal.w.asDiagonal() * normal.J;
  normal.H = normal.J.transpose() * W_J;
  normal.g = W_J.transpose() * normal.r;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int parameter = normal.of[i];
    if (parameter != kGain && parameter != kInertia) continue;
    const double more = precision(parameter == kGain ? kGainPrior : kInertiaPrior, deviation);
    normal.H(i, i) += more;
    normal.g[i] -= more * model.p[parameter];
  }
  return normal;
}

}  // namespace hg::identify::friction
