#include "hg/identify/pseudo_inertia.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "hg/core/interval.h"
#include "hg/identify/scaled_inverse.h"

namespace hg::identify {
namespace {

using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// dP / dp_i
const std::array<Matrix4d, kLinkParameters>& directions() {
  static const auto kDirections = [] {
    std::array<Matrix4d, kLinkParameters> result;
    for (Eigen::Index i = 0; i < kLinkParameters; ++i) {
      result[static_cast<std::size_t>(i)] = pseudo_inertia(LinkParameters::Unit(i));
    }
    return result;
  }();
  return kDirections;
}

// Value, gradient and Hessian of tr(P_0^-1 P) - ln det P summed over all links; infinite outside.
struct Divergence {
  double value = 0.0;
  VectorXd gradient;
  MatrixXd hessian;
};

Divergence divergence(const VectorXd& p, const VectorXd& nominal) {
  Divergence d = {0.0, VectorXd::Zero(p.size()), MatrixXd::Zero(p.size(), p.size())};
  for (Eigen::Index link = 0; link < p.size(); link += kLinkParameters) {
    const Matrix4d P = pseudo_inertia(p.segment<kLinkParameters>(link));
    const Matrix4d inverse_0 = pseudo_inertia(nominal.segment<kLinkParameters>(link)).inverse();
    const Eigen::LLT<Matrix4d> factors(P);
    if (factors.info() != Eigen::Success) {
      d.value = kInfinity;
      return d;
    }
    const Matrix4d inverse = factors.solve(Matrix4d::Identity());
    d.value += (inverse_0 * P).trace() - 2.0 * factors.matrixLLT().diagonal().array().log().sum();
    for (Eigen::Index i = 0; i < kLinkParameters; ++i) {
      const Matrix4d& E_i = directions()[static_cast<std::size_t>(i)];
      d.gradient[link + i] = ((inverse_0 - inverse) * E_i).trace();
      const Matrix4d turned = inverse * E_i * inverse;
      for (Eigen::Index k = 0; k < kLinkParameters; ++k) {
        d.hessian(link + i, link + k) =
            (turned * directions()[static_cast<std::size_t>(k)]).trace();
      }
    }
  }
  return d;
}

}  // namespace

Matrix4d pseudo_inertia(const LinkParameters& p) {
  const Eigen::Matrix3d I = inertia_about_origin(p);
  Matrix4d P;
  P.topLeftCorner<3, 3>() = 0.5 * I.trace() * Eigen::Matrix3d::Identity() - I;
  P.topRightCorner<3, 1>() = p.segment<3>(1);
  P.bottomLeftCorner<1, 3>() = p.segment<3>(1).transpose();
  P(3, 3) = p[0];
  return P;
}

ConsistentParameters consistent_parameters(const VectorXd& base, const MatrixXd& information,
                                           const MatrixXd& combination, const VectorXd& nominal) {
  constexpr double kWeight = 1.0 / (kUrdfTrust * kUrdfTrust);
  constexpr int kMostRounds = 100;
  const MatrixXd weighted = combination.transpose() * information;
  const MatrixXd H_data = weighted * combination;
  const auto cost = [&](const VectorXd& p, const Divergence& d) {
    const VectorXd r = combination * p - base;
    return 0.5 * r.dot(information * r) + kWeight * d.value;
  };
  ConsistentParameters result = {nominal, {}, {}};
  Divergence d = divergence(result.p, nominal);
  result.prior = scaled_inverse(kWeight * d.hessian);
  double least = cost(result.p, d);
  for (int round = 0; round < kMostRounds; ++round) {
    const VectorXd gradient = weighted * (combination * result.p - base) + kWeight * d.gradient;
    const MatrixXd inverse = scaled_inverse(H_data + kWeight * d.hessian);
    const VectorXd step = -inverse * gradient;
    const double slope = gradient.dot(step);
    if (-slope < 1e-9) break;
    double length = 1.0;
    for (; length > 1e-8; length *= 0.5) {
      const VectorXd next = result.p + length * step;
      const Divergence there = divergence(next, nominal);
      const double tried = cost(next, there);
      if (!(tried < least + 1e-4 * length * slope)) continue;
      result.p = next;
      d = there;
      least = tried;
      break;
    }
    if (length <= 1e-8) break;
  }
  result.covariance = scaled_inverse(H_data + kWeight * d.hessian);
  return result;
}

}  // namespace hg::identify
