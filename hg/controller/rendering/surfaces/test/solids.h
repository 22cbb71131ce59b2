/// Solids that the tests of virtual surfaces share, and an independent judge of what is inside.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "hg/controller/rendering/surfaces/environment.h"

namespace hg::surfaces {

using Eigen::Vector3d;

inline constexpr double kDt = 1e-3;
inline const Vector3d kNoPush = Vector3d::Zero();
inline constexpr double kBody = 3.0;  // kg, of what meets them

/// The twelve triangles of a box, outwards.
inline Mesh box_mesh(const Vector3d& size) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3d n = side * Vector3d::Unit(axis), u = Vector3d::Unit((axis + 1) % 3),
                     v = n.cross(u);
      const auto corner = [&](double a, double b) -> Vector3d {
        return 0.5 * size.cwiseProduct(n + a * u + b * v);
      };
      triangles.push_back({corner(-1, -1), corner(1, -1), corner(1, 1)});
      triangles.push_back({corner(-1, -1), corner(1, 1), corner(-1, 1)});
    }
  }
  return Mesh(triangles);
}

/// An octahedron whose triangles were cut into four `times`, on a ball: 8 * 4^times of them.
inline Mesh ball_mesh(int times, double radius = 0.1) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (int i = 0; i < 8; ++i) {
    const double x = (i & 1) != 0 ? -1 : 1, y = (i & 2) != 0 ? -1 : 1, z = (i & 4) != 0 ? -1 : 1;
    const Vector3d a(x, 0, 0), b(0, y, 0), c(0, 0, z);
    if (x * y * z > 0.0) {
      triangles.push_back({a, b, c});
    } else {
      triangles.push_back({a, c, b});
    }
  }
  for (int k = 0; k < times; ++k) {
    std::vector<std::array<Vector3d, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vector3d ab = (a + b).normalized(), bc = (b + c).normalized(),
                     ca = (c + a).normalized();
      for (const std::array<Vector3d, 3>& each :
           {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
        finer.push_back(each);
      }
    }
    triangles = finer;
  }
  for (auto& corners : triangles) {
    for (Vector3d& corner : corners) corner *= radius;
  }
  return Mesh(triangles);
}

inline Vector3d random_in(std::mt19937& random, double half) {
  std::uniform_real_distribution<double> any(-half, half);
  return {any(random), any(random), any(random)};
}

inline Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> any;
  const Eigen::Quaterniond q(any(random), any(random), any(random), any(random));
  return {random_in(random, 0.3), q.normalized().toRotationMatrix()};
}

/// How deep `p` is inside a surface, negative outside; by distances, not by ways.
inline double depth_in(const Surface& surface, const Vector3d& p_B, const Vector3d& mesh_size) {
  const Vector3d p = surface.pose.R.transpose() * (p_B - surface.pose.p);
  if (std::holds_alternative<Plane>(surface.shape)) return -p.z();
  if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) return sphere->radius - p.norm();
  if (const auto* cylinder = std::get_if<Cylinder>(&surface.shape)) {
    return std::min(cylinder->radius - p.head<2>().norm(),
                    0.5 * cylinder->length - std::abs(p.z()));
  }
  const auto* box = std::get_if<Box>(&surface.shape);
  return (0.5 * (box != nullptr ? box->size : mesh_size) - p.cwiseAbs()).minCoeff();
}

/// A handle that is led along a way.
struct Led {
  Environment environment;
  EnvironmentState state;

  explicit Led(std::vector<Surface> surfaces)
      : environment(std::move(surfaces), kDt, {kBody, kBody}) {}
  /// At rest there.
  ContactReport at(const Vector3d& p) {
    return environment.step(p, Vector3d::Zero(), kNoPush, state);
  }
  /// Slowly from where it was led last.
  ContactReport to(const Vector3d& p, double step = 1e-4) {
    const Vector3d from = last;
    const int steps = std::max(1, static_cast<int>(std::ceil((p - from).norm() / step)));
    ContactReport contact;
    for (int i = 1; i <= steps; ++i) contact = at(from + (p - from) * i / steps);
    last = p;
    return contact;
  }
  Vector3d last = Vector3d::Zero();
};

}  // namespace hg::surfaces
