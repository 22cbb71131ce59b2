#include "hg/new/self_collision.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "hg/config/device.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/model/urdf.h"
#include "hg/new/bodies.h"
#include "hg/new/clearance.h"
#include "hg/new/scaffold.h"
#include "hg/workspace/postures.h"

namespace hg::new_files {
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
  const auto pieces = cut(link, 0.06);
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

// Six links whose joints turn about y and x by turns; every second one is a bar of 150 mm.
class MeshArm : public ::testing::Test {
 protected:
  MeshArm() {
    folder_.write("bar.stl", bar());
    part_ = arm(0.18, 0.18);
  }

  // `shoulder`, `wrist`: lengths of the first and fifth link, m, each between two bars; `scale` of
  // the meshes
  ChainPart arm(double shoulder, double wrist, const std::string& scale = "1 1 1") const {
    std::string text = "<robot name=\"bars\">\n" + link(0, scale);
    for (int i = 1; i <= 6; ++i) {
      text += link(i, scale);
      text += fmt::format(
          "<joint name=\"joint{0}\" type=\"revolute\"><parent link=\"link{1}\"/><child "
          "link=\"link{0}\"/><origin xyz=\"0 0 {3}\"/><axis xyz=\"{2}\"/><limit lower=\"-2.6\" "
          "upper=\"2.6\" velocity=\"2\" effort=\"100\"/></joint>\n",
          i, i - 1,
          i % 2 == 0 ? "0 1 0"
          : i == 1   ? "0 0 1"
                     : "1 0 0",
          i == 2   ? shoulder
          : i == 6 ? wrist
                   : 0.18);
    }
    return {folder_.write("bars.urdf", text + "</robot>\n"), "", ""};
  }

  static std::string link(int i, const std::string& scale) {
    const std::string mesh = "<collision><geometry><mesh filename=\"bar.stl\" scale=\"" + scale +
                             "\"/></geometry></collision>";
    return fmt::format(
        "<link name=\"link{}\"><inertial><mass value=\"1\"/><inertia ixx=\"0.01\" iyy=\"0.01\" "
        "izz=\"0.01\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>{}</link>\n",
        i, i % 2 == 0 ? mesh : "");
  }

  // an open tube of four sides along z, as the text form of an STL
  static std::string bar() {
    std::string text = "solid bar\n";
    const double x[] = {0.025, -0.025, -0.025, 0.025, 0.025},
                 y[] = {0.025, 0.025, -0.025, -0.025, 0.025};
    const auto facet = [&](const std::string& a, const std::string& b, const std::string& c) {
      text += "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
              "\nendloop\nendfacet\n";
    };
    for (int i = 0; i < 4; ++i) {
      const auto corner = [&](int k, double z) { return fmt::format("{} {} {}", x[k], y[k], z); };
      facet(corner(i, 0.0), corner(i + 1, 0.0), corner(i, 0.15));
      facet(corner(i, 0.15), corner(i + 1, 0.0), corner(i + 1, 0.15));
    }
    return text + "endsolid bar\n";
  }

  DeviceFiles draft() const { return draft_device(part_, folder_.path(), Drives::kIdeal, ""); }

  std::vector<Body> bodies(const model::ChainModel& chain) const {
    const model::Urdf urdf = model::read_urdf_file(part_.urdf);
    std::vector<std::string> unread;
    std::vector<Body> bodies = read_bodies(part_, urdf, chain, unread);
    for (Body& body : bodies) begin_with_one(body);
    return bodies;
  }

  const std::vector<Interval> ranges_ = std::vector<Interval>(6, Interval{-2.6, 2.6});
  const TemporaryFolder folder_;
  ChainPart part_;
};

TEST_F(MeshArm, IsWatchedByCapsulesAroundItsMeshes) {
  const std::string text = draft().device;
  EXPECT_NE(text.find("# fitted to bar.stl: "), std::string::npos);
  const config::DeviceConfig device = config::load_device(folder_.write("bars.yaml", text));
  const collision::CollisionConfig& config = device.collision;
  ASSERT_FALSE(config.pairs.watched.empty());
  EXPECT_LE(config.pairs.watched.size(), static_cast<std::size_t>(kDraftedPairs));
  for (const collision::Pair& pair : config.pairs.watched) {
    const collision::Shape &a = config.shapes[pair.a], &b = config.shapes[pair.b];
    EXPECT_GT(b.body - a.body, 1);  // no neighbours
  }
  const collision::Nearest shapes(config.shapes, config.pairs.watched);
  model::ChainData posture(device.model.chain);
  posture.update_poses(device.model.posture);
  EXPECT_GE(shapes.distance(posture), 0.06);
}

TEST_F(MeshArm, MeshesOfAnotherUnitAreDoubted) {
  EXPECT_TRUE(draft().doubts.empty());
  const auto doubt_with = [&](const char* scale) {
    part_ = arm(0.18, 0.18, scale);
    const std::vector<std::string> doubts = draft().doubts;
    return doubts.empty() ? "" : doubts.front();
  };
  EXPECT_NE(doubt_with("1000 1000 1000").find("link link0: bar.stl is 166 m large: millimetres?"),
            std::string::npos);
  EXPECT_NE(doubt_with("0 0 0").find("smaller than 1 mm"), std::string::npos);
}

TEST_F(MeshArm, IsWatchedWhereItFoldsOrReachesForTheFloor) {
  const model::ChainModel chain = read_part(part_);
  const SelfCollision shapes = fit_self_collision(part_, chain, ranges_, -0.1, {});
  EXPECT_LE(shapes.pairs.watched.size(), static_cast<std::size_t>(kDraftedPairs));
  const collision::Nearest nearest(shapes.shapes, shapes.pairs.watched);
  model::ChainData posture(chain);
  const auto distance = [&](double q_2, double q_4) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
    q[1] = q_2;
    q[3] = q_4;
    posture.update_poses(q);
    return nearest.distance(posture);
  };
  EXPECT_GT(distance(0.0, 0.0), 0.1);
  EXPECT_LT(distance(2.1, 2.1), 0.0);  // a triangle: the fourth link lies on the first
  EXPECT_LT(distance(2.5, 0.0), 0.0);  // straight into the floor
}

TEST_F(MeshArm, OfTheSameFilesHasTheSameCapsules) {
  const model::ChainModel model = read_part(part_);
  const std::vector<Body> once = bodies(model), again = bodies(model);
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].parts[0].capsule.from, again[i].parts[0].capsule.from);
    EXPECT_EQ(once[i].parts[0].capsule.radius, again[i].parts[0].capsule.radius);
  }
}

// Where an answer is wrong, a sampled posture shows it.
TEST_F(MeshArm, IsProvenNotToTouchOnlyWhereItDoesNot) {
  for (const double shoulder : {0.18, 0.03}) {
    part_ = arm(shoulder, 0.18);
    const model::ChainModel model = read_part(part_);
    const std::vector<Body> all = bodies(model);
    ASSERT_EQ(all.size(), 4u);
    Clearance clearance(model, ranges_);
    EXPECT_EQ(clearance.is_proven(all[0], 0, all[1], 0), shoulder > 0.1);
    EXPECT_FALSE(clearance.is_proven(all[0], 0, all[2], 0));  // four joints between them

    model::ChainData chain(model);
    workspace::PostureSampler sampler(ranges_);
    int touching = 0;
    for (int n = 0; n < 400; ++n) {
      chain.update_poses(sampler.draw());
      touching += touches(all[0].parts[0], pose_of(chain, all[0].frame), all[1].parts[0],
                          pose_of(chain, all[1].frame));
    }
    EXPECT_EQ(touching > 0, shoulder < 0.1) << touching;
  }
}

// The hand of a short wrist is close to the bar before it, and yet is watched.
TEST_F(MeshArm, LeavesSingleCapsulesOutThatAreAlwaysNear) {
  part_ = arm(0.18, 0.04);
  const DeviceFiles files = draft();
  const auto reported = std::ranges::count_if(files.news, [](const std::string& line) {
    return line.find("link4_") != std::string::npos && line.find("link6_") != std::string::npos &&
           line.find("are not watched, the arm could hardly move: ") != std::string::npos;
  });
  EXPECT_GT(reported, 0) << files.device;
  const config::DeviceConfig device = config::load_device(folder_.write("bars.yaml", files.device));
  const std::vector<std::string> watched = collision::pair_names(device.collision);
  const auto between = std::ranges::count_if(watched, [](const std::string& pair) {
    return pair.starts_with("link4_") && pair.find(" - link6_") != std::string::npos;
  });
  EXPECT_GT(between, 0) << files.device;
}

TEST_F(MeshArm, WithoutItsMeshesIsReported) {
  std::filesystem::remove(folder_.path() / "bar.stl");
  const DeviceFiles files = draft();
  ASSERT_EQ(files.news.size(), 1u) << files.device;
  EXPECT_NE(files.news[0].find("bar.stl"), std::string::npos);
  EXPECT_EQ(files.device.find("capsules:"), std::string::npos);
}

}  // namespace
}  // namespace hg::new_files
