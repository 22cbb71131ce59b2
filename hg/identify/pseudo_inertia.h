/// Inertial parameters of links that are those of real bodies, from what a recording determines and
/// what the URDF says.
///
/// A body has a positive density everywhere if and only if its pseudo-inertia is positive definite
/// (Wensing, Kim, Slotine, RA-L 2018):
///   P = [ tr(I)/2 E - I   m c ; (m c)^T   m ],  I about the origin
/// The estimate minimises, convex in the parameters (Lee, Wensing, Park, T-RO 2020),
///   1/2 (C p - b)^T L (C p - b) + 1 / s^2 sum over links of tr(P_0^-1 P) - ln det P
/// with the base parameters b = C p of the recording, their information L, and P_0 of the URDF. The
/// second part never lets P leave the positive definite ones. Newton's method. SI units.
#pragma once

#include <Eigen/Core>

#include "hg/identify/inertia_model.h"

namespace hg::identify {

/// How far the URDF is trusted: deviation s of the principal values of P, as a share, [A]
inline constexpr double kUrdfTrust = 0.2;

Eigen::Matrix4d pseudo_inertia(const LinkParameters& parameters);

struct ConsistentParameters {
  Eigen::VectorXd p;           ///< parameters of all links
  Eigen::MatrixXd covariance;  ///< with the recording
  Eigen::MatrixXd prior;       ///< covariance without it
};

/// `base`: estimate of C p, `information`: inverse of its covariance, `combination`: C, `nominal`:
/// the parameters of the URDF, each with a positive definite P.
ConsistentParameters consistent_parameters(const Eigen::VectorXd& base,
                                           const Eigen::MatrixXd& information,
                                           const Eigen::MatrixXd& combination,
                                           const Eigen::VectorXd& nominal);

}  // namespace hg::identify
