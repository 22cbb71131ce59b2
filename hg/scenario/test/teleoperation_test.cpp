// A device whose twin is pushed by a remote machine: the whole machine, its simulated person and
// the simulated remote side.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/core/rotation.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/options.h"
#include "hg/scenario/session.h"

namespace hg::scenario {
namespace {

config::Scenario shipped(const std::string& name) {
  return config::load_scenario("models/scenarios/" + name + ".yaml");
}

// Plays a scenario and keeps what the test looks at.
struct Moment {
  double time_s;
  TeleoperationReport remote;
  TwinForce force;
  double hand;  ///< y of the handle, m
};

std::vector<Moment> played(const std::string& name) {
  Session session(shipped(name));
  std::vector<Moment> moments;
  while (session.advance()) {
    const Sample& now = session.sample();
    moments.push_back({now.record.time_s, now.teleoperation, now.operator_input.twin_force,
                       now.record.T_B_H.p.y()});
  }
  EXPECT_EQ(session.record().fault.code, FaultCode::kNone);
  return moments;
}

const std::vector<Moment>& remote_arm() {
  static const std::vector<Moment> moments = played("remote_arm");
  return moments;
}

double running_since() {
  const auto first = std::ranges::find(remote_arm(), RemoteLink::kEngaged,
                                       [](const Moment& m) { return m.remote.link; });
  return first->time_s;
}

// The moment `s` seconds after the first engagement.
const Moment& at(double s) {
  const double time_s = running_since() + s;
  return *std::ranges::find_if(remote_arm(), [&](const Moment& m) { return m.time_s >= time_s; });
}

TEST(RemoteArm, FollowsAndIsFelt) {
  double most = 0.0, deepest = 0.0;
  for (const Moment& now : remote_arm()) {
    if (now.remote.x_true.size() == 0) continue;
    most = std::max(most, std::abs(now.force.w_E[1]));
    deepest = std::max(deepest, now.remote.x_true[1]);
  }
  EXPECT_GT(most, 8.0);
  EXPECT_GT(deepest, 0.2);
  EXPECT_LT(deepest, 0.21);
}

TEST(RemoteArm, StaysWhereItIsWhileTheClutchIsOpenAndWhenItCloses) {
  const double before = at(18.5).remote.x_true[1];
  const double closed = at(20.0).hand;
  double led = 0.0;
  for (const Moment& now : remote_arm()) {
    const double s = now.time_s - running_since();
    if (s < 18.5 || s > 20.8) continue;
    const double moved = std::abs(now.remote.x_true[1] - before);
    if (s > 20.0) led = std::max(led, std::abs(now.hand - closed));
    ASSERT_LT(moved, led + 1e-3) << s;
  }
  EXPECT_LT(at(19.9).hand - at(18.1).hand, -0.1) << "the hand has moved";
  EXPECT_EQ(at(19.0).remote.link, RemoteLink::kReleased);
  EXPECT_EQ(at(20.5).remote.link, RemoteLink::kEngaged);
}

TEST(RemoteArm, WithoutALinkTheForceFadesAndTheToolHoldsUntilTheClutchIsUsed) {
  const auto lost = std::ranges::find(remote_arm(), RemoteLink::kLost,
                                      [](const Moment& m) { return m.remote.link; });
  ASSERT_NE(lost, remote_arm().end());
  EXPECT_EQ(lost->remote.cause, RemoteCause::kSilent);
  EXPECT_GT(lost->force.w_E.norm(), 1.0) << "the hand was pressing";
  for (auto now = lost; now != remote_arm().end(); ++now) {
    const double since = now->time_s - lost->time_s;
    if (since > 0.2 && now->remote.link == RemoteLink::kLost) {
      ASSERT_EQ(now->force.w_E.norm(), 0.0) << since;
    }
  }
  EXPECT_EQ(at(29.5).remote.link, RemoteLink::kLost) << "the link is back, the clutch was not used";
  EXPECT_EQ(at(31.0).remote.link, RemoteLink::kEngaged);
}

// A run whose hand is dragged, as by a page.
struct Dragged {
  config::Scenario scenario;
  std::unique_ptr<Session> session;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  ///< where the hand is dragged to
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();  ///< how it is turned there; zero: it may turn

  explicit Dragged(const std::string& mapping = "tool")
      : scenario(load({.scenario = "remote_arm",
                       .user = "mouse",
                       .changes = {"scenario.teleoperation.mapping=" + mapping}})) {
    session = std::make_unique<Session>(scenario);
    while (session->sample().teleoperation.link != RemoteLink::kEngaged) {
      const bool is_running = session->record().mode == Mode::kRunning;
      session->input().hand_target = {.active = true, .p_B = session->record().T_B_H.p};
      if (!session->advance() || session->record().time_s > 10.0) break;
      if (!is_running) p = session->record().T_B_H.p;
    }
  }
  const Sample& now() const { return session->sample(); }
  void drag_to(double y, double duration_s) {
    const double from = p.y();
    const double begin_s = now().record.time_s;
    while (now().record.time_s < begin_s + duration_s) {
      p.y() = from + (y - from) * (now().record.time_s - begin_s) / duration_s;
      session->input().hand_target = {.active = true, .p_B = p, .turns = !R.isZero(), .R_B = R};
      ASSERT_TRUE(session->advance());
      if (watch) watch();
    }
  }
  std::function<void()> watch;
};

TEST(RemoteArm, IsLedByAHandThatIsDraggedAndItsWallIsFelt) {
  Dragged run;
  ASSERT_EQ(run.now().teleoperation.link, RemoteLink::kEngaged);
  double felt = 0.0, deepest = 0.0;
  run.watch = [&] {
    felt = std::max(felt, -run.now().operator_input.twin_force.w_E[1]);
    deepest = std::max(deepest, run.now().teleoperation.x_true[1]);
  };
  const double start = run.p.y();
  run.drag_to(start + 0.3, 3.0);
  run.drag_to(start + 0.3, 2.0);
  EXPECT_GT(deepest, 0.19);
  EXPECT_LT(deepest, 0.215);
  EXPECT_GT(felt, 4.0);
}

TEST(RemoteArm, DoesNotJumpWhenAnOperatorClosesTheClutchElsewhere) {
  Dragged run;
  const double start = run.p.y();
  run.drag_to(start + 0.1, 1.5);
  run.drag_to(start + 0.1, 1.0);
  run.session->input().is_clutch_open = true;
  run.drag_to(start - 0.15, 2.0);
  run.drag_to(start - 0.15, 1.0);
  EXPECT_EQ(run.now().teleoperation.link, RemoteLink::kReleased);
  const double before = run.now().teleoperation.x_true[1];
  EXPECT_NEAR(before, 0.1, 0.03) << "the tool has stayed";
  EXPECT_LT(run.now().record.T_B_H.p.y() - start, -0.1) << "the hand has moved";
  run.session->input().is_clutch_open = false;
  double moved = 0.0;
  const double closed = run.now().record.T_B_H.p.y();
  run.watch = [&] {
    const double led = std::abs(run.now().record.T_B_H.p.y() - closed);
    const double way = std::abs(run.now().teleoperation.x_true[1] - before);
    moved = std::max(moved, way - led);
  };
  run.drag_to(start - 0.15, 2.0);
  EXPECT_EQ(run.now().teleoperation.link, RemoteLink::kEngaged);
  EXPECT_LT(moved, 1e-3);
  run.watch = nullptr;
  run.drag_to(start - 0.05, 2.0);
  EXPECT_GT(run.now().teleoperation.x_true[1] - before, 0.02) << "it follows from there";
}

// Turn of the remote tool from its start.
Eigen::Vector3d turn_of(const Sample& now, double lever) {
  return now.teleoperation.x_true.tail<3>() / lever;
}

TEST(RemoteArm, TurnsAsTheHandDoesAndNotWhenTheClutchCloses) {
  Dragged run("pose");
  const double lever = run.scenario.teleoperation->lever;
  ASSERT_EQ(run.now().teleoperation.x_true.size(), 6);
  const double start = run.p.y();
  const Eigen::Matrix3d level = run.now().record.T_B_H.R;
  const auto turned = [&](double yaw) {
    return Eigen::Matrix3d(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * level);
  };
  run.R = turned(0.4);
  run.drag_to(start, 3.0);
  const double hand = rotation_between(level, run.now().record.T_B_H.R).z();
  EXPECT_GT(hand, 0.2) << "the hand has turned";
  EXPECT_NEAR(turn_of(run.now(), lever).z(), hand, 0.03);
  EXPECT_NEAR(turn_of(run.now(), lever).head<2>().norm(), 0.0, 0.06);

  run.session->input().is_clutch_open = true;
  run.drag_to(start, 0.5);
  const PortVector before = run.now().teleoperation.x_true;
  run.R = turned(-0.3);
  run.drag_to(start - 0.1, 3.0);
  EXPECT_LT(rotation_between(level, run.now().record.T_B_H.R).z(), -0.1);
  run.session->input().is_clutch_open = false;
  const Pose closed = run.now().record.T_B_H;
  double moved = 0.0, turned_by = 0.0, led = 0.0, led_by = 0.0;
  run.watch = [&] {
    const Pose& hand_now = run.now().record.T_B_H;
    const PortVector way = run.now().teleoperation.x_true - before;
    led = std::max(led, (hand_now.p - closed.p).norm());
    led_by = std::max(led_by, rotation_between(closed.R, hand_now.R).norm());
    moved = std::max(moved, way.head<3>().norm() - led);
    turned_by = std::max(turned_by, way.tail<3>().norm() / lever - led_by);
  };
  run.drag_to(start - 0.1, 2.0);
  EXPECT_EQ(run.now().teleoperation.link, RemoteLink::kEngaged);
  EXPECT_LT(moved, 1e-3);
  EXPECT_LT(turned_by, 5e-3);
  run.watch = nullptr;
  run.R = turned(0.1);
  run.drag_to(start - 0.1, 3.0);
  EXPECT_GT(turn_of(run.now(), lever).z() - before[5] / lever, 0.1) << "it turns on from there";
}

// Largest step of felt force and of the tool's speed in a period.
struct Steps {
  double force = 0.0, speed = 0.0;
  Vector6 force_before = Vector6::Zero();
  PortVector x, v;

  void add(const Sample& now) {
    const Vector6& w = now.operator_input.twin_force.w_E;
    const PortVector& x_now = now.teleoperation.x_true;
    if (x.size() == x_now.size()) {
      force = std::max(force, (w - force_before).head<3>().norm());
      const PortVector v_now = (x_now - x) / 1e-3;
      if (v.size() == v_now.size()) speed = std::max(speed, (v_now - v).norm());
      v = v_now;
    }
    x = x_now;
    force_before = w;
  }
};

TEST(RemoteArm, ScalesChangeWhileItPressesWithoutABump) {
  Dragged run;
  const double start = run.p.y();
  run.drag_to(start + 0.3, 3.0);
  run.drag_to(start + 0.3, 2.0);
  const double felt = -run.now().operator_input.twin_force.w_E[1];
  const double at = run.now().teleoperation.x_true[1];
  ASSERT_GT(felt, 4.0);
  Steps steps;
  run.watch = [&] { steps.add(run.now()); };
  run.session->input().change = {Parameter::kForceScale, 1, 2.0};
  run.drag_to(start + 0.3, 3.0);
  EXPECT_EQ(run.now().teleoperation.force_scale[1], 2.0);
  EXPECT_EQ(run.now().teleoperation.force_scale[0], 1.0) << "the other axes are as they were";
  EXPECT_NEAR(run.now().operator_input.twin_force.w_E[1], 2.0 * run.now().teleoperation.f_true[1],
              0.5);
  run.session->input().change = {Parameter::kMotionScale, 1, 0.25};
  run.drag_to(start + 0.3, 3.0);
  EXPECT_LT(steps.force, 0.1) << "N per ms";
  EXPECT_LT(steps.speed, 0.02) << "m/s per ms";
  EXPECT_NEAR(run.now().teleoperation.x_true[1], at, 5e-3) << "the tool stays at the wall";
}

TEST(RemoteArm, MovesByTheScaleOfEachAxis) {
  Dragged run;
  const double start = run.p.y();
  run.session->input().change = {Parameter::kMotionScale, 1, 0.5};
  run.drag_to(start, 3.0);
  const double hand = run.now().record.T_B_H.p.y(), tool = run.now().teleoperation.x_true[1];
  run.drag_to(start + 0.15, 3.0);
  run.drag_to(start + 0.15, 1.0);
  const double led = run.now().record.T_B_H.p.y() - hand;
  EXPECT_GT(led, 0.08);
  EXPECT_NEAR(run.now().teleoperation.x_true[1] - tool, 0.5 * led, 3e-3);
}

TEST(RemoteArm, AScaleOutOfRangeOrOfNoAxisIsRefused) {
  Dragged run;
  for (const ParameterChange& change : {ParameterChange{Parameter::kForceScale, 3, 2.0},
                                        ParameterChange{Parameter::kMotionScale, 0, 1e3}}) {
    run.session->input().change = change;
    ASSERT_TRUE(run.session->advance());
    EXPECT_EQ(run.now().record.change, ChangeStatus::kRefused);
  }
  run.drag_to(run.p.y(), 1.0);
  EXPECT_EQ(run.now().teleoperation.motion_scale, Eigen::Vector3d::Ones());
  EXPECT_EQ(run.now().teleoperation.force_scale, Eigen::Vector3d::Ones());
}

TEST(RemoteArm, TheEndOfItsRangeIsFeltWithinTwoMillimetres) {
  Dragged run;
  const double start = run.p.y();
  double deepest = 0.0, tool = 0.0, felt = 0.0, before = 0.0;
  run.watch = [&] {
    const double force = run.now().operator_input.twin_force.w_E[1];
    const double beyond = -0.5 - run.now().teleoperation.x_leader[1];
    tool = std::min(tool, run.now().teleoperation.x_true[1]);
    felt = std::max(felt, force);
    if (force <= 10.0 && beyond > before) deepest = std::max(deepest, beyond);
    before = beyond;
  };
  run.drag_to(start - 0.6, 5.0);
  run.drag_to(start - 0.6, 1.0);
  EXPECT_GT(felt, 10.0);
  EXPECT_LT(deepest, 2.1e-3) << "with 10 N";
  EXPECT_GT(tool, -0.503) << "the tool stays in its range";
}

TEST(Excavator, FarAwayMeetsTheGroundAndItsTwinFeelsIt) {
  double most = 0.0, apart = 0.0;
  for (const Moment& now : played("teleoperation")) {
    if (now.force.tau.size() == 0) continue;
    most = std::max(most, now.force.tau[1]);
    const PortVector lag = now.remote.x_leader - now.remote.x_true;
    if (now.time_s > 14.5 && now.time_s < 15.5) apart = lag.lpNorm<Eigen::Infinity>();
    EXPECT_EQ(now.force.tau[0], 0.0);
  }
  EXPECT_GT(most, 20.0);
  EXPECT_LT(apart, 0.01);
}

TEST(RemoteArm, ReplaysBitForBitFromItsInputs) {
  const config::Scenario scenario = shipped("remote_arm");
  Session session(scenario);
  controller::Cycle cycle = make_cycle(scenario);
  CommandFrame command;
  CycleRecord record;
  double pushed = 0.0;
  for (int k = 0; k < 9000 && session.advance(); ++k) {
    const Sample& now = session.sample();
    cycle.step(now.sensors, now.operator_input, command, record);
    ASSERT_EQ(record.state_hash, now.record.state_hash) << k;
    pushed = std::max(pushed, now.operator_input.twin_force.w_E.norm());
  }
  EXPECT_GT(pushed, 1.0);
}

// A force of the test's own.
struct Push final : TwinForceSource {
  TwinForce force;
  void step(const TwinNow&, TwinForce& push, TeleoperationReport&) noexcept override {
    push = force;
  }
};

struct Pushed {
  config::Scenario scenario;
  Push push;
  controller::Cycle cycle;
  std::unique_ptr<device::Device> device;
  runtime::Session session;

  explicit Pushed(const std::string& name)
      : scenario(shipped(name)),
        cycle(make_cycle(scenario)),
        device(make_simulated_device(scenario)),
        session(cycle, *device, {.twin_force = &push}) {
    while (session.record().mode != Mode::kRunning && session.record().cycle < 5000) {
      session.advance();
    }
    for (int k = 0; k < 400; ++k) session.advance();
  }
};

TEST(TwinForce, AcceleratesTheTwinByItsMass) {
  Pushed pushed("free_space");
  const Eigen::Vector3d before = pushed.session.record().a_H;
  pushed.push.force.w_E[0] = 3.0;
  pushed.session.advance();
  EXPECT_NEAR(pushed.session.record().a_H.x() - before.x(), 3.0 / 6.0, 0.05);
}

TEST(TwinForce, OfTheWrongKindStopsTheDeviceWithItsName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault_of = [](const TwinForce& force) {
    Pushed pushed("excavator");
    EXPECT_EQ(pushed.session.record().mode, Mode::kRunning);
    pushed.push.force = force;
    pushed.session.advance();
    const CycleRecord& record = pushed.session.record();
    EXPECT_EQ(record.fault.code, FaultCode::kTwinForceWrong);
    EXPECT_TRUE(record.twin.ddq_a.allFinite());
    EXPECT_EQ(record.mode, Mode::kStopping);
    return record.fault;
  };
  TwinForce force;
  force.w_E[4] = nan;
  EXPECT_EQ(fault_of(force).index, 4);
  force.w_E[4] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fault_of(force).index, 4);
  force.w_E[4] = 0.0;
  force.w_E[2] = 151.0;
  EXPECT_EQ(fault_of(force).limit, 150.0);
  force.w_E[2] = 0.0;
  force.tau = VectorA::Zero(4);
  force.tau[3] = nan;
  EXPECT_EQ(fault_of(force).index, 9);
  force.tau = VectorA::Ones(3);
  EXPECT_EQ(fault_of(force).value, 3.0) << "three torques for four joints";
}

// Free motion, as the figures of Haptify are measured in it.
TEST(RemoteArm, WithoutDelayAddsNothingToWhatIsFeltInFreeMotion) {
  const auto hash_with = [](const std::vector<std::string>& changes) {
    Session session(load({.scenario = "free_space", .changes = changes}));
    for (int k = 0; k < 6000 && session.advance(); ++k) continue;
    if (!changes.empty()) {
      EXPECT_EQ(session.sample().teleoperation.link, RemoteLink::kEngaged);
      EXPECT_GT(session.sample().teleoperation.x_true.norm(), 0.01) << "the tool follows";
    }
    return session.record().state_hash;
  };
  const std::string key = "scenario.teleoperation.";
  const std::vector<std::string> room = {key + "remote.lowest_m=[-9, -9, -9]",
                                         key + "remote.highest_m=[9, 9, 9]"};
  const std::uint64_t without = hash_with({});
  for (const char* method : {"position_force", "model_mediated"}) {
    std::vector<std::string> changes = room;
    changes.push_back(key + "method=" + method);
    EXPECT_EQ(hash_with(changes), without) << method;
  }
}

TEST(TwinForce, ThatIsZeroChangesNothing) {
  const auto hash_after = [](bool has_source) {
    const config::Scenario scenario = shipped("excavator");
    controller::Cycle cycle = make_cycle(scenario);
    const auto device = make_simulated_device(scenario);
    Push push;
    push.force.tau = VectorA::Zero(4);
    runtime::SessionPlan plan;
    if (has_source) plan.twin_force = &push;
    runtime::Session session(cycle, *device, plan);
    for (int k = 0; k < 4000; ++k) session.advance();
    return session.record().state_hash;
  };
  EXPECT_EQ(hash_after(true), hash_after(false));
}

}  // namespace
}  // namespace hg::scenario
