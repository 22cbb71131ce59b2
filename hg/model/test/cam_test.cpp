// Joints on cams: the curve through points, and a chain whose joint follows by it.
#include "hg/model/cam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::model {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

// a rise between two rests, at unequal distances
const std::vector<CamPoint> kPress = {{0.0, 0.0},  {0.6, 0.004}, {1.6, 0.046}, {2.2, 0.05},
                                      {3.2, 0.05}, {3.8, 0.046}, {4.8, 0.004}, {5.4, 0.0}};
const std::vector<CamPoint> kThreeLobes = {{0.0, 0.0}, {0.5, 0.02}, {1.0, 0.03}, {1.5, 0.01}};
const std::vector<CamPoint> kGuide = {{-0.5, 0.1}, {0.0, -0.05}, {0.5, 0.02}, {1.0, 0.0}};

struct Case {
  const std::vector<CamPoint>& points;
  double period;
};
const std::vector<Case> kCases = {{kPress, kTurn}, {kThreeLobes, kTurn / 3.0}, {kGuide, kInfinity}};

TEST(Cam, MeetsItsPointsInEveryTurn) {
  for (const auto& [points, period] : kCases) {
    const CouplingCurve& curve = *make_cam(points, period).curve;
    for (const CamPoint& point : points) {
      EXPECT_NEAR(curve.at(point.leader).value, point.follower, 1e-9);
      if (!std::isfinite(period)) continue;
      EXPECT_NEAR(curve.at(point.leader - 4.0 * period).value, point.follower, 1e-9);
      EXPECT_NEAR(curve.at(point.leader + 30.0 * period).value, point.follower, 1e-9);
    }
  }
}

TEST(Cam, SlopeAndCurvatureAreTheDerivativesAndContinuous) {
  constexpr double kStep = 1e-5;
  for (const auto& [points, period] : kCases) {
    const Cam cam = make_cam(points, period);
    for (double q = -1.0; q < 8.0; q += 0.00731) {
      const CouplingCurve::Point at = cam.curve->at(q);
      const CouplingCurve::Point before = cam.curve->at(q - kStep);
      const CouplingCurve::Point after = cam.curve->at(q + kStep);
      EXPECT_NEAR(at.slope, (after.value - before.value) / (2.0 * kStep), 1e-8) << q;
      EXPECT_NEAR(at.curvature, (after.slope - before.slope) / (2.0 * kStep), 2e-4) << q;
      EXPECT_NEAR(before.curvature, after.curvature, 2e-3) << q;
    }
  }
}

TEST(Cam, OfPointsAtEqualDistancesIsTheNaturalSpline) {
  // 0, 1, 0 at distances 1: 1.5 x - 0.5 x^3 up to the middle
  const Cam cam = make_cam({{0.0, 0.0}, {1.0, 1.0}, {2.0, 0.0}});
  EXPECT_NEAR(cam.curve->at(0.5).value, 1.5 * 0.5 - 0.5 * 0.125, 1e-12);
  EXPECT_NEAR(cam.curve->at(1.0).curvature, -3.0, 1e-8);
  EXPECT_NEAR(cam.curve->at(-1.0).value, -1.5, 1e-12);
  EXPECT_NEAR(cam.travel.ub, 1.0, 1e-12);
  EXPECT_NEAR(cam.travel.lb, 0.0, 1e-12);
}

TEST(Cam, TravelIsAllThatTheCurveReachesAlsoBetweenPoints) {
  const Cam cam = make_cam(kPress, kTurn);
  EXPECT_LT(cam.travel.lb, -1e-4);
  EXPECT_GT(cam.travel.lb, -2e-3);
  EXPECT_GT(cam.travel.ub, 0.05);
  EXPECT_LT(cam.travel.ub, 0.052);
}

TEST(Cam, SaysWhatIsWrongWithItsPoints) {
  EXPECT_EQ(cam_fault({{0.0, 1.0}}), "a cam needs 2 .. 200 points, got 1");
  EXPECT_EQ(cam_fault({{0.0, 1.0}, {1.0, 1.0}}, kTurn), "a cam needs 3 .. 200 points, got 2");
  EXPECT_EQ(cam_fault({{0.0, 0.0}, {0.3, 0.1}, {0.3, 0.2}}),
            "positions of the leader must grow from point to point, got 0.3 after 0.3");
  EXPECT_EQ(cam_fault({{0.0, 0.0}, {0.5, 0.1}, {1.5, 0.0}}, 1.0),
            "points must end where the first one repeats, at 1, got 1.5");
  EXPECT_EQ(cam_fault({{0.0, 0.0}, {0.5, 0.1}, {1.0, 0.2}}, 1.0),
            "a point where the first one repeats must be the same, expected 0, got 0.2");
  EXPECT_EQ(cam_fault({{0.0, 0.0}, {0.5, 0.1}, {1.0, 0.0}}, 1.0), "");
  EXPECT_THROW(make_cam({{0.0, 1.0}}), SetupError);
}

// A crank in space, and on it a slide that a cam moves: weight and Coriolis forces of both.
ChainModel machine(const Case& cam) {
  const std::string inertia =
      "<inertia ixx='0.02' iyy='0.03' izz='0.04' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  const std::string urdf =
      "<robot name='cam'><link name='base'/><link name='crank'><inertial><origin xyz='0.02 0.01 "
      "0.1'/><mass value='1'/>" +
      inertia + "<link name='ram'><inertial><origin xyz='0.1 0.03 0'/><mass value='4'/>" + inertia +
      "<joint name='turn' type='continuous'><parent link='base'/><child link='crank'/><axis xyz='0 "
      "1 0'/></joint><joint name='slide' type='prismatic'><parent link='crank'/><child "
      "link='ram'/><origin xyz='0.1 0.2 0' rpy='0.3 0.2 0.1'/><axis xyz='0 0.6 0.8'/>"
      "<limit lower='-1' upper='1' velocity='3' effort='9'/></joint></robot>";
  ChainOptions options;
  options.couplings = {{"slide", "turn", 1.0, 0.0, make_cam(cam.points, cam.period).curve}};
  return ChainModel::from_urdf_text(urdf, "cam.urdf", options);
}

struct Energy {
  double kinetic = 0.0, potential = 0.0;
};
Energy energy_at(ChainData& chain, double q, double dq) {
  chain.update(VectorA::Constant(1, q), VectorA::Constant(1, dq));
  return {0.5 * chain.M()(0, 0) * dq * dq, chain.potential_energy()};
}

TEST(Cam, TwistAndBiasOfWhatItMovesAreThoseOfItsMotion) {
  for (const Case& cam : kCases) {
    const ChainModel model = machine(cam);
    ChainData chain(model);
    const int ram = model.frame("ram");
    constexpr double kSpeed = 1.7, kStep = 1e-5;
    for (const double q : {0.13, 0.71, 0.97}) {
      const auto at = [&](double position) {
        chain.update_kinematics(VectorA::Constant(1, position), VectorA::Constant(1, kSpeed));
        return chain.twist(ram);
      };
      const Vector6 slope = (at(q + kStep * kSpeed) - at(q - kStep * kSpeed)) / (2.0 * kStep);
      const Vector6 twist = at(q);
      EXPECT_LT((twist - chain.jacobian(ram) * kSpeed).norm(), 1e-12);
      EXPECT_LT((chain.bias_acceleration(ram) - slope).norm(), 1e-5);
    }
  }
}

// torques from energies alone
TEST(Cam, ItsReactionIsThatOfItsEnergy) {
  constexpr double kSpeed = 1.3, kStep = 1e-5;
  for (const Case& cam : kCases) {
    ChainData chain(machine(cam));
    double largest = 0.0;
    for (double q = -0.4; q < 0.95; q += 0.0931) {
      const Energy before = energy_at(chain, q - kStep, kSpeed);
      const Energy after = energy_at(chain, q + kStep, kSpeed);
      const double kinetic = (after.kinetic - before.kinetic) / (2.0 * kStep);
      const double potential = (after.potential - before.potential) / (2.0 * kStep);
      energy_at(chain, q, kSpeed);
      EXPECT_NEAR(chain.gravity()[0], potential, 1e-6);
      EXPECT_NEAR(chain.c()[0], kinetic + potential, 1e-6);  // at a constant speed
      largest = std::max(largest, std::abs(kinetic));
      const VectorA ddq = VectorA::Constant(1, -0.7);
      const VectorA torque =
          chain.inverse_dynamics(VectorA::Constant(1, q), VectorA::Constant(1, kSpeed), ddq);
      EXPECT_NEAR(torque[0], (chain.M() * ddq + chain.c())[0], 1e-10);
    }
    EXPECT_GT(largest, 1e-3);
  }
}

// Largest change of energy in ten seconds, over the largest kinetic energy; by Runge and Kutta's
// method of fourth order.
double energy_error(const ChainModel& model, double step) {
  ChainData chain(model);
  using State = Eigen::Vector2d;  // position and speed
  const auto rate = [&](const State& s) -> State {
    chain.update(VectorA::Constant(1, s[0]), VectorA::Constant(1, s[1]));
    return {s[1], -chain.c()[0] / chain.M()(0, 0)};
  };
  State s(0.2, 2.0);
  const auto total = [](const Energy& energy) { return energy.kinetic + energy.potential; };
  const double first = total(energy_at(chain, s[0], s[1]));
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i < static_cast<int>(10.0 / step); ++i) {
    const State a = rate(s), b = rate(s + 0.5 * step * a), c = rate(s + 0.5 * step * b);
    const State d = rate(s + step * c);
    s += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    const Energy energy = energy_at(chain, s[0], s[1]);
    worst = std::max(worst, std::abs(total(energy) - first));
    largest = std::max(largest, energy.kinetic);
  }
  return worst / largest;
}

TEST(Cam, AFreeCrankKeepsItsEnergyForTenSeconds) {
  for (const Case& cam : kCases) {
    const double coarse = energy_error(machine(cam), 1e-3), fine = energy_error(machine(cam), 5e-4);
    EXPECT_LT(coarse, 1e-4);
    EXPECT_LT(fine, 0.3 * coarse);  // all of it is that of the integration
  }
}

}  // namespace
}  // namespace hg::model
