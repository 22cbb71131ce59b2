#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "hg/new/clearance.h"
#include "hg/new/self_collision.h"

namespace hg::new_files {
namespace {

std::string numbers(const Eigen::Vector3d& p) {
  return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
}

std::string files_of(const FittedBody& body) {
  if (body.files.empty()) return "the primitives of the URDF";
  if (body.files.size() == 1) return body.files.front();
  return fmt::format("{} and {} more", body.files.front(), body.files.size() - 1);
}

std::string capsule_lines(const FittedBody& body) {
  std::string text = fmt::format("    # fitted to {}: {:.0f} mm outside at most\n", files_of(body),
                                 std::ceil(1e3 * body.stands_out));
  for (std::size_t i = 0; i < body.capsules.size(); ++i) {
    const Capsule& capsule = body.capsules[i];
    text += fmt::format("    - {{name: {}, link: {}, from_m: {}, to_m: {}, radius_m: {:.4f}}}\n",
                        quoted(fmt::format("{}_{}", body.link, i + 1)), quoted(body.link),
                        numbers(capsule.from), numbers(capsule.to), capsule.radius);
  }
  return text;
}

std::string reason_of(const CrowdedPair& pair) {
  const std::string touching =
      pair.touch > 0.0 ? fmt::format("in {:.1f} %", 100.0 * pair.touch) : "in none that was tried";
  return fmt::format(
      "within {:g} mm in {:.0f} % of the postures, the meshes in them within {:g} mm "
      "{}",
      1e3 * kCrowded, std::floor(100.0 * pair.near), 1e3 * kMeshMargin, touching);
}

std::string unwatched_lines(const SelfCollision& shapes) {
  if (shapes.apart.empty() && shapes.parts_apart.empty() && shapes.crowded.empty()) return "";
  std::string text = fmt::format(
      "  unwatched:  # [V] without a reason: their meshes stay {:g} mm apart\n", 1e3 * kMeshMargin);
  for (const ApartPair& pair : shapes.apart) {
    text += fmt::format("    - {{links: [{}, {}]}}\n", quoted(pair.a), quoted(pair.b));
  }
  for (const ApartPair& pair : shapes.parts_apart) {
    text += fmt::format("    - {{capsules: [{}, {}]}}\n", quoted(pair.a), quoted(pair.b));
  }
  for (const CrowdedPair& pair : shapes.crowded) {
    text += fmt::format("    - {{capsules: [{}, {}]}}  # {}\n", quoted(pair.a), quoted(pair.b),
                        reason_of(pair));
  }
  return text;
}

std::string summary_of(const SelfCollision& shapes) {
  std::size_t capsules = 0;
  double most = 0.0;
  for (const FittedBody& body : shapes.bodies) {
    capsules += body.capsules.size();
    most = std::max(most, body.stands_out);
  }
  return fmt::format(
      "self-collision: {} capsules around the meshes, at most {:.0f} mm outside; {} pairs are "
      "watched; {} pairs of bodies and {} of capsules are not, their meshes stay {:g} mm apart",
      capsules, std::ceil(1e3 * most), shapes.pairs.watched.size(), shapes.apart.size(),
      shapes.parts_apart.size(), 1e3 * kMeshMargin);
}

// Names of mesh files; primitives have none.
std::string names_of(const FittedBody& body) {
  return body.files.empty() ? "its shape" : fmt::format("{}", fmt::join(body.files, ", "));
}

}  // namespace

std::string collision_lines(const SelfCollision& shapes) {
  if (shapes.bodies.empty()) return "";
  std::string text = fmt::format(
      "\ncollision:  # [V] capsules around the meshes of the URDF\n"
      "  safe_distance_m: {:g}  # [A] the capsules stand out of the meshes already\n"
      "  capsules:\n",
      shapes.safe_distance);
  for (const FittedBody& body : shapes.bodies) text += capsule_lines(body);
  return text + unwatched_lines(shapes);
}

std::vector<std::string> news_of(const SelfCollision& shapes) {
  std::vector<std::string> news;
  if (!shapes.bodies.empty()) news.push_back(summary_of(shapes));
  for (const CrowdedPair& pair : shapes.crowded) {
    news.push_back(
        fmt::format("self-collision: {} and {} are not watched, the arm could hardly move: {}",
                    pair.a, pair.b, reason_of(pair)));
  }
  if (!shapes.unread.empty()) {
    news.push_back(fmt::format(
        "self-collision: {} meshes are missing or cannot be read and are not watched, the first "
        "is {}; ROS_PACKAGE_PATH is searched for packages",
        shapes.unread.size(), shapes.unread.front()));
  }
  return news;
}

std::vector<std::string> doubts_of(const SelfCollision& shapes) {
  constexpr double kLargest = 10.0, kSmallest = 1e-3;  // m
  std::vector<std::string> doubts;
  for (const FittedBody& body : shapes.bodies) {
    if (body.size > kLargest) {
      doubts.push_back(fmt::format(
          "link {}: {} is {:.3g} m large: millimetres? <mesh scale=\"0.001 0.001 0.001\"> makes it "
          "{:.3g} m",
          body.link, names_of(body), body.size, 1e-3 * body.size));
    } else if (body.size < kSmallest) {
      doubts.push_back(fmt::format("link {}: {} is smaller than 1 mm: is its scale right?",
                                   body.link, names_of(body)));
    }
  }
  return doubts;
}

}  // namespace hg::new_files
