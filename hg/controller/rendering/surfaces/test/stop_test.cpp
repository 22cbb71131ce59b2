// The planes in front of surfaces that are met like a stop.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hg/controller/rendering/surfaces/test/solids.h"
#include "hg/core/test/message_of.h"

namespace hg::surfaces {
namespace {

constexpr double kBraking = 3.0;  // m/s^2
constexpr double kRounding = 1e-9;

Surface stop(Shape shape, const Vector3d& at = Vector3d::Zero()) {
  return {.name = "stop", .shape = std::move(shape), .pose = {.p = at}, .contact = Contact::kStop};
}

std::vector<Facing> planes(const std::vector<Surface>& surfaces, const Vector3d& p,
                           const Vector3d& velocity = Vector3d::Zero()) {
  const Environment environment(surfaces, kDt, {kBody, kBody});
  std::vector<Facing> found;
  for (const Facing& plane : environment.stops(p, velocity, kBraking)) {
    if (plane.surface >= 0) found.push_back(plane);
  }
  return found;
}

bool has_plane(const std::vector<Facing>& planes, const Vector3d& normal, double distance) {
  return std::ranges::any_of(planes, [&](const Facing& plane) {
    return plane.normal.dot(normal) > 0.999 && std::abs(plane.distance - distance) < kRounding;
  });
}

// Several boxes in one mesh.
Mesh boxes(const std::vector<Eigen::AlignedBox3d>& all) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const Eigen::AlignedBox3d& box : all) {
    const Mesh one = box_mesh(box.sizes());
    for (Triangle triangle : one.triangles()) {
      for (Vector3d& corner : triangle.corners) corner += box.center();
      triangles.push_back(triangle.corners);
    }
  }
  return Mesh(triangles);
}

// A step of 2 mm down from x = 0 on, as one solid.
Mesh step_down() {
  const double low = -0.002, bottom = -0.1;
  const std::vector<Eigen::Vector2d> outline = {{-0.3, bottom}, {0.3, bottom}, {0.3, low},
                                                {0.0, low},     {0.0, 0.0},    {-0.3, 0.0}};
  const std::vector<std::array<int, 3>> front = {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  const auto at = [&](std::size_t i, double y) {
    return Vector3d(outline[i].x(), y, outline[i].y());
  };
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const auto& [a, b, c] : front) {
    const std::size_t i = a, j = b, k = c;
    triangles.push_back({at(i, -0.2), at(j, -0.2), at(k, -0.2)});
    triangles.push_back({at(i, 0.2), at(k, 0.2), at(j, 0.2)});
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t j = (i + 1) % outline.size();
    triangles.push_back({at(i, -0.2), at(i, 0.2), at(j, 0.2)});
    triangles.push_back({at(i, -0.2), at(j, 0.2), at(j, -0.2)});
  }
  return Mesh(triangles);
}

TEST(MeshStop, CarriesUpToTheEdgeOfAStep) {
  ASSERT_TRUE(step_down().is_closed());
  for (const double x : {-2e-3, -0.5e-3, -1e-5}) {
    for (const double height : {1e-9, -1e-9, -1e-6}) {
      EXPECT_TRUE(
          has_plane(planes({stop(step_down())}, {x, 0.0, height}), Vector3d::UnitZ(), height))
          << x << " " << height;
    }
  }
  // behind the edge it is the lower one
  const auto low = planes({stop(step_down())}, {0.5e-3, 0.0, -1e-6});
  EXPECT_FALSE(has_plane(low, Vector3d::UnitZ(), -1e-6));
  EXPECT_TRUE(has_plane(low, Vector3d::UnitZ(), 0.002 - 1e-6));
}

// A shelf that reaches through a wall whose face is at x = 0.
TEST(MeshStop, OfAWallHoldsAboveAShelfThatReachesIntoIt) {
  const Mesh mesh = boxes({{Vector3d(-0.1, -0.5, -0.5), Vector3d(0.0, 0.5, 0.5)},
                           {Vector3d(-0.3, -0.2, -0.02), Vector3d(0.1, 0.2, 0.0)}});
  for (const double deep : {1e-9, 1e-4}) {
    const auto found = planes({stop(mesh)}, {-deep, 0.0, 0.003});
    EXPECT_TRUE(has_plane(found, Vector3d::UnitX(), -deep));
    EXPECT_TRUE(has_plane(found, Vector3d::UnitZ(), 0.003));
  }
  // deep in the wall, above the shelf
  for (const double deep : {0.006, 0.02, 0.04}) {
    EXPECT_TRUE(has_plane(planes({stop(mesh)}, {-deep, 0.0, 0.01}), Vector3d::UnitX(), -deep))
        << deep;
  }
}

// A plate of 2 mm is not felt through: what comes to its back meets its back.
TEST(MeshStop, DoesNotPullWhatIsBehindAThinPlate) {
  const Surface plate = stop(box_mesh({0.4, 0.4, 0.002}));
  for (const double below : {1e-9, 0.5e-3, 2e-3, 4e-3}) {
    const auto found = planes({plate}, {0.0, 0.05, -0.001 - below});
    ASSERT_EQ(found.size(), 1U) << below;
    EXPECT_TRUE(has_plane(found, -Vector3d::UnitZ(), below));
  }
}

// As a box does: the nearest way out.
TEST(MeshStop, BringsBackWhatIsDeepInside) {
  for (const double deep : {1e-3, 4e-3, 0.02, 0.049}) {
    const Vector3d p(0.01, 0.02, 0.1 - deep);
    for (const Shape& shape : {Shape(box_mesh({0.2, 0.2, 0.2})), Shape(Box{{0.2, 0.2, 0.2}})}) {
      const auto found = planes({stop(shape)}, p);
      ASSERT_EQ(found.size(), 1U) << deep;
      EXPECT_TRUE(has_plane(found, Vector3d::UnitZ(), -deep)) << deep;
    }
  }
}

TEST(MeshStop, MustBeClosedAndOfFewTriangles) {
  const auto message = [](const std::vector<Surface>& surfaces) {
    return message_of([&] { Environment(surfaces, kDt, {kBody, kBody}); });
  };
  const Mesh open({{Vector3d(0, 0, 0), Vector3d(0.4, 0, 0), Vector3d(0, 0.3, 0)}});
  EXPECT_NE(message({stop(open)}).find("surface stop: a mesh that is a stop must be closed"),
            std::string::npos);
  // a ball of 2048 triangles is too many, two of 512 are not
  std::vector<Surface> balls = {stop(ball_mesh(4))};
  EXPECT_EQ(message(balls), "surfaces that are stops: at most 1500 triangles in all, got 2048");
  balls = {stop(ball_mesh(3)), stop(ball_mesh(3))};
  EXPECT_EQ(message(balls), "no error");
  balls = {stop(ball_mesh(4))};
  balls[0].contact = Contact::kSpring;
  EXPECT_EQ(message(balls), "no error");
}

}  // namespace
}  // namespace hg::surfaces
