/// Fixed-capacity vector and matrix types: sizes are chosen at set-up, storage never moves.
///
/// The capacities bound the devices and twins that the program accepts; set-up refuses larger ones.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "hg/core/fields.h"

namespace hg {

static_assert(EIGEN_MAX_ALIGN_BYTES <= 16,
              "types of Eigen travel between modules: compile without AVX, or the whole program "
              "with -DEIGEN_MAX_ALIGN_BYTES=16");

inline constexpr int kMaxGantry = 2;       ///< prepositioning joints
inline constexpr int kMaxManipulator = 7;  ///< manipulator joints
inline constexpr int kMaxTwin = 30;        ///< degrees of freedom of a twin
inline constexpr int kMaxTwinCoords =
    36;  ///< coordinates of a twin; a floating joint has 7 for 6 DOF
inline constexpr int kMaxVirtualJoints = 2;    ///< virtual joints: sums of manipulator joints
inline constexpr int kMaxCartesianFrames = 2;  ///< frames with Cartesian limits
inline constexpr int kMaxInertialUnits = 8;    ///< inertial units on links

template <int kCapacity>
using VectorUpTo = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kCapacity, 1>;
template <int kRows, int kCols>
using MatrixUpTo =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kRows, kCols>;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using VectorP = VectorUpTo<kMaxGantry>;             ///< chain p: prepositioning unit
using VectorM = VectorUpTo<kMaxManipulator>;        ///< chain m: manipulator
using VectorA = VectorUpTo<kMaxTwin>;               ///< chain a: twin, velocities and torques
using ConfigurationA = VectorUpTo<kMaxTwinCoords>;  ///< chain a: twin, coordinates q_a

/// Pose of a frame E relative to a frame B: p_B_E in m, R_B_E.
struct Pose {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
};

template <typename Archive, Is<Pose> T>
void fields(Archive& a, T& pose) {
  a("p", pose.p, "position", unit::kM);
  a("r", pose.R, "rotation matrix, row by row", unit::kNone);
}

Pose operator*(const Pose& a, const Pose& b);
Pose inverse(const Pose& a);

}  // namespace hg
