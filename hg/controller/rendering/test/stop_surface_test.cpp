// Virtual surfaces that are met like a stop of the twin.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hg/controller/rendering/test/playing.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/test/message_of.h"

namespace hg::rendering {
namespace {

using Eigen::Vector3d;
using surfaces::Contact;
using surfaces::Surface;

constexpr double kMass = 6.0;
const Vector3d kStart(0.4, 0.1, 0.0);

DeviceModel device_with(double ddq_max) {
  DeviceModel device = unlimited_device();
  CartesianLimit handle = {.name = "handle", .frame = device.handle};
  for (limits::JointLimits& axis : handle.axes) axis.ddq_max = ddq_max;
  device.cartesian_limits = {handle};
  return device;
}

// A free body at kStart that moves or is pushed.
struct Thrown {
  Rendering rendering;
  RenderingState state;
  LawResult result;
  double inside = 0.0;  // deepest so far, m
  Surface solid;        // of the same size, which has an inside

  static TwinModel body() {
    TwinModel twin =
        unlimited_twin(model::ChainModel::free_body({.mass = kMass}, {.gravity = false}), "handle");
    twin.q_start = floating_at({kStart, Eigen::Matrix3d::Identity()});
    return twin;
  }
  explicit Thrown(const Surface& met, const RenderingOptions& options = without_synchronisation(),
                  double ddq_max = 3.0)
      : rendering(device_with(ddq_max), body(), options,
                  surfaces::Environment({met}, kDt, {kMass, kMass})),
        state(rendering.start(kPosture)),
        solid(met) {
    if (const auto* mesh = std::get_if<surfaces::Mesh>(&met.shape)) {
      Eigen::AlignedBox3d box;
      for (const auto& triangle : mesh->triangles()) {
        for (const Vector3d& corner : triangle.corners) box.extend(corner);
      }
      solid.shape = surfaces::Box{box.sizes()};
    }
  }

  Vector3d position() const { return state.twin.q_a.head<3>(); }
  void step(const Vector3d& push = Vector3d::Zero()) {
    Vector6 w = Vector6::Zero();
    w.head<3>() = push;
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    ASSERT_LT(budget_gap(result, rendering.twin_chain().M()), 1e-9);
    rendering.integrate(state);
    for_each_facing(solid, position(), 1.0, [&](const surfaces::Facing& facing) {
      inside = std::max(inside, -facing.distance);
    });
  }
};

Surface stop(surfaces::Shape shape, const Vector3d& at) {
  return {.name = "stop", .shape = std::move(shape), .pose = {.p = at}, .contact = Contact::kStop};
}

surfaces::Mesh mesh_of_box(const Vector3d& size) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      const auto corner = [&](double a, double b) {
        Vector3d p;
        p[axis] = side * size[axis];
        p[next] = a * size[next];
        p[last] = b * size[last];
        return p;
      };
      const Vector3d c[] = {corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5),
                            corner(-0.5, 0.5)};
      if (side > 0.0) {
        triangles.push_back({c[0], c[1], c[2]});
        triangles.push_back({c[0], c[2], c[3]});
      } else {
        triangles.push_back({c[0], c[2], c[1]});
        triangles.push_back({c[0], c[3], c[2]});
      }
    }
  }
  return surfaces::Mesh(triangles);
}

// Faces, edges and corners, from every side.
TEST(StopSurface, IsNotEnteredByWhatIsThrownAtIt) {
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> share(-0.5, 0.5), fast(0.4, 1.5);
  const Vector3d size(0.3, 0.2, 0.25);
  const surfaces::Shape shapes[] = {surfaces::Box{size}, surfaces::Sphere{0.15},
                                    surfaces::Cylinder{0.12, 0.2}, mesh_of_box(size)};
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(k);
    const Vector3d way = Vector3d(any(random), any(random), any(random)).normalized();
    // some point of the box, often on its edges and corners, lies ahead
    Vector3d aim = Vector3d(share(random), share(random), share(random)) * 1.6;
    aim = aim.cwiseMax(-0.5).cwiseMin(0.5).cwiseProduct(size);
    Thrown body(stop(shapes[k % 4], kStart + 0.8 * way - aim));
    body.state.twin.dq_a.head<3>() = fast(random) * way;
    for (int i = 0; i < 1600; ++i) {
      body.step(6.0 * way);
      ASSERT_FALSE(HasFatalFailure());
    }
    ASSERT_LT(body.inside, 0.5e-3);
  }
}

TEST(StopSurface, CarriesTheHandSteadilyAndIsNamed) {
  Thrown body(stop(surfaces::Plane{}, kStart - 0.02 * Vector3d::UnitZ()));
  const Vector3d push(0, 0, -50.0);
  for (int k = 0; k < 2000; ++k) {
    body.step(push);
    ASSERT_FALSE(HasFatalFailure());
    if (k < 1000) continue;
    ASSERT_LT(std::abs(body.state.twin.dq_a[2]), 1e-4);
    ASSERT_NEAR(body.result.contact.force.z(), 50.0, 0.5);
    ASSERT_EQ(body.result.contact.surface, 0);
    ASSERT_NEAR(body.result.budget.surface[2], -50.0, 0.5);
    ASSERT_EQ(body.result.felt_limit, -1);
  }
  EXPECT_LT(body.inside, 1e-5);
  EXPECT_NEAR(body.position().z(), -0.02, 1e-4);
  // it lets go without sticking
  for (int k = 0; k < 100; ++k) body.step(Vector3d(0, 0, 6.0));
  EXPECT_GT(body.position().z(), -0.02 + 0.004);
  EXPECT_EQ(body.result.contact.force.norm(), 0.0);
}

// Who moves the handle there before the device is armed is brought out slowly, without a kick.
TEST(StopSurface, BringsOutSlowlyWhatStartsInside) {
  const Vector3d size(0.4, 0.4, 0.2);
  for (const surfaces::Shape& shape :
       {surfaces::Shape(surfaces::Box{size}), surfaces::Shape(mesh_of_box(size))}) {
    // 6 cm below its upper face
    Thrown body(stop(shape, kStart - 0.04 * Vector3d::UnitZ()));
    double fastest = 0.0, hardest = 0.0;
    for (int k = 0; k < 3000; ++k) {
      body.step();
      ASSERT_FALSE(HasFatalFailure());
      fastest = std::max(fastest, body.state.twin.dq_a.norm());
      hardest = std::max(hardest, body.state.twin.ddq_a.norm());
    }
    EXPECT_LT(fastest, 0.5 + 1e-6);
    EXPECT_GT(fastest, 0.1);
    EXPECT_LT(hardest, 30.0);
    EXPECT_GT(body.position().z(), kStart.z() + 0.06);
    EXPECT_EQ(body.result.contact.force.norm(), 0.0);
  }
}

TEST(StopSurface, LetsSlideAlongAMeshOverItsEdges) {
  Thrown body(stop(mesh_of_box({2.0, 2.0, 0.2}), kStart - 0.101 * Vector3d::UnitZ()));
  body.state.twin.dq_a.head<3>() = Vector3d(0.4, 0.3, 0.0);
  for (int k = 0; k < 1000; ++k) {
    body.step(Vector3d(0, 0, -2.0));
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_NEAR(body.state.twin.dq_a[0], 0.4, 1e-6);
  EXPECT_NEAR(body.state.twin.dq_a[1], 0.3, 1e-6);
  EXPECT_LT(body.inside, 1e-5);
}

TEST(StopSurface, NeedsALawThatSupportsIt) {
  const Surface surface = stop(surfaces::Plane{}, kStart - Vector3d::UnitZ());
  RenderingOptions paper = without_synchronisation();
  paper.bounds = Bounds::kPaper;
  EXPECT_EQ(message_of([&] { Thrown(surface, paper); }),
            "surfaces with 'contact: stop' need law gauss with bounds recoverable");
  EXPECT_NE(message_of([&] {
              Thrown(surface, without_synchronisation(), kInfinity);
            }).find("need a Cartesian limit of the handle"),
            std::string::npos);
}

// A door at 1.4 rad/s whose hinge brakes with 3 rad/s^2 hits a post; a hand keeps pushing. A point
// `from_hinge` metres from the hinge brakes with as little as 3 rad/s^2 give it there.
double depth_in_post(double from_hinge) {
  constexpr double kRadius = 0.02, kAhead = 0.5;  // m, share of the distance to the hinge
  TwinModel twin = door();
  twin.dofs[0].limits = {.q_min = 0.0, .q_max = 1.75, .dq_max = 1.4, .ddq_max = 3.0};
  twin.dofs[1].limits.q_max = 0.0;
  const int leaf = twin.chain.frame("leaf");
  twin.spheres = {{.frame = leaf, .p = {from_hinge, 0.0, 0.0}, .radius = kRadius}};
  const double face = kAhead * from_hinge + kRadius;
  const Vector3d size(0.1, 1.0, 1.0);
  Rendering rendering(
      device_with(3.0), twin, without_synchronisation(),
      surfaces::Environment({stop(surfaces::Box{size}, {from_hinge, face + 0.5 * size.y(), 0.0})},
                            kDt, {kMass, kMass}));
  RenderingState state = rendering.start(kPosture);
  state.twin.dq_a[0] = 1.4;
  LawResult result;
  double deepest = 0.0;
  for (int k = 0; k < 1500; ++k) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const Vector6 push = 10.0 * Vector6::Unit(1);
    const RobotState robot = robot_with(kGantryAtHome, kPosture, push);
    EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    rendering.integrate(state);
    deepest = std::max(deepest, from_hinge * std::sin(state.twin.q_a[0]) + kRadius - face);
  }
  EXPECT_EQ(result.contact.surface, 0);
  EXPECT_LT(std::abs(state.twin.dq_a[0]), 1e-6);
  return deepest;
}

TEST(StopSurface, ASphereNearAHingeBrakesAsTheHingeCan) {
  for (const double from_hinge : {0.05, 0.1, 0.2}) {
    EXPECT_LT(depth_in_post(from_hinge), 1e-4) << from_hinge;  // 9 to 26 mm with 3 m/s^2
  }
}

constexpr const char* kTwoSlides = R"(<robot name="slides"><link name="base"/>
  <link name="x"><inertial><mass value="2"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="to_x" type="prismatic"><parent link="base"/><child link="x"/>
    <axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="0" velocity="9"/></joint>
  <link name="y"><inertial><mass value="2"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="to_y" type="prismatic"><parent link="x"/><child link="y"/>
    <axis xyz="0 1 0"/><limit lower="-9" upper="9" effort="0" velocity="9"/></joint></robot>)";

// The end effector of two slides, pushed along the second one with `push` (N) up to 1.5 m/s, before
// a wall whose normal has this angle to x (rad), `ahead` of it: how far it comes in, m.
double depth_of_slides(const TwinModel& twin, double angle, double ahead, double dq, double push) {
  const Vector3d normal(std::cos(angle), std::sin(angle), 0.0);
  const Vector3d at(twin.q_start[0], twin.q_start[1], 0.0);
  Surface wall = stop(surfaces::Plane{}, at - ahead * normal);
  wall.pose.R = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).matrix();
  Rendering rendering(device_with(10.0), twin, without_synchronisation(),
                      surfaces::Environment({wall}, kDt, {kMass, kMass}));
  RenderingState state = rendering.start(kPosture);
  state.twin.dq_a[1] = dq;
  LawResult result;
  double deepest = -kInfinity;
  for (int k = 0; k < 3000; ++k) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const double left = state.twin.dq_a[1] < 1.5 ? push : 0.0;
    const RobotState robot = robot_with(kGantryAtHome, kPosture, left * Vector6::Unit(1));
    EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    rendering.integrate(state);
    const Vector3d p(state.twin.q_a[0], state.twin.q_a[1], 0.0);
    deepest = std::max(deepest, -normal.dot(p - at) - ahead);
  }
  return deepest;
}

TwinModel two_slides(double x_brakes, double y_brakes) {
  TwinModel twin = unlimited_twin(
      model::ChainModel::from_urdf_text(kTwoSlides, "slides.urdf", {.gravity = false}), "y");
  twin.dofs[0].limits.ddq_max = x_brakes;
  twin.dofs[1].limits.ddq_max = y_brakes;
  return twin;
}

// Slides that brake with 0.1 and 10 m/s^2, moving along the second at 1 m/s: it can brake in time
// alone.
TEST(StopSurface, AJointThatBrakesHardHelpsOneThatHardlyBrakes) {
  const double depth = depth_of_slides(two_slides(0.1, 10.0), -0.75 * M_PI, 0.3, 1.0, 10.0);
  EXPECT_LT(depth, 1e-4);
  EXPECT_GT(depth, -1e-3);
}

// The first slide would have to move beyond its end to help.
TEST(StopSurface, AJointAtItsEndDoesNotHelp) {
  for (const double y_brakes : {3.0, 2.0, 1.0}) {
    TwinModel twin = two_slides(3.0, y_brakes);
    twin.dofs[0].limits.q_min = 0.0;
    twin.dofs[0].limits.q_max = 5.0;
    for (const double degrees : {-112.0, -135.0, -157.0}) {
      EXPECT_LT(depth_of_slides(twin, degrees / 180.0 * M_PI, 0.9, 0.0, 20.0), 1e-3)
          << y_brakes << " " << degrees;
    }
  }
}

// A free body that carries a sphere beside its end effector, above a floor that is a stop.
struct Carrying {
  static constexpr double kRadius = 0.05;
  inline static const Vector3d kAt = {0.2, 0.0, 0.0};
  Rendering rendering;
  RenderingState state;
  LawResult result;
  double inside = 0.0;  // deepest of the sphere so far, m

  static TwinModel body(double height) {
    TwinModel twin = Thrown::body();
    twin.q_start = floating_at({{0.4, 0.1, height}, Eigen::Matrix3d::Identity()});
    twin.spheres = {{.frame = twin.end_effector, .p = kAt, .radius = kRadius}};
    return twin;
  }
  explicit Carrying(double height)
      : rendering(device_with(3.0), body(height), without_synchronisation(),
                  surfaces::Environment({stop(surfaces::Plane{}, Vector3d::Zero())}, kDt,
                                        {kMass, kMass})),
        state(rendering.start(kPosture)) {}

  Vector3d centre() const {
    const Eigen::Quaterniond turn(state.twin.q_a.segment<4>(3));
    return state.twin.q_a.head<3>() + turn * kAt;
  }
  // of the end effector, resolved in B
  Vector6 twist() const {
    const Eigen::Quaterniond turn(state.twin.q_a.segment<4>(3));
    Vector6 twist;
    twist << turn * state.twin.dq_a.head<3>(), turn * state.twin.dq_a.segment<3>(3);
    return twist;
  }
  void step(const Vector6& w) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const RobotState robot = robot_with(kGantryAtHome, kPosture, w);
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    ASSERT_LT(budget_gap(result, rendering.twin_chain().M()), 1e-9);
    rendering.integrate(state);
    inside = std::max(inside, kRadius - centre().z());
  }
};

// A hand that pushes the body down, with dampers of 20 Ns/m and 0.2 Nms/rad.
Vector6 pushing_hand(const Carrying& twin) {
  Vector6 w = -20.0 * twin.twist();
  w.tail<3>() *= 0.01;
  w[2] -= 10.0;
  return w;
}

TEST(StopSurface, ASphereOnABodyIsKeptOutAndTurnsTheBody) {
  for (const double speed : {0.05, 0.5, 1.5}) {
    Carrying twin(0.2 + speed * speed / (2.0 * 3.0));
    twin.state.twin.dq_a[2] = -speed;
    double fastest = 0.0;
    for (int k = 0; k < 3000; ++k) {
      twin.step(pushing_hand(twin));
      ASSERT_FALSE(HasFatalFailure());
      if (twin.state.twin.q_a[2] > 0.02) fastest = std::max(fastest, -twin.state.twin.dq_a[4]);
    }
    EXPECT_LT(twin.inside, 5e-4) << speed;
    EXPECT_GT(fastest, 0.05) << speed;  // the push beside the sphere turns it down about y
    EXPECT_EQ(twin.result.contact.surface, 0);
  }
}

// Where the lever of a sphere is short, its row asks for any turn. At 1.5 m/s from 0.15 m nothing
// can brake in time.
TEST(StopSurface, ASphereThatCameInTooFastIsBroughtBackWithoutAWhirl) {
  Carrying twin(0.2);
  twin.state.twin.dq_a[2] = -1.5;
  double fastest = 0.0;
  for (int k = 0; k < 3000; ++k) {
    twin.step(pushing_hand(twin));
    ASSERT_FALSE(HasFatalFailure());
    fastest = std::max(fastest, twin.twist().tail<3>().norm());
  }
  EXPECT_LT(fastest, 20.0);
  EXPECT_GT(twin.centre().z(), Carrying::kRadius - 5e-4);
  EXPECT_GT(twin.state.twin.q_a[2], -5e-4);
}

// A force through the middle of the sphere is carried by the floor alone.
TEST(StopSurface, ASphereCarriesWhatPushesIt) {
  Carrying twin(Carrying::kRadius);
  Vector6 w = Vector6::Zero();
  w[2] = -30.0;
  w.tail<3>() = Carrying::kAt.cross(Vector3d(w.head<3>()));
  for (int k = 0; k < 200; ++k) {
    twin.step(w);
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_LT((twin.centre() - Vector3d(0.6, 0.1, Carrying::kRadius)).norm(), 1e-4);
  EXPECT_LT(twin.state.twin.dq_a.norm(), 1e-3);
  EXPECT_TRUE(twin.result.contact.force.isZero(0.0));  // nothing at the handle itself
}

TwinModel body_with_corners(double half, double radius) {
  TwinModel twin = Thrown::body();
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      for (const double z : {-half, half}) {
        twin.spheres.push_back({.frame = twin.end_effector, .p = {x, y, z}, .radius = radius});
      }
    }
  }
  return twin;
}

// 20 degrees of freedom, pushed down onto a floor.
TEST(StopSurface, AFloorCarriesALongChainWithASphere) {
  constexpr double kFloor = -0.01;  // m, the end effector begins at 0
  TwinModel twin = unlimited_twin(
      model::ChainModel::from_urdf_text(snake(20, 1.0), "snake.urdf", {.gravity = false}), "l20");
  twin.spheres = {{.frame = twin.chain.frame("l10"), .radius = 0.005}};
  Rendering rendering(
      device_with(3.0), twin, without_synchronisation(),
      surfaces::Environment({stop(surfaces::Plane{}, {0.0, 0.0, kFloor})}, kDt, {kMass, kMass}));
  RenderingState state = rendering.start(kPosture);
  LawResult result;
  for (int k = 0; k < 400; ++k) {
    state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
    const RobotState robot = robot_with(kGantryAtHome, kPosture, -20.0 * Vector6::Unit(2));
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
    ASSERT_LT(budget_gap(result, rendering.twin_chain().M()), 1e-9);
    rendering.integrate(state);
    ASSERT_GT(rendering.twin_chain().pose(twin.end_effector).p.z(), kFloor - 5e-4);
  }
  EXPECT_EQ(result.contact.surface, 0);
  EXPECT_GT(result.contact.force.z(), 1.0);
}

// A mesh of 588 triangles is within the computing time of a twin with six spheres, not with eight.
TEST(StopSurface, SpheresShareTheTrianglesThatCanBeSearched) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (int i = 0; i < 49; ++i) {
    const surfaces::Mesh box = mesh_of_box({0.1, 0.1, 0.1});
    for (const auto& triangle : box.triangles()) {
      auto& moved = triangles.emplace_back(triangle.corners);
      for (Vector3d& corner : moved) corner.x() += 0.2 * i;
    }
  }
  const Surface row = stop(surfaces::Mesh(triangles), {0.0, 9.0, 0.0});
  TwinModel twin = body_with_corners(0.1, 0.02);
  const auto start = [&] {
    Rendering(device_with(3.0), twin, without_synchronisation(),
              surfaces::Environment({row}, kDt, {kMass, kMass}));
  };
  EXPECT_EQ(message_of(start),
            "surfaces that are stops: at most 500 triangles in all with 8 collision spheres of the "
            "twin, got 588");
  twin.spheres.resize(6);
  EXPECT_NO_THROW(start());
}

// A hand that pulls and turns at random, differently every 0.2 s, with dampers as above.
struct RandomHand {
  std::mt19937 random;
  Vector6 pull = Vector6::Zero();

  Vector6 operator()(int cycle, const Vector6& twist) {
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    if (cycle % 200 == 0) {
      for (double& value : pull) value = any(random);
      pull.head<3>() *= 40.0;
    }
    Vector6 w = pull - 20.0 * twist;
    w.tail<3>() = pull.tail<3>() - 0.2 * twist.tail<3>();
    return w;
  }
};

// A box with spheres at its corners, pressed and turned into the corner of a floor and two walls,
// where up to seven of them touch eleven planes.
TEST(StopSurface, ABoxIsHeldInACorner) {
  constexpr double kHalf = 0.1, kRadius = 0.02, kGap = 0.2;  // m; from the middle to each plane
  std::vector<Surface> planes(3, stop(surfaces::Plane{}, Vector3d::Zero()));
  for (int axis = 0; axis < 3; ++axis) {
    planes[axis].pose.p = kStart - kGap * Vector3d::Unit(axis);
    planes[axis].pose.R =
        Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), Vector3d::Unit(axis)).matrix();
  }
  Rendering rendering(device_with(3.0), body_with_corners(kHalf, kRadius),
                      without_synchronisation(),
                      surfaces::Environment(planes, kDt, {kMass, kMass}));
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    RenderingState state = rendering.start(kPosture);
    LawResult result;
    double deepest = -kInfinity;
    Vector6 pull;
    for (int k = 0; k < 4000; ++k) {
      if (k % 400 == 0) {
        for (double& value : pull) value = any(random);
        pull.head<3>() = 40.0 * (pull.head<3>() - Vector3d::Ones());  // into the corner
      }
      state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
      const Eigen::Quaterniond turn(state.twin.q_a.segment<4>(3));
      Vector6 w = pull;
      w.head<3>() -= 20.0 * (turn * state.twin.dq_a.head<3>());
      w.tail<3>() -= 0.2 * (turn * state.twin.dq_a.segment<3>(3));
      ASSERT_EQ(rendering.step({.robot = robot_with(kGantryAtHome, kPosture, w)}, state, result),
                SolverStatus::kSolved);
      ASSERT_LT(budget_gap(result, rendering.twin_chain().M()), 1e-8);  // of 80 N
      rendering.integrate(state);
      for (const CollisionSphere& sphere : rendering.twin().spheres) {
        const Vector3d p = state.twin.q_a.head<3>() + turn * sphere.p - kStart;
        deepest = std::max(deepest, kRadius - kGap - p.minCoeff());
      }
    }
    EXPECT_LT(deepest, 1e-3);
    EXPECT_GT(deepest, -1e-3);
    EXPECT_GE(result.contact.surface, 0);
  }
}

// Spheres of a millimetre and of a metre, at the corners and in the middle of a body.
TEST(StopSurface, SpheresAtTheCornersOfABodyStayBetweenTwoStops) {
  struct Case {
    double half, radius;
  };
  for (const Case& c : {Case{0.1, 0.02}, Case{0.1, 1e-3}, Case{0.1, 1.0}, Case{0.0, 0.1}}) {
    SCOPED_TRACE(c.radius);
    const double gap = c.half * std::sqrt(3.0) + c.radius + 0.15;
    Surface below = stop(surfaces::Plane{}, kStart - gap * Vector3d::UnitZ());
    Surface above = stop(surfaces::Plane{}, kStart + gap * Vector3d::UnitZ());
    above.pose.R = Eigen::AngleAxisd(M_PI, Vector3d::UnitX());
    Rendering rendering(device_with(3.0), body_with_corners(c.half, c.radius),
                        without_synchronisation(),
                        surfaces::Environment({below, above}, kDt, {kMass, kMass}));
    RenderingState state = rendering.start(kPosture);
    RandomHand hand = {.random = std::mt19937(1)};
    LawResult result;
    double deepest = 0.0;
    for (int k = 0; k < 2000; ++k) {
      state.reference = {kPosture, VectorM::Zero(6), VectorM::Zero(6)};
      const Eigen::Quaterniond turn(state.twin.q_a.segment<4>(3));
      Vector6 twist;
      twist << turn * state.twin.dq_a.head<3>(), turn * state.twin.dq_a.segment<3>(3);
      const RobotState robot = robot_with(kGantryAtHome, kPosture, hand(k, twist));
      const AllocationCounter allocations;
      ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
      ASSERT_EQ(allocations.count(), 0u);
      rendering.integrate(state);
      for (const CollisionSphere& sphere : rendering.twin().spheres) {
        const double z = state.twin.q_a[2] + (turn * sphere.p).z();
        deepest = std::max(deepest, std::abs(z - kStart.z()) + c.radius - gap);
      }
    }
    EXPECT_LT(deepest, 1e-3);
    EXPECT_GT(deepest, -1e-3);
    EXPECT_LT(state.twin.dq_a.head<3>().norm(), 2.0);  // 40 N on 20 Ns/m
  }
}

}  // namespace
}  // namespace hg::rendering
