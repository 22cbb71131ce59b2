#include "hg/commissioning/generator/self_collision.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "hg/commissioning/generator/scaffold.h"
#include "hg/config/device.h"
#include "hg/core/test/temporary_folder.h"

namespace hg::generator {
namespace {

std::vector<Triangle> random_triangles(int count, const Eigen::Vector3d& size,
                                       const Eigen::Vector3d& place) {
  std::mt19937 random(7);
  const auto value = [&] { return static_cast<double>(random()) / 4294967295.0 - 0.5; };
  std::vector<Triangle> triangles(count);
  for (Triangle& t : triangles) {
    for (Eigen::Vector3d& p : t) {
      p = place + size.cwiseProduct(Eigen::Vector3d(value(), value(), value()));
    }
  }
  return triangles;
}

double farthest_outside(const Capsule& capsule, const std::vector<Triangle>& triangles) {
  double most = -kInfinity;
  for (const Triangle& t : triangles) {
    for (const Eigen::Vector3d& p : t) most = std::max(most, distance_to(capsule, p));
  }
  return most;
}

TEST(Capsules, ContainAllPoints) {
  for (const Eigen::Vector3d& size :
       {Eigen::Vector3d(1, 1, 1), {0.1, 0.1, 1}, {1, 1, 0.01}, {0, 0, 0.3}, {0, 0, 0}}) {
    const auto triangles = random_triangles(200, size, {0.3, -0.2, 5.0});
    EXPECT_LE(farthest_outside(fit_capsule(triangles), triangles), 0.0) << size.transpose();
  }
}

TEST(Capsules, OfARodIsTheRod) {
  std::vector<Triangle> rod;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * M_PI * i / 24, b = 2 * M_PI * (i + 1) / 24;
    rod.push_back({Eigen::Vector3d(0.05 * std::cos(a), 0.05 * std::sin(a), 0.0),
                   Eigen::Vector3d(0.05 * std::cos(b), 0.05 * std::sin(b), 0.8),
                   Eigen::Vector3d(0.05 * std::cos(a), 0.05 * std::sin(a), 0.8)});
  }
  const Capsule capsule = fit_capsule(rod);
  EXPECT_LT(capsule.radius, 0.055);
  EXPECT_NEAR((capsule.to - capsule.from).norm(), 0.8, 0.03);
}

// a bent link is parted at its bend: two capsules hold all of it in much less room
TEST(Capsules, OfABentLinkAreSmallerInTwoParts) {
  std::vector<Triangle> link = random_triangles(300, {0.08, 0.08, 0.5}, {0.0, 0.0, 0.25});
  for (const Triangle& t : random_triangles(300, {0.5, 0.08, 0.08}, {0.25, 0.0, 0.5})) {
    link.push_back(t);
  }
  const auto pieces = cut(link, 0.02);
  const auto [first, second] = split(pieces);
  const Capsule a = fit_capsule(first), b = fit_capsule(second);
  EXPECT_EQ(first.size() + second.size(), pieces.size());
  EXPECT_LE(farthest_outside(a, first), 0.0);
  EXPECT_LE(farthest_outside(b, second), 0.0);
  EXPECT_LT(volume_of(a) + volume_of(b), 0.6 * volume_of(fit_capsule(pieces)));
}

TEST(Capsules, CutTrianglesKeepTheirAreaAndAreSmall) {
  const std::vector<Triangle> large = {{Eigen::Vector3d::Zero(), {1, 0, 0}, {0, 0.5, 0}}};
  double area = 0.0;
  for (const Triangle& t : cut(large, 0.1)) {
    area += 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
    for (int i = 0; i < 3; ++i) EXPECT_LE((t[(i + 1) % 3] - t[i]).norm(), 0.1);
  }
  EXPECT_NEAR(area, 0.25, 1e-9);
}

// Six links of 0.3 m, each a bar of 80 mm; their joints turn about y and z by turns.
class MeshArm : public ::testing::Test {
 protected:
  MeshArm() {
    folder_.write("bar.stl", bar());
    std::string text = "<robot name=\"bars\">\n" + link("link0", "bar.stl");
    for (int i = 1; i <= 6; ++i) {
      text += link(fmt::format("link{}", i), "bar.stl");
      text += fmt::format(
          "<joint name=\"joint{0}\" type=\"revolute\"><parent link=\"link{1}\"/><child "
          "link=\"link{0}\"/><origin xyz=\"0 0 0.3\"/><axis xyz=\"{2}\"/><limit lower=\"-2.6\" "
          "upper=\"2.6\" velocity=\"2\" effort=\"100\"/></joint>\n",
          i, i - 1,
          i % 2 == 0 ? "0 1 0"
          : i == 1   ? "0 0 1"
                     : "1 0 0");
    }
    part_ = {folder_.write("bars.urdf", text + "</robot>\n"), "", ""};
  }

  static std::string link(const std::string& name, const std::string& mesh) {
    return fmt::format(
        "<link name=\"{}\"><inertial><mass value=\"1\"/><inertia ixx=\"0.01\" iyy=\"0.01\" "
        "izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial><collision><geometry><mesh "
        "filename=\"{}\"/></geometry></collision></link>\n",
        name, mesh);
  }

  // an open tube of four sides along z, as the text form of an STL
  static std::string bar() {
    std::string text = "solid bar\n";
    const double x[] = {0.04, -0.04, -0.04, 0.04, 0.04}, y[] = {0.04, 0.04, -0.04, -0.04, 0.04};
    const auto facet = [&](const std::string& a, const std::string& b, const std::string& c) {
      text += "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
              "\nendloop\nendfacet\n";
    };
    for (int i = 0; i < 4; ++i) {
      const auto corner = [&](int k, double z) { return fmt::format("{} {} {}", x[k], y[k], z); };
      facet(corner(i, 0.0), corner(i + 1, 0.0), corner(i, 0.26));
      facet(corner(i, 0.26), corner(i + 1, 0.0), corner(i + 1, 0.26));
    }
    return text + "endsolid bar\n";
  }

  std::string draft() const {
    return draft_device(part_, folder_.path(), Drives::kIdeal, "").device;
  }

  const TemporaryFolder folder_;
  ChainPart part_;
};

TEST_F(MeshArm, IsWatchedByCapsulesAroundItsMeshes) {
  const std::string text = draft();
  EXPECT_EQ(text, draft());
  EXPECT_NE(text.find("# fitted to bar.stl: "), std::string::npos);
  const config::DeviceConfig device = config::load_device(folder_.write("bars.yaml", text));
  const collision::CollisionConfig& config = device.collision;
  EXPECT_TRUE(device.unknown_links.empty());
  ASSERT_FALSE(config.pairs.watched.empty());
  EXPECT_LE(config.pairs.watched.size(), static_cast<std::size_t>(kDraftedPairs));
  for (const collision::Pair& pair : config.pairs.watched) {
    if (config.shapes[pair.a].is_surrounding || config.shapes[pair.b].is_surrounding) continue;
    EXPECT_GT(config.shapes[pair.b].body - config.shapes[pair.a].body, 1);  // no neighbours
  }
}

TEST_F(MeshArm, FoldedIsACollisionAndItsPostureIsNone) {
  const std::vector<Interval> ranges(6, Interval{-2.6, 2.6});
  const model::ChainModel chain = read_part(part_);
  const SelfCollision shapes = fit_self_collision(part_, chain, ranges, {}, {});
  model::ChainData posture(chain);
  posture.update_poses(Eigen::VectorXd::Zero(6));
  EXPECT_GT(smallest_distance(shapes, posture), 0.1);
  Eigen::VectorXd folded = Eigen::VectorXd::Zero(6);
  folded << 0.0, 2.4, 0.0, 2.4, 0.0, 0.0;
  posture.update_poses(folded);
  EXPECT_LT(smallest_distance(shapes, posture), 0.0);

  const config::DeviceConfig device = config::load_device(folder_.write("bars.yaml", draft()));
  posture.update_poses(device.model.posture);
  EXPECT_GT(smallest_distance(shapes, posture), 0.0);
}

TEST_F(MeshArm, WithoutItsMeshesIsToldSo) {
  std::filesystem::remove(folder_.path() / "bar.stl");
  const DeviceFiles files = draft_device(part_, folder_.path(), Drives::kIdeal, "");
  ASSERT_EQ(files.news.size(), 1u) << files.device;
  EXPECT_NE(files.news[0].find("bar.stl"), std::string::npos);
  EXPECT_EQ(files.device.find("capsules:"), std::string::npos);
}

}  // namespace
}  // namespace hg::generator
