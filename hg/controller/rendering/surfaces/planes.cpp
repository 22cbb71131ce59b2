#include "hg/controller/rendering/surfaces/planes.h"

#include <Eigen/LU>
#include <algorithm>

namespace hg::surfaces {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kParallel = 1e-9;  // 1 - cosine; above the single precision of mesh files
constexpr double kFlat = 1e-12;     // m; smaller depths are no contact

}  // namespace

bool Planes::add(const Vector3d& normal, const Surface& surface, double damping,
                 int index) noexcept {
  for (int i = 0; i < count_; ++i) {
    Plane& plane = planes_[i];
    if (plane.normal.dot(normal) < 1.0 - kParallel) continue;
    plane = {normal, &surface, damping, index};
    return true;
  }
  if (count_ == 3) return false;
  planes_[count_++] = {normal, &surface, damping, index};
  return true;
}

// Shares s >= 0 of the normals N in the shortest way out: to_handle + N s is the nearest point with
// N^T x >= 0. The first set of planes that meets the optimality conditions of that point is the
// right one.
Vector3d Planes::shares(const Vector3d& to_handle) const noexcept {
  Matrix3d N = Matrix3d::Zero();
  for (int i = 0; i < count_; ++i) N.col(i) = planes_[i].normal;
  const Vector3d depths = -(N.transpose() * to_handle);
  const double rounding = 1e-11 * to_handle.norm();
  constexpr std::array<int, 8> kBySize = {0b000, 0b001, 0b010, 0b100, 0b011, 0b101, 0b110, 0b111};
  for (const int set : kBySize) {
    if (set >= 1 << count_) continue;
    // rows and columns outside the set are those of the identity
    Matrix3d G = Matrix3d::Identity();
    Vector3d wanted = Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      if ((set >> i & 1) == 0) continue;
      wanted[i] = depths[i];
      for (int j = 0; j < 3; ++j) {
        if ((set >> j & 1) != 0) G(i, j) = N.col(i).dot(N.col(j));
      }
    }
    if (std::abs(G.determinant()) < kParallel) continue;
    const Vector3d s = G.inverse() * wanted;
    const Vector3d left = N.transpose() * (to_handle + N * s);
    if (s.minCoeff() >= 0.0 && left.minCoeff() >= -rounding) return s;
  }
  // planes without a way out: the proxy stays, the deepest one pushes
  Eigen::Index deepest = 0;
  const double depth = depths.maxCoeff(&deepest);
  return std::max(0.0, depth) * Vector3d::Unit(deepest);
}

Spread Planes::spread(const Vector3d& handle, const Vector3d& proxy) const noexcept {
  Spread spread;
  const Vector3d s = shares(handle - proxy);
  Vector3d out = Vector3d::Zero();
  for (int i = 0; i < count_; ++i) out += s[i] * planes_[i].normal;
  spread.depth = out.norm();
  spread.tangent = proxy - (handle + out);
  if (spread.depth < kFlat) return spread;
  spread.normal = out / spread.depth;
  const double sum = s.sum();
  double largest = 0.0;
  for (int i = 0; i < count_; ++i) {
    const Plane& plane = planes_[i];
    const double share = s[i] / sum;
    spread.stiffness += share * plane.surface->stiffness;
    spread.damping += share * plane.damping;
    spread.friction += share * plane.surface->friction;
    if (share > largest) {
      spread.surface = plane.index;
      spread.catches = !plane.surface->damping;
    }
    largest = std::max(largest, share);
  }
  return spread;
}

Vector3d Planes::step(const Vector3d& handle, const Vector3d& proxy) const noexcept {
  const Spread now = spread(handle, proxy);
  const double held = now.friction * now.depth;
  const double length = now.tangent.norm();
  if (length <= held) return proxy;
  return proxy - (1.0 - held / length) * now.tangent;
}

}  // namespace hg::surfaces
