/// Units on the links of the reference device, whose joints move along smooth curves and shake by
/// something that is not in the reference.
#include "hg/controller/estimation/inertial_units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "hg/core/allocation_counter.h"
#include "hg/core/cross.h"
#include "hg/core/error.h"

namespace hg::estimation {
namespace {

constexpr double kDt = 1e-3;
constexpr int kJoints = 8;
constexpr double kShake = 2.0, kShake_Hz = 20.0;  // rad/s^2 of the arm's joints
constexpr double kLearning_s = 15.0;

const model::ChainModel& device_chain() {
  static const model::ChainModel chain =
      model::ChainModel::from_urdf_file("models/haptic_giant/haptic_giant.urdf");
  return chain;
}

std::vector<int> frames_of(std::initializer_list<const char*> links) {
  std::vector<int> frames;
  for (const char* link : links) frames.push_back(device_chain().frame(link));
  return frames;
}

// Each joint goes to and fro with a frequency of its own; the arm shakes besides.
struct Joints {
  VectorPM q = VectorPM::Zero(kJoints), dq = q, ddq = q, expected = q;

  explicit Joints(double t) {
    const double middle[kJoints] = {0.0, 0.0, 0.3, 1.5, -0.6, 1.3, 0.2, 0.4};
    for (int i = 0; i < kJoints; ++i) {
      const double w = 2.0 * std::numbers::pi * (0.25 + 0.07 * i);
      const double size = i < 2 ? 0.3 : 0.5;
      q[i] = middle[i] + size * std::sin(w * t + i);
      dq[i] = size * w * std::cos(w * t + i);
      expected[i] = -size * w * w * std::sin(w * t + i);
      ddq[i] = expected[i];
      if (i < 2) continue;
      const double v = 2.0 * std::numbers::pi * kShake_Hz, phase = v * t + 2.0 * i;
      q[i] -= kShake / (v * v) * std::sin(phase);
      dq[i] -= kShake / v * std::cos(phase);
      ddq[i] += kShake * std::sin(phase);
    }
  }
};

// How a unit is glued on.
struct Mounting {
  Eigen::Matrix3d R_U_L;
  Eigen::Vector3d p;
};

Mounting mounting(int unit) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, 0.3 * unit, -0.5).normalized();
  return {Eigen::AngleAxisd(0.8 + 0.6 * unit, axis).toRotationMatrix(),
          {0.05 + 0.01 * unit, -0.08, 0.1}};
}

// The device for a test: units one period late, the root bent by `bend` that no encoder sees.
class Machine {
 public:
  explicit Machine(const std::vector<int>& frames, bool feeds_back = false)
      : frames_(frames),
        units_({.frames = frames, .delay = kDt, .feeds_back = feeds_back}, kDt, 100.0, 8.0,
               device_chain(), 2) {}

  InertialReadings readings(double t) {
    const Joints joints(t);
    model::ChainData chain(device_chain());
    chain.update_kinematics(joints.q, joints.dq);
    InertialReadings all(6 * static_cast<Eigen::Index>(frames_.size()));
    const Eigen::Vector3d root = chain.pose(frames_.front()).p;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const auto [R_U_L, p] = mounting(static_cast<int>(i));
      const Pose& T_B_L = chain.pose(frames_[i]);
      Vector6 a = chain.jacobian(frames_[i]) * joints.ddq + chain.bias_acceleration(frames_[i]);
      const Vector6 bent = bend * std::sin(2.0 * std::numbers::pi * 15.0 * t);
      a.head<3>() += bent.head<3>() + bent.tail<3>().cross(T_B_L.p - root);
      a.tail<3>() += bent.tail<3>();
      const Eigen::Matrix3d R_L_B = T_B_L.R.transpose();
      const Eigen::Vector3d omega = R_L_B * chain.twist(frames_[i]).tail<3>();
      const Eigen::Vector3d alpha = R_L_B * a.tail<3>();
      const Eigen::Vector3d at_place = R_L_B * (a.head<3>() + Eigen::Vector3d(0, 0, 9.81)) +
                                       alpha.cross(p) + omega.cross(omega.cross(p));
      const auto at = 6 * static_cast<Eigen::Index>(i);
      all.segment<3>(at) = 1.003 * (R_U_L * at_place) + Eigen::Vector3d(0.1, -0.15, 0.05);
      all.segment<3>(at + 3) = 0.998 * (R_U_L * omega) + Eigen::Vector3d(0.004, 0.002, -0.005);
    }
    return all;
  }

  // one period; `corrupt` may change what the units show
  template <typename Corrupt>
  void step(Corrupt&& corrupt) {
    InertialReadings shown = readings(time_s - kDt);
    corrupt(shown);
    const Joints now(time_s);
    units_.step(shown, {.measured = now.q, .q = now.q, .dq = now.dq, .ddq_expected = now.expected},
                state);
    time_s += kDt;
  }
  void run(double seconds) {
    for (const double end_s = time_s + seconds; time_s < end_s;) step([](InertialReadings&) {});
  }
  // of the last sample
  Joints truth() const { return Joints(time_s - kDt); }
  InertialReport report() const { return units_.report(state); }
  const InertialUnits& units() const { return units_; }

  // directions of the gantry's axes in the plane
  Eigen::Matrix2d axes() const {
    model::ChainData chain(device_chain());
    chain.update_kinematics(Joints(0.0).q, Joints(0.0).dq);
    return chain.jacobian(chain.model().frame("ppu2")).topLeftCorner<2, 2>();
  }
  // rms of the accelerations of the arm over `seconds`, by the units over by the reference
  double share_of_error(double seconds) {
    double by_units = 0.0, by_reference = 0.0;
    for (const double end_s = time_s + seconds; time_s < end_s;) {
      run(kDt);
      const Joints now = truth();
      by_units += (report().ddq - now.ddq).tail(6).squaredNorm();
      by_reference += (now.expected - now.ddq).tail(6).squaredNorm();
    }
    return std::sqrt(by_units / by_reference);
  }

  InertialUnitsState state;
  double time_s = 0.0;
  Vector6 bend = Vector6::Zero();

 private:
  std::vector<int> frames_;
  InertialUnits units_;
};

const std::vector<int>& all_links() {
  static const std::vector<int> frames = frames_of({"ppu2", "m1", "m2", "m3", "m4", "m5", "m6"});
  return frames;
}

TEST(InertialUnits, SeeAccelerationsThatTheReferenceLacks) {
  Machine machine(all_links());
  machine.run(kLearning_s);
  EXPECT_EQ(machine.state.trust.minCoeff(), 1.0);
  // what is held over the period of the delay is 2 pi 20 Hz 1 ms = 0.13 of it late
  EXPECT_LT(machine.share_of_error(2.0), 0.2);
}

TEST(InertialUnits, FindHowTheySit) {
  Machine machine(all_links());
  machine.run(kLearning_s);
  for (std::size_t i = 4; i < all_links().size();
       ++i) {  // links that turn about more than one axis
    SCOPED_TRACE(i);
    const Mounting truth = mounting(static_cast<int>(i));
    const UnitCalibration& unit = machine.state.units[i];
    const AccelerometerGains gains = gains_of(unit);
    const Eigen::Matrix3d W = unit.gyroscope.topRows<3>().transpose();
    EXPECT_LT((W - 0.998 * truth.R_U_L).cwiseAbs().maxCoeff(), 0.01);
    EXPECT_LT((gains.of_a - 1.003 * truth.R_U_L).cwiseAbs().maxCoeff(), 0.02);
    EXPECT_LT((gains.of_alpha + 1.003 * truth.R_U_L * cross_matrix(truth.p)).cwiseAbs().maxCoeff(),
              0.01);
  }
}

TEST(InertialUnits, AnySubsetIsBetterThanNone) {
  for (const auto& links : {frames_of({"m2", "m4", "m6"}), frames_of({"m6"}), frames_of({"m3"})}) {
    Machine machine(links);
    machine.run(kLearning_s);
    const double share = machine.share_of_error(2.0);
    EXPECT_LT(share, 0.97);
    EXPECT_GT(share, 0.1);
  }
}

TEST(InertialUnits, ABentGantryIsNotTakenForMotionOfTheArm) {
  Machine machine(all_links());
  machine.run(kLearning_s);
  machine.bend << 0.8, 0.6, 0.0, 0.0, 0.0, 0.0;
  machine.run(2.0);  // how large that usually is is learnt, too
  EXPECT_LT(machine.share_of_error(1.0), 0.25);
  // errors of its drives and bending cannot be distinguished, but their sum is found
  Eigen::Vector2d found = Eigen::Vector2d::Zero();
  for (int k = 0; k < 200; ++k) {
    machine.run(kDt);
    const InertialReport report = machine.report();
    const Eigen::Vector2d of_drives = (report.ddq - machine.truth().expected).head(2);
    found = found.cwiseMax(report.bend_acceleration.head(2) + machine.axes() * of_drives);
  }
  EXPECT_NEAR(found.x(), 0.8, 0.08);
  EXPECT_NEAR(found.y(), 0.6, 0.06);
}

TEST(InertialUnits, ABentBaseIsSeenWhereThereIsNoGantry) {
  Machine machine(frames_of({"m1", "m2", "m3", "m4", "m5", "m6"}));
  machine.run(kLearning_s);
  machine.bend << 0.0, 0.0, 0.5, 0.0, 0.0, 0.0;
  machine.run(2.0);
  double found = 0.0;
  for (int k = 0; k < 200; ++k) {
    machine.run(kDt);
    found = std::max(found, machine.report().bend_acceleration.z());
  }
  EXPECT_NEAR(found, 0.5, 0.1);
}

TEST(InertialUnits, OneThatDiesLeavesNoBumpAndMayComeBack) {
  Machine machine(all_links());
  machine.run(kLearning_s);
  const auto dead = [](InertialReadings& shown) {
    shown.segment<6>(6 * 4).setConstant(std::numeric_limits<double>::quiet_NaN());
  };
  // how much a period changes, before and after
  const auto largest_change = [&](int periods, auto&& corrupt) {
    double most = 0.0;
    for (int k = 0; k < periods; ++k) {
      const InertialReport last = machine.report();
      machine.step(corrupt);
      most = std::max(most, (machine.report().ddq - last.ddq).tail(6).cwiseAbs().maxCoeff());
    }
    return most;
  };
  const double usual = largest_change(200, [](InertialReadings&) {});
  EXPECT_LT(largest_change(200, dead), 1.3 * usual);
  EXPECT_EQ(machine.state.trust[4], 0.0);
  EXPECT_TRUE(machine.report().ddq.allFinite());
  EXPECT_LT(machine.share_of_error(1.0), 0.5);
  machine.run(1.0);
  EXPECT_EQ(machine.state.trust[4], 1.0);
}

TEST(InertialUnits, OneThatFreezesIsLeftOut) {
  Machine machine(all_links());
  machine.run(kLearning_s);
  const InertialReadings frozen = machine.readings(machine.time_s);
  for (int k = 0; k < 50; ++k) {
    machine.step([&](InertialReadings& shown) { shown.segment<6>(6) = frozen.segment<6>(6); });
  }
  EXPECT_EQ(machine.state.trust[1], 0.0);
}

TEST(InertialUnits, OneThatCameLooseIsNotBelieved) {
  Machine machine(all_links());
  machine.run(kLearning_s);
  for (int k = 0; k < 1500; ++k) {
    machine.step([](InertialReadings& shown) { shown.segment<3>(6 * 3) *= -1.0; });
  }
  EXPECT_EQ(machine.state.trust[3], 0.0);
}

TEST(InertialUnits, NothingIsBelievedBeforeItHasMoved) {
  Machine machine(all_links());
  machine.run(1.0);
  EXPECT_EQ(machine.state.trust.maxCoeff(), 0.0);
  EXPECT_LT((machine.report().q - machine.truth().q).cwiseAbs().maxCoeff(), 2e-4);
}

TEST(InertialUnits, ReplaceTheEncodersOnlyWhereConfigured) {
  for (const bool feeds_back : {false, true}) {
    Machine machine(all_links(), feeds_back);
    machine.run(kLearning_s);
    RobotState robot;
    robot.q_m = robot.dq_m = VectorM::Zero(6);
    robot.q_p = robot.dq_p = robot.ddq_p = VectorP::Zero(2);
    machine.units().feed_back(machine.state, robot);
    EXPECT_EQ(robot.q_m.norm() > 0.0, feeds_back);
    EXPECT_EQ(robot.ddq_p.norm() > 0.0, feeds_back);
  }
}

TEST(InertialUnits, AllocateNothing) {
  Machine machine(all_links());
  machine.run(0.1);
  const InertialReadings shown = machine.readings(machine.time_s - kDt);
  const Joints now(machine.time_s);
  const EncoderSample sample = {
      .measured = now.q, .q = now.q, .dq = now.dq, .ddq_expected = now.expected};
  InertialUnits units({.frames = all_links()}, kDt, 100.0, 8.0, device_chain(), 2);
  AllocationCounter allocations;
  units.step(shown, sample, machine.state);
  EXPECT_EQ(allocations.count(), 0u);
}

TEST(InertialUnits, TooManyOrTooLateIsRefused) {
  const std::vector<int> many(kMaxInertialUnits + 1, all_links().front());
  EXPECT_THROW(InertialUnits({.frames = many}, kDt, 100.0, 8.0, device_chain(), 2), SetupError);
  EXPECT_THROW(
      InertialUnits({.frames = all_links(), .delay = 0.015}, kDt, 100.0, 8.0, device_chain(), 2),
      SetupError);
}

}  // namespace
}  // namespace hg::estimation
