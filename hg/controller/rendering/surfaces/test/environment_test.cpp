// What the handle feels of virtual surfaces.

#include "hg/controller/rendering/surfaces/environment.h"

#include <gtest/gtest.h>

#include "hg/controller/rendering/surfaces/test/solids.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/core/test/message_of.h"

namespace hg::surfaces {
namespace {

constexpr double kRounding = 1e-5;  // N; solids are larger by kGrown

Surface table(double friction = 0.0) {
  return {.name = "table", .shape = Plane{}, .stiffness = 2000, .damping = 0, .friction = friction};
}

Surface box(const Vector3d& size, const Vector3d& p, double friction = 0.0) {
  return {.name = "box",
          .shape = Box{size},
          .pose = {p, Eigen::Matrix3d::Identity()},
          .stiffness = 2000,
          .damping = 0,
          .friction = friction};
}

TEST(Plane, PushesWithItsStiffnessTimesTheDepth) {
  Surface tilted = table();
  tilted.pose = {{0.3, 0.1, -0.2}, Eigen::AngleAxisd(0.5, Vector3d::UnitX()).toRotationMatrix()};
  const Vector3d n = tilted.pose.R.col(2);
  Led led({tilted});
  EXPECT_EQ(led.at(tilted.pose.p + 0.01 * n).surface, -1);
  const ContactReport contact = led.at(tilted.pose.p - 0.004 * n);
  EXPECT_EQ(contact.surface, 0);
  EXPECT_LT((contact.force - 8.0 * n).norm(), kRounding);
  EXPECT_LT((contact.proxy - tilted.pose.p).norm(), kRounding);
  EXPECT_EQ(led.at(tilted.pose.p + 1e-6 * n).force.norm(), 0.0);
}

TEST(Plane, ActsAsInTheMiddleOfTheSample) {
  Led led({table()});
  led.at({0, 0, 0.1});
  const Vector3d v(0, 0, -0.5);
  const ContactReport contact = led.environment.step({0, 0, -0.01}, v, kNoPush, led.state);
  EXPECT_NEAR(contact.force.z(), 2000 * (0.01 + 0.5 * kDt * 0.5), kRounding);
}

TEST(Damping, BrakesOnlyTheWayInGrowsWithTheSpringAndNeverPulls) {
  Surface surface = table();
  surface.damping = 100;
  Led led({surface});
  const auto force = [&](double depth, double v) {
    EnvironmentState state;
    led.environment.step({0, 0, 0.1}, Vector3d::Zero(), kNoPush, state);
    const Vector3d p(0, 0, -depth - 0.5 * kDt * v);  // in the middle of the sample at `depth`
    return led.environment.step(p, {0, 0, v}, kNoPush, state).force.z();
  };
  EXPECT_NEAR(force(0.01, -0.2), 20 + 20, kRounding);
  EXPECT_NEAR(force(0.01, 0.1), 20 - 10, kRounding);
  EXPECT_EQ(force(0.01, 0.3), 0.0);
  EXPECT_NEAR(force(0.0005, -0.2), 1 + 20 * 0.5, kRounding);
}

// A body that is pushed into a surface that says no damping, by a device that gives everything.
TEST(Damping, OfASurfaceWithoutAValueCatchesEveryBody) {
  for (const double mass : {0.5, 3.0, 6.0, 20.0}) {
    for (const double stiffness : {2e3, 5e4}) {
      for (const double speed : {0.2, 1.3}) {
        SCOPED_TRACE(std::to_string(mass) + " kg, " + std::to_string(stiffness) + " N/m, " +
                     std::to_string(speed) + " m/s");
        const Surface floor = {.name = "floor", .shape = Plane{}, .stiffness = stiffness};
        const Environment environment({floor}, kDt, {mass, mass});
        EnvironmentState state;
        const Vector3d push(0, 0, -10.0);
        Vector3d p(0, 0, 1e-3), v(0, 0, -speed);
        double back = 0.0, late = 0.0;
        for (int k = 0; k < 2000; ++k) {
          const ContactReport contact = environment.step(p, v, push, state);
          environment.give_way(contact, 0.0, v, state);
          const Vector3d a = (push + contact.force) / mass;
          p += kDt * v + 0.5 * kDt * kDt * a;
          v += kDt * a;
          back = std::max(back, v.z());
          if (k > 1000) late = std::max(late, std::abs(v.z()));
        }
        EXPECT_LE(back, 0.1 * speed);
        EXPECT_LT(late, kRecovery + 1e-3);
        EXPECT_LT(p.z(), -9.0 / stiffness);
      }
    }
  }
}

// It cannot be seen whether a body of 6 kg was set up as that or has become three times as heavy.
TEST(Damping, OfASurfaceWithoutAValueFollowsTheMassOfTheBody) {
  const Surface floor = {.name = "floor", .shape = Plane{}, .stiffness = 2e4};
  const Environment set_up({floor}, kDt, {6.0, 6.0}), grown({floor}, kDt, {2.0, 2.0});
  EnvironmentState of_set_up, of_grown;
  for (const double z : {1e-3, -0.2e-3, -0.5e-3, -0.8e-3}) {
    const Vector3d p(0, 0, z), v(0, 0, -0.3);
    const Vector3d force = set_up.step(p, v, kNoPush, of_set_up).force;
    EXPECT_EQ(grown.step(p, v, kNoPush, of_grown, 3.0).force, force);
    EXPECT_EQ(of_grown.dent, of_set_up.dent);
    EXPECT_EQ(force.z() > 0.0, z < 0.0);
  }
}

TEST(Damping, DoesNotBrakeSlidingWithoutFriction) {
  Surface surface = table();
  surface.damping = 100;
  Led led({surface});
  led.at({0, 0, 0.1});
  const ContactReport contact =
      led.environment.step({0, 0, -0.01}, {0.3, 0, 0}, kNoPush, led.state);
  EXPECT_LT(contact.force.head<2>().norm(), kRounding);
}

TEST(Proxy, IsNeverInsideASolid) {
  int touched = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    const Vector3d mesh_size = Vector3d(0.1, 0.2, 0.15);
    std::vector<Surface> surfaces;
    const std::vector<Shape> shapes = {Plane{}, Box{{0.2, 0.001, 0.3}}, Sphere{0.12},
                                       Cylinder{0.06, 0.2}, box_mesh(mesh_size)};
    for (std::size_t i = 0; i < 3; ++i) {
      Surface surface = table(any(random) < 0.4 ? 0.0 : any(random));
      surface.shape = shapes[random() % shapes.size()];
      surface.pose = random_pose(random);
      surfaces.push_back(surface);
    }
    const auto depth = [&](const Vector3d& p) {
      double deepest = -1.0;
      for (const Surface& surface : surfaces)
        deepest = std::max(deepest, depth_in(surface, p, mesh_size));
      return deepest;
    };
    Vector3d p = random_in(random, 0.5);
    while (depth(p) > -1e-3) p = random_in(random, 0.5);
    Led led(surfaces);
    led.at(p);
    for (int k = 0; k < 3000; ++k) {
      // to and fro, 0 to 3 m/s
      const Vector3d step = kDt * 3.0 * any(random) * random_in(random, 1.0);
      if ((p + step).norm() < 0.6) p += step;
      if (k % 100 == 0) p = random_in(random, 0.5);
      const ContactReport contact = led.at(p);
      ASSERT_TRUE(contact.force.allFinite());
      ASSERT_LE(depth(contact.proxy), 1e-8) << "step " << k;
      if (contact.surface >= 0) ++touched;
    }
  }
  EXPECT_GT(touched, 20'000);
}

TEST(Proxy, DoesNotPopThroughAThinWallAtHighSpeed) {
  const Vector3d size(0.5, 0.5, 0.001);
  for (const Shape& shape : {Shape(Box{size}), Shape(box_mesh(size))}) {
    for (unsigned seed = 0; seed < 200; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      std::mt19937 random(seed);
      Surface wall = table(seed % 2 == 0 ? 0.0 : 0.5);
      wall.shape = shape;
      Led led({wall});
      Vector3d v = random_in(random, 1.0);
      v.z() = -std::abs(v.z()) - 0.3;
      v *= 3.0 / v.norm();
      const Vector3d start = 0.15 * random_in(random, 1.0).cwiseProduct(Vector3d(1, 1, 0));
      Vector3d p = start + Vector3d(0, 0, 0.01);
      ContactReport contact;
      for (int k = 0; k < 40; ++k)
        contact = led.environment.step(p += kDt * v, v, kNoPush, led.state);
      ASSERT_LT(p.z(), -0.01);
      EXPECT_NEAR(contact.proxy.z(), 0.0005, 1e-8);
      EXPECT_NEAR(contact.force.z(), 2000 * (0.0005 - p.z() - 0.5 * kDt * v.z()), 1e-3);
    }
  }
}

// A floor of two boxes, a plate of triangles, a corner between floor and wall, a sphere: whoever
// stays in touch feels no step.
TEST(Force, IsContinuousOverSeamsIntoCornersAndOnRoundThings) {
  struct Way {
    const char* what;
    std::vector<Surface> surfaces;
    Vector3d above, from, to;
  };
  Surface plate = table();
  plate.shape = box_mesh({1.0, 1.0, 0.2});
  Surface ball = table();
  ball.shape = Sphere{0.2};
  const std::vector<Way> ways = {
      {"seam",
       {box({1, 1, 0.2}, {-0.5, 0, -0.1}), box({1, 1, 0.2}, {0.5, 0, -0.1})},
       {-0.3, 0.02, 0.1},
       {-0.3, 0.02, -0.006},
       {0.3, 0.05, -0.006}},
      {"mesh", {plate}, {-0.4, 0.1, 0.2}, {-0.4, 0.1, 0.095}, {0.4, -0.2, 0.09}},
      {"corner",
       {table(), box({0.4, 2, 2}, {0.5, 0, 0})},
       {0.0, 0, 0.1},
       {0.0, 0, -0.005},
       {0.31, 0.1, -0.006}},
      {"ball", {ball}, {0.25, 0, 0}, {0.19, 0, 0}, {0.0, 0.13, 0.13}}};
  for (const Way& way : ways) {
    SCOPED_TRACE(way.what);
    Led led(way.surfaces);
    led.at(way.above);
    Vector3d last = led.at(way.from).force;
    constexpr int kSteps = 2000;
    for (int k = 1; k <= kSteps; ++k) {
      const Vector3d step = (way.to - way.from) / kSteps;
      const ContactReport contact = led.at(way.from + k * step);
      ASSERT_GE(contact.surface, 0) << k;
      // a ball of 0.2 m turns the force of a deep handle faster than the handle moves
      ASSERT_LT((contact.force - last).norm(), 2000 * 3.0 * step.norm()) << k;
      last = contact.force;
    }
  }
}

TEST(Force, InACornerIsThatOfAllItsFaces) {
  Led led({table(), box({0.4, 2, 2}, {0.5, 0, 0}), box({2, 0.4, 2}, {0, 0.5, 0})});
  led.last = {0.1, 0.1, 0.1};
  led.at(led.last);
  const ContactReport contact = led.to({0.303, 0.305, -0.002});
  EXPECT_LT((contact.force - 2000 * Vector3d(-0.003, -0.005, 0.002)).norm(), 1e-6);
  EXPECT_EQ(contact.surface, 2);
  EXPECT_LT((contact.proxy - Vector3d(0.3, 0.3, 0)).norm(), 1e-8);
}

TEST(Force, OfABallPointsAwayFromItsCentre) {
  Surface ball = table();
  ball.shape = Sphere{0.1};
  Led led({ball});
  led.at({0.2, 0, 0});
  led.last = {0.2, 0, 0};
  led.to({0.095, 0, 0});
  const Vector3d p = 0.094 * Vector3d(1, 1, 1).normalized();
  const ContactReport contact = led.to(p);
  EXPECT_LT((contact.force - 2000 * 0.006 * p.normalized()).norm(), 1e-5);
}

TEST(Force, OfACylinderPointsAwayFromItsAxisOrOutOfItsEnd) {
  Surface can = table();
  can.shape = Cylinder{0.1, 0.3};
  can.pose = {{0.2, 0, 0}, Eigen::AngleAxisd(1.0, Vector3d::UnitX()).toRotationMatrix()};
  const auto in_B = [&](const Vector3d& p) { return can.pose.p + can.pose.R * p; };
  const Vector3d radial = Vector3d(0.6, -0.8, 0);
  struct Way {
    Vector3d from, to, force;
  };
  const std::vector<Way> ways = {{0.2 * radial, 0.095 * radial, 10.0 * radial},
                                 {{0.02, 0.03, 0.2}, {0.02, 0.03, 0.148}, {0, 0, 4.0}},
                                 {{0.02, 0.03, -0.2}, {0.02, 0.03, -0.148}, {0, 0, -4.0}}};
  for (const auto& [from, to, force] : ways) {
    Led led({can});
    led.at(in_B(from));
    led.last = in_B(from);
    const ContactReport contact = led.to(in_B(to));
    EXPECT_LT((contact.force - can.pose.R * force).norm(), kRounding);
  }
}

TEST(Force, OfUnequalFacesHasTheirMeansByTheirShares) {
  Surface floor = table(), wall = box({0.4, 2, 2}, {0.5, 0, 0});
  floor.stiffness = 1000;
  wall.stiffness = 4000;
  Led led({floor, wall});
  led.last = {0.1, 0.1, 0.1};
  led.at(led.last);
  const ContactReport contact = led.to({0.303, 0.1, -0.001});  // shares 1/4 and 3/4
  EXPECT_LT((contact.force - 3250 * Vector3d(-0.003, 0, 0.001)).norm(), 1e-5);
  EXPECT_EQ(contact.surface, 1);
}

TEST(Friction, SticksWithinItsConeAndDoesNotCreep) {
  Led led({table(0.5)});
  led.at({0, 0, 0.01});
  led.at({0, 0, -0.01});
  const Vector3d p(0.0049, 0, -0.01);
  const ContactReport first = led.at(p);
  EXPECT_LT((first.proxy - Vector3d::Zero()).norm(), 1e-9);
  EXPECT_NEAR(first.force.x(), -2000 * 0.0049, 1e-6);
  for (int k = 0; k < 100'000; ++k) led.at(p);
  EXPECT_LT((led.state.proxy - first.proxy).norm(), 1e-9);
}

TEST(Friction, SlipsWithItsCoefficientTimesTheNormalForce) {
  Led led({table(0.5)});
  led.at({0, 0, 0.01});
  led.last = {0, 0, 0.01};
  led.to({0, 0, -0.01});
  const ContactReport contact = led.to({0.1, 0, -0.01});
  EXPECT_NEAR(contact.force.z(), 20.0, 1e-6);
  EXPECT_NEAR(contact.force.x(), -10.0, 1e-6);
}

TEST(Friction, StaysWithinItsConeWhateverTheHandleDoes) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const double mu = 0.02 * seed;
    Surface floor = table(mu);
    floor.damping = 50;
    Led led({floor});
    led.at({0, 0, 0.02});
    for (int k = 0; k < 2000; ++k) {
      const ContactReport contact =
          led.environment.step(random_in(random, 0.02), random_in(random, 1.0), kNoPush, led.state);
      ASSERT_LE(contact.force.head<2>().norm(), mu * contact.force.z() + 1e-9) << k;
    }
  }
}

// What the handle puts in along a slow closed way.
double work(Led& led, const std::vector<Vector3d>& corners) {
  double sum = 0.0;
  Vector3d p = corners.back(), force = led.at(p).force;
  for (const Vector3d& corner : corners) {
    constexpr int kSteps = 2000;
    const Vector3d step = (corner - p) / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      p += step;
      const Vector3d next = led.at(p).force;
      sum -= 0.5 * (force + next).dot(step);
      force = next;
    }
  }
  return sum;
}

TEST(Energy, IsNotCreatedOnASlowWayInAndOut) {
  const std::vector<Vector3d> in_and_out = {
      {0, 0, 0.01}, {0, 0, -0.01}, {0.05, 0.02, -0.015}, {0.05, 0.02, 0.01}};
  const double stored = 0.5 * 2000 * 0.015 * 0.015;
  for (const double mu : {0.0, 0.2, 1.0}) {
    Surface ball = table(mu);
    ball.shape = Sphere{0.3};
    ball.pose.p.z() = -0.3;
    for (const Surface& surface : {table(mu), ball}) {
      Led led({surface});
      led.at(in_and_out.back());
      const double taken = work(led, in_and_out);
      EXPECT_GT(taken, -1e-3 * stored) << mu;
      if (mu == 0.0) {
        EXPECT_LT(taken, 1e-3 * stored);
      } else {
        EXPECT_GT(taken, 0.1 * stored);
      }
    }
  }
}

// The handle has left the solid then; what the spring had stored is lost and not given back.
TEST(Energy, OfTheSpringIsLostWhereTheHandleSlipsOffAnEdge) {
  constexpr double kDepth = 0.01;
  Surface solid = box({0.2, 0.2, 0.2}, {0, 0, -0.1});
  Surface mesh = solid;
  mesh.shape = box_mesh({0.2, 0.2, 0.2});
  for (const Surface& surface : {solid, mesh}) {
    Led led({surface});
    led.last = {0, 0, 0.01};
    led.at(led.last);
    EXPECT_NEAR(led.to({0.0999, 0, -kDepth}).force.z(), 2000 * kDepth, kRounding);
    const ContactReport off = led.at({0.1001, 0, -kDepth});
    EXPECT_EQ(off.force, Vector3d::Zero());
    EXPECT_EQ(off.surface, -1);
    EXPECT_EQ(led.to({0.0999, 0, -kDepth}).surface, 0);  // in again, now by the side
    EXPECT_NEAR(led.to({0.0999, 0, -kDepth}).force.x(), 2000 * 1e-4, kRounding);

    Led round({surface});
    round.at({0, 0, 0.01});
    const double stored = 0.5 * 2000 * kDepth * kDepth;
    const double taken =
        work(round, {{0, 0, -kDepth}, {0.12, 0, -kDepth}, {0.12, 0, 0.01}, {0, 0, 0.01}});
    EXPECT_NEAR(taken, stored, 0.01 * stored);
  }
}

// A mass that falls into a stiff surface without damping, moved as the law moves a twin.
TEST(Energy, OfABouncingMassDoesNotGrow) {
  Surface floor = table();
  floor.stiffness = 20'000;
  Led led({floor});
  Vector3d p(0, 0, 0.002), v(0, 0, -0.3);
  const double start = 0.5 * kBody * v.squaredNorm();
  int bounces = 0;
  for (int k = 0; k < 20'000; ++k) {
    const Vector3d a = led.environment.step(p, v, kNoPush, led.state).force / kBody;
    p += kDt * v + 0.5 * kDt * kDt * a;
    v += kDt * a;
    if (p.z() > 0.002 && v.z() > 0.0) {
      v = -v;  // thrown back
      ++bounces;
      ASSERT_LT(0.5 * kBody * v.squaredNorm(), 1.02 * start) << k;
    }
  }
  EXPECT_GT(bounces, 100);
}

// A mass that meets a surface with a device behind it that gives at most `force`.
struct Impact {
  double depth = 0.0, v_out = 0.0, taken = 0.0, given = 0.0, last_force = 0.0;
  int samples = 0;  // until it is out again, or all
};

Impact impact(double stiffness, double mass, double v, double force, bool gives_way) {
  Surface floor = table();
  floor.stiffness = stiffness;
  Led led({floor});
  led.at({0, 0, 0.01});
  Vector3d p(0, 0, 1e-6), velocity(0, 0, -v);
  Impact impact;
  for (; impact.samples < 5000 && (p.z() <= 0.0 || velocity.z() < 0.0); ++impact.samples) {
    const ContactReport contact = led.environment.step(p, velocity, kNoPush, led.state);
    const double f = std::min(contact.force.z(), force);
    if (gives_way) led.environment.give_way(contact, contact.force.z() - f, velocity, led.state);
    const Vector3d a(0, 0, f / mass);
    const double moved = kDt * velocity.z() + 0.5 * kDt * kDt * a.z();
    (moved < 0.0 ? impact.taken : impact.given) += std::abs(f * moved);
    p.z() += moved;
    velocity += kDt * a;
    impact.depth = std::max(impact.depth, -p.z());
    impact.v_out = velocity.z();
    impact.last_force = f;
  }
  return impact;
}

TEST(GivingWay, ThrowsBackOnlyWithWhatTheSpringHoldsAtTheForceOfTheDevice) {
  for (const double stiffness : {8e3, 2e4, 5e4}) {
    for (const double mass : {3.0, 6.0, 20.0}) {
      for (const double v : {0.4, 0.83, 1.33}) {
        SCOPED_TRACE(std::to_string(stiffness) + " N/m, " + std::to_string(mass) + " kg, " +
                     std::to_string(v) + " m/s");
        const double force = 6.0 * mass;  // 6 m/s^2
        const Impact soft = impact(stiffness, mass, v, force, true);
        EXPECT_LT(soft.v_out, 1.05 * force / std::sqrt(stiffness * mass) + 6.0 * kDt);
        EXPECT_LT(soft.depth, 1.1 * v * v / (2.0 * 6.0) + 1.5 * force / stiffness);
        EXPECT_LE(soft.given, soft.taken);
        EXPECT_GT(impact(stiffness, mass, v, force, false).v_out, 0.9 * v);  // as it came
      }
    }
  }
}

TEST(GivingWay, LeavesNoMoreInTheSpringThanTheDeviceGives) {
  Led led({table()});
  led.at({0, 0, 0.01});
  const Vector3d v(0, 0, -1.0);
  for (int k = 1; k <= 100; ++k) {
    const Vector3d p(0, 0, -1e-3 * k);
    const ContactReport contact = led.environment.step(p, v, kNoPush, led.state);
    led.environment.give_way(contact, std::max(0.0, contact.force.z() - 30.0), v, led.state);
  }
  const Vector3d still = Vector3d::Zero();
  EXPECT_NEAR(led.environment.step({0, 0, -0.1}, still, kNoPush, led.state).force.z(), 30.0, 1.5);
  // 20 mm nearer to the surface there is none, and pressing again begins there
  EXPECT_EQ(led.environment.step({0, 0, -0.08}, still, kNoPush, led.state).force.z(), 0.0);
  EXPECT_NEAR(led.environment.step({0, 0, -0.085}, still, kNoPush, led.state).force.z(), 10.0, 0.1);
  // outside, all is forgotten
  led.at({0, 0, 0.01});
  EXPECT_NEAR(led.environment.step({0, 0, -0.01}, still, kNoPush, led.state).force.z(), 20.0, 0.1);
}

TEST(GivingWay, RecoversSlowlyAndOnlyFromWhatTheContactHasTaken) {
  const auto pressed = [](double taken) {
    Led led({table()});
    led.at({0, 0, 0.01});
    led.at({0, 0, -0.05});
    led.state.dent = 0.045;
    led.state.taken = taken;
    ContactReport contact;
    for (int k = 0; k < 1000; ++k) {
      contact = led.environment.step({0, 0, -0.05}, Vector3d::Zero(), kNoPush, led.state);
      led.environment.give_way(contact, 0.0, Vector3d::Zero(), led.state);
    }
    return contact.force.z();
  };
  EXPECT_NEAR(pressed(0.0), 10.0, 0.1);
  EXPECT_NEAR(pressed(1.0), 2000.0 * (0.005 + kRecovery), 0.1);
}

TEST(Mesh, OfABoxFeelsLikeTheBox) {
  const Vector3d size(0.3, 0.2, 0.1);
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    Surface solid = box(size, Vector3d::Zero(), 0.01 * seed);
    solid.pose = random_pose(random);
    Surface mesh = solid;
    mesh.shape = box_mesh(size);
    Led one({solid}), other({mesh});
    Vector3d p = solid.pose.p + Vector3d::Constant(0.3);
    const Vector3d centre = solid.pose.p;
    for (int k = 0; k < 3000; ++k) {
      p += 0.003 * random_in(random, 1.0) - 0.01 * (p - centre) * (k % 200 < 100 ? 1.0 : -0.5);
      const ContactReport a = one.at(p), b = other.at(p);
      ASSERT_EQ(a.surface, b.surface) << k;
      ASSERT_LT((a.force - b.force).norm(), 1e-4) << k;
    }
  }
}

// Rounding must not let a handle fall between two triangles.
TEST(Mesh, HoldsOnTheEdgeBetweenItsTriangles) {
  const Vector3d size(0.3, 0.2, 0.1);
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::mt19937 random(seed);
    Surface plate = table();
    plate.shape = box_mesh(size);
    plate.pose = random_pose(random);
    const double share = std::uniform_real_distribution<double>(-0.45, 0.45)(random);
    const Vector3d on_edge = size.cwiseProduct(Vector3d(share, share, 0.5));
    const auto in_B = [&](double height) -> Vector3d {
      return plate.pose.p + plate.pose.R * (on_edge + height * Vector3d::UnitZ());
    };
    Led led({plate});
    led.at(in_B(0.01));
    ASSERT_NEAR(led.at(in_B(-0.001)).force.norm(), 2.0, kRounding) << "seed " << seed;
  }
}

TEST(Handle, ThatStartsInsideIsFreeUntilItHasLeft) {
  const Surface solid = box({0.1, 0.1, 0.1}, Vector3d::Zero());
  Led led({solid});
  EXPECT_TRUE(is_inside(solid, {0.02, 0, 0}));
  EXPECT_FALSE(is_inside(solid, {0.06, 0, 0}));
  EXPECT_EQ(led.to({0.02, 0, 0}).surface, -1);
  led.to({0.06, 0, 0});
  EXPECT_NEAR(led.to({0.04, 0, 0}).force.x(), 20.0, 1e-6);
}

TEST(Step, DoesNotAllocateAndSurvivesANan) {
  Surface ball = table(0.3);
  ball.shape = Sphere{0.1};
  Surface mesh = table(0.3);
  mesh.shape = box_mesh({0.1, 0.1, 0.1});
  Led led({table(0.3), ball, mesh});
  std::mt19937 random(1);
  {
    const AllocationCounter counter;
    for (int k = 0; k < 1000; ++k) led.at(random_in(random, 0.15));
    EXPECT_EQ(counter.count(), 0U);
  }
  EXPECT_EQ(led.at(Vector3d::Constant(std::nan(""))).force, Vector3d::Zero());
  EXPECT_TRUE(led.state.proxy.allFinite());
}

TEST(Check, RefusesWhatNoSurfaceIs) {
  const auto message = [](const Surface& surface) {
    return message_of([&] { Environment({surface}, kDt, {kBody, kBody}); });
  };
  Surface surface = table();
  surface.stiffness = 1e6;
  EXPECT_EQ(message(surface), "surface table: stiffness must be 10 .. 50000, got 1e+06");
  surface = table(-0.1);
  EXPECT_EQ(message(surface), "surface table: friction must be 0 .. 2, got -0.1");
  EXPECT_EQ(message(box({0.1, 0.0, 0.1}, Vector3d::Zero())),
            "surface box: edge must be 0.001 .. 100, got 0");
  surface = table();
  surface.shape = Mesh();
  EXPECT_EQ(message(surface), "surface table: a mesh needs triangles, got none");
  surface.shape = Mesh({{Vector3d(0, 0, 0), Vector3d(400, 0, 0), Vector3d(0, 300, 0)}});
  EXPECT_EQ(message(surface),
            "surface table: size (scale: 0.001 for millimetres) must be 0.001 .. 100, got 400");
  EXPECT_EQ(message_of([] {
              Environment(std::vector<Surface>(65, table()), kDt, {kBody, kBody});
            }),
            "surfaces: at most 64, got 65");
}

}  // namespace
}  // namespace hg::surfaces
