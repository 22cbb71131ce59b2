#include "hg/config/simulation/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "hg/controller/rendering/catalogue.h"
#include "hg/core/open_file.h"
#include "hg/core/test/message_of.h"
#include "hg/core/test/temporary_folder.h"

namespace hg::config {
namespace {

using std::numbers::pi;

constexpr double kRounding = 1e-12;
constexpr double kWritten = 1e-5;  // angles in the files have six digits

const Scenario& door() {
  static const Scenario scenario = load_scenario("models/scenarios/door.yaml");
  return scenario;
}

const Scenario& free_space() {
  static const Scenario scenario = load_scenario("models/scenarios/free_space.yaml");
  return scenario;
}

const Scenario& excavator() {
  static const Scenario scenario = load_scenario("models/scenarios/excavator.yaml");
  return scenario;
}

std::vector<std::string> names_of(const std::vector<EventRule>& events) {
  std::vector<std::string> names;
  for (const EventRule& event : events) names.push_back(event.name);
  return names;
}

TEST(Device, HasTheLimitsOfTheHandbook) {
  const DeviceModel& model = door().device.model;
  ASSERT_EQ(model.n_p, 2);
  ASSERT_EQ(model.n_m, 6);
  // accelerations of m1..m4: what their torques can do, see device.yaml
  const std::vector<limits::JointLimits> expected = {
      {-kInfinity, kInfinity, 2.0, 6.5}, {0.20, 2.75, 2.0, 7.5},
      {-2.60, 2.60, 2.6, 15.0},          {0.20, 2.45, 2.6, 8.0},
      {-2.00, 2.10, 3.1, 40.0},          {-2.60, 2.10, 3.5, 40.0}};
  ASSERT_EQ(model.joint_limits.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(model.manipulator_joint(static_cast<int>(i)));
    EXPECT_EQ(model.joint_limits[i].q_min, expected[i].q_min);
    EXPECT_EQ(model.joint_limits[i].q_max, expected[i].q_max);
    EXPECT_EQ(model.joint_limits[i].dq_max, expected[i].dq_max);
    EXPECT_EQ(model.joint_limits[i].ddq_max, expected[i].ddq_max);
  }
}

TEST(Device, LimitsTheSumOfJointsFourAndFive) {
  const auto& sums = door().device.model.virtual_joints;
  ASSERT_EQ(sums.size(), 1u);
  EXPECT_EQ(sums[0].name, "q4+q5");
  EXPECT_EQ(sums[0].weights, (VectorM(6) << 0, 0, 0, 1, 1, 0).finished());
  EXPECT_EQ(sums[0].limits.q_min, 0.26);
  EXPECT_EQ(sums[0].limits.q_max, 2.88);
  EXPECT_EQ(sums[0].limits.dq_max, 4.0);
  EXPECT_EQ(sums[0].limits.ddq_max, 40.0);
}

TEST(Device, KeepsHandAndElbowInTheBox) {
  const DeviceModel& model = door().device.model;
  ASSERT_EQ(model.cartesian_limits.size(), 2u);
  const CartesianLimit& hand = model.cartesian_limits[0];
  const CartesianLimit& elbow = model.cartesian_limits[1];
  EXPECT_EQ(hand.name, "hand");
  EXPECT_EQ(hand.frame, model.handle);
  EXPECT_EQ(elbow.frame, model.elbow);
  EXPECT_EQ(hand.axes[1].q_min, -1.95);
  EXPECT_EQ(hand.axes[2].q_max, -0.30);
  EXPECT_EQ(hand.axes[0].dq_max, 1.5);
  EXPECT_EQ(hand.axes[0].ddq_max, 3.0);  // as the joints can
  EXPECT_EQ(hand.margin, 0.005);
  EXPECT_EQ(elbow.axes[0].q_max, 1.65);

  // Table III: 12.2 m^3
  double volume = 1.0;
  for (const limits::JointLimits& axis : hand.axes) volume *= axis.q_max - axis.q_min;
  EXPECT_NEAR(volume, 12.2, 0.05);

  // the height of the elbow is constant: no limit of any kind
  EXPECT_EQ(elbow.axes[2].q_max, kInfinity);
  EXPECT_EQ(elbow.axes[2].dq_max, kInfinity);
}

TEST(Device, HasItsFactsInItsModel) {
  const DeviceConfig& device = door().device;
  EXPECT_EQ(device.model.rate_Hz, 1000.0);
  EXPECT_EQ(device.model.drive.lag, 40e-3);
  EXPECT_EQ(device.prepositioning.k_ppu, 4.0);
  EXPECT_EQ(device.prepositioning.dq_max, 1.5);
  EXPECT_EQ(device.prepositioning.ddq_max, 2.0);
  ASSERT_EQ(device.model.gantry_range.size(), 2u);
  EXPECT_EQ(device.model.gantry_range[0].ub, 1.40);
  EXPECT_EQ(device.model.gantry_range[1].lb, -1.60);
  EXPECT_EQ(device.model.T_H_S.p, Eigen::Vector3d(0, 0, -0.0375));
  EXPECT_TRUE(device.model.has_closed_form);
  EXPECT_EQ(device.model.actuators.size(), 6u);
  EXPECT_TRUE(device.model.has_torque_limits);
}

// what a program for the real machine loads
TEST(Device, IsLoadedWithoutItsSimulation) {
  const auto reads_simulation = [](const DeviceConfig& device) {
    return std::ranges::any_of(device.sources, [](const SourceText& source) {
      return source.name.ends_with("simulation.yaml");
    });
  };
  const std::string file = "models/haptic_giant/device.yaml";
  EXPECT_FALSE(reads_simulation(load_device(file)));
  EXPECT_TRUE(reads_simulation(load_simulated_device(file)));
}

TEST(Twin, DoorHasCloserSpringAndBolt) {
  const rendering::TwinModel& twin = door().twin.model;
  ASSERT_EQ(twin.dofs.size(), 2u);
  const rendering::TwinDof& hinge = twin.dofs[0];
  EXPECT_EQ(hinge.name, "hinge");
  EXPECT_EQ(hinge.preload, 3.0);
  EXPECT_EQ(hinge.stiffness, 4.0);
  EXPECT_EQ(hinge.damping, 2.0);
  EXPECT_EQ(hinge.limits.q_max, 1.75);
  EXPECT_EQ(hinge.limits.dq_max, 1.2);
  EXPECT_TRUE(std::isfinite(hinge.limits.ddq_max));
  const rendering::TwinDof& lever = twin.dofs[1];
  EXPECT_EQ(lever.preload, 0.6);
  EXPECT_EQ(lever.stiffness, 1.2);
  EXPECT_EQ(lever.limits.q_max, 0.80);

  ASSERT_EQ(twin.locks.size(), 1u);
  EXPECT_EQ(twin.locks[0].dof, 0);
  EXPECT_EQ(twin.locks[0].position, 0.0);
  ASSERT_EQ(twin.locks[0].engaged_while.size(), 2u);
  EXPECT_EQ(twin.locks[0].engaged_while[0].dof, 1);
  EXPECT_EQ(twin.locks[0].engaged_while[0].range.ub, 0.50);
  EXPECT_EQ(twin.locks[0].engaged_while[1].range.ub, 0.03);
}

TEST(Twin, FreeBodyStartsWhereTheFileSays) {
  const rendering::TwinModel twin = free_space().twin.model;
  ASSERT_EQ(twin.dofs.size(), 6u);
  EXPECT_EQ(twin.dofs[0].name, "root x");
  EXPECT_EQ(twin.dofs[5].name, "root rz");
  EXPECT_EQ(twin.dofs[2].damping, 4.0);
  EXPECT_EQ(twin.dofs[3].damping, 0.1);
  EXPECT_FALSE(twin.dofs[2].is_angle);
  EXPECT_TRUE(twin.dofs[3].is_angle);

  model::ChainData chain(twin.chain);
  chain.update(twin.q_start, VectorA::Zero(6));
  EXPECT_NEAR(chain.M()(0, 0), 6.0, kRounding);
  EXPECT_NEAR(chain.M()(4, 4), 0.08, kRounding);
  const Pose pose = chain.pose(twin.end_effector);
  EXPECT_TRUE(pose.p.isApprox(Eigen::Vector3d(0.9, 0.0, -0.75), kRounding));
  // [HANDBOOK] 2.2: hand axis z_H = (sin s) u - (cos s) z with u along y
  EXPECT_TRUE(pose.R.col(2).isApprox(Eigen::Vector3d(0, std::sin(1.4), -std::cos(1.4)), kWritten));
  // at roll 0 the grip stands upright: x_H points up, leaning with the hand axis
  EXPECT_TRUE(pose.R.col(0).isApprox(Eigen::Vector3d(0, std::cos(1.4), std::sin(1.4)), kWritten));
}

TEST(Twin, PlacementAndFrameOffsetsDoNotMoveTheStartPose) {
  constexpr const char* kUrdf = R"(<robot name="tool"><link name="body"><inertial><mass value="3"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
    <joint name="fix" type="fixed"><parent link="body"/><child link="tip"/>
    <origin xyz="0.1 0.2 0.3" rpy="0.4 0 0.5"/></joint><link name="tip"/></robot>)";
  SourceReader reader(
      {{"tool.urdf", kUrdf},
       {"twin.yaml",
        "name: tool\nurdf: tool.urdf\nfloating_root: true\nend_effector: tip\n"
        "placement: {x_m: 1, yaw_rad: 0.7, roll_rad: 0.2}\n"
        "joints: {root: {start: {x_m: 0.5, z_m: -0.8, azimuth_rad: 1, roll_rad: 2}}}\n"}});
  const rendering::TwinModel twin = load_twin("twin.yaml", reader).model;
  model::ChainData chain(twin.chain);
  chain.update_kinematics(twin.q_start, VectorA::Zero(6));
  const Pose pose = chain.pose(twin.end_effector);
  const Pose expected =
      pose_of(HandPose{.p = {0.5, 0.0, -0.8}, .azimuth = 1.0, .pitch = 0.5 * pi, .roll = 2.0});
  EXPECT_TRUE(pose.p.isApprox(expected.p, kRounding));
  EXPECT_TRUE(pose.R.isApprox(expected.R, kRounding));
}

TEST(Twin, ExcavatorStartsInTheMiddleOfItsWork) {
  const rendering::TwinModel& twin = excavator().twin.model;
  EXPECT_TRUE(twin.q_start.isApprox(Eigen::Vector4d(0.0, 0.35, 0.9, 0.4)));
  EXPECT_EQ(twin.dofs[2].name, "stick");
  EXPECT_EQ(twin.dofs[2].damping, 8.0);
  EXPECT_EQ(twin.dofs[1].limits.q_min, 0.0);
  EXPECT_EQ(twin.dofs[1].limits.q_max, 0.95);
}

TEST(Script, FreeSpaceHandWalksTheCircleOfTheHandbook) {
  person::Script script = free_space().script.script;
  const auto& given = free_space().script.start_given;
  EXPECT_EQ(script.frame, person::ScriptFrame::kBase);
  EXPECT_TRUE(std::ranges::none_of(given, [](bool is_given) { return is_given; }));
  EXPECT_EQ(script.start[person::kGripChannel], 1.0);

  script.start[0] = 0.9;
  script.start[2] = -0.75;
  script.start[3] = 0.5 * pi;
  const auto after_circle = person::evaluate(script, 15.2);
  const double angle = 2.0 * pi * 1.15;
  EXPECT_NEAR(after_circle[0], 0.9 * std::cos(angle), kRounding);
  EXPECT_NEAR(after_circle[1], 0.9 * std::sin(angle), kRounding);
  EXPECT_NEAR(after_circle[3], 0.5 * pi + angle, kRounding);
  EXPECT_NEAR(person::evaluate(script, 17.6)[3], 3.0 * pi, kWritten);
  EXPECT_NEAR(person::evaluate(script, 21.4)[3], 2.5 * pi + 0.25, kWritten);
  EXPECT_EQ(script.duration_s, 48.0);
}

TEST(Script, TheHandTakesHoldAfterTheTareAndHasAnArm) {
  const Script& script = door().script;
  EXPECT_EQ(script.script.grasp_s, 0.7);
  EXPECT_EQ(script.hand.mass, Eigen::Vector3d(1.0, 1.5, 1.5));  // [HANDBOOK] 5.1
  EXPECT_EQ(script.hand.stiffness, Eigen::Vector3d(80, 80, 80));
  EXPECT_EQ(script.script.walk.kind, person::WalkKind::kNone);
}

TEST(Script, APresetFillsInWhatIsNotGiven) {
  SourceReader reader(std::vector<SourceText>{
      {"script.yaml", "hand: {damping_Ns_per_m: [1, 2, 3], preset: stiff}\ngrasp_s: 0.2\n"}});
  const Script script = load_script("script.yaml", free_space().twin.model, reader);
  EXPECT_EQ(script.hand.stiffness, Eigen::Vector3d(600, 400, 500));
  EXPECT_EQ(script.hand.damping, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(script.hand.grip_stiffness, 3000);
  EXPECT_EQ(script.script.grasp_s, 0.2);
}

TEST(Script, ThePathHasTheCheckpointsOfTheHandbook) {
  const Scenario scenario = load_scenario("models/scenarios/path.yaml");
  const person::Walk& walk = scenario.script.script.walk;
  ASSERT_EQ(walk.kind, person::WalkKind::kCheckpoints);
  const std::vector<Eigen::Vector3d> expected = {{-1.2, -1.5, 0},   {1.2, -1.5, 0.5 * pi},
                                                 {1.45, 0.3, pi},   {0, 0, 1.5 * pi},
                                                 {-1.45, 1.2, 0.0}, {1.0, 1.6, 0.5 * pi}};
  ASSERT_EQ(walk.checkpoints.size(), expected.size());
  ASSERT_EQ(scenario.events.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(walk.checkpoints[i].p, expected[i].head<2>());
    EXPECT_NEAR(walk.checkpoints[i].heading, expected[i].z(), kWritten);
    // the event is the same place, with the azimuth that the handle then has
    ASSERT_EQ(scenario.events[i].all_of.size(), 1u);
    const Condition& at = scenario.events[i].all_of[0];
    EXPECT_EQ(at.kind, ConditionKind::kHandleAt);
    EXPECT_EQ(at.place.head<2>(), walk.checkpoints[i].p);
    EXPECT_NEAR(
        std::remainder(at.place.z() - walk.checkpoints[i].heading - walk.azimuth_from_heading,
                       2.0 * pi),
        0.0, kWritten);
  }
}

TEST(Script, TheSlowWalkIsTheOneOfTheControlNotes) {
  const Script script = load_scenario("models/scenarios/walk.yaml").script;
  EXPECT_EQ(script.script.walk.kind, person::WalkKind::kCircle);
  EXPECT_EQ(script.script.walk.circle_radius, 0.7);
  EXPECT_EQ(script.script.walk.speed, 0.25);
  EXPECT_EQ(script.script.duration_s, 16.0);
  EXPECT_EQ(script.hand.stiffness, person::hand(person::HandPreset::kNormal).stiffness);
}

TEST(Script, DoorHandPushesAndPressesInTheFrameOfTheHandle) {
  const Script& script = door().script;
  EXPECT_EQ(script.script.frame, person::ScriptFrame::kTwinJoints);
  EXPECT_EQ(script.script.start[person::kGripChannel], 0.0);
  EXPECT_EQ(script.hand.angular_stiffness.norm(), 0.0);
  EXPECT_EQ(script.hand.force_max, 35.0);

  const auto wrench_at = [&](double t) {
    const auto channels = person::evaluate(script.script, t);
    return Vector6(Eigen::Map<const Vector6>(channels.data() + person::kWrenchChannel));
  };
  // torques on hinge and lever: J^T R w
  const auto torque = [&](double t, double hinge, double lever) {
    model::ChainData chain(door().twin.model.chain);
    const int frame = door().twin.model.end_effector;
    chain.update_kinematics(Eigen::Vector2d(hinge, lever), Eigen::Vector2d::Zero());
    const Eigen::Matrix3d R = chain.pose(frame).R;
    const Vector6 w = wrench_at(t);
    Vector6 w_B;
    w_B << R * w.head<3>(), R * w.tail<3>();
    return Eigen::VectorXd(chain.jacobian(frame).transpose() * w_B);
  };
  EXPECT_NEAR(torque(1.3125, 0.0, 0.0)[0], 0.75 * 30.0, 1e-9) << "pushes";
  EXPECT_NEAR(torque(1.9375, 0.0, 0.0)[0], -0.75 * 30.0, 1e-9) << "pulls";
  EXPECT_NEAR(torque(4.9, 0.0, 0.4)[1], 0.11 * 14.0, 1e-9) << "presses";
  EXPECT_NEAR(torque(5.5, 0.0, 0.0)[0], -0.75 * 25.0, 1e-9) << "pulls with the lever down";
  EXPECT_NEAR(torque(8.45, 0.0, 0.0)[0], 0.75 * 35.0, 1e-9) << "leans with the lever down";
  EXPECT_EQ(wrench_at(7.2).norm(), 0.0) << "has let go";

  const auto following = person::evaluate(script.script, 11.0);
  EXPECT_NEAR(following[0], 2.0, kRounding);
  EXPECT_NEAR(following[1], 0.0, kRounding);
  EXPECT_EQ(following[person::kGripChannel], 1.0);
  EXPECT_EQ(person::evaluate(script.script, 11.3)[person::kGripChannel], 0.0);
}

TEST(Script, ExcavatorHandTurnsTheBucketAboutItsAxis) {
  const Script& script = excavator().script;
  EXPECT_EQ(script.script.frame, person::ScriptFrame::kCylindrical);
  // 350 N/m in series with the grip
  const Eigen::Array3d arm = script.hand.stiffness;
  const double grip = script.hand.grip_stiffness;
  EXPECT_TRUE((arm * grip / (arm + grip)).isApproxToConstant(350.0, 1e-3));
  model::ChainData chain(excavator().twin.model.chain);
  const int frame = excavator().twin.model.end_effector;
  chain.update_kinematics(excavator().twin.model.q_start, Eigen::Vector4d::Zero());
  const auto channels = person::evaluate(script.script, 3.5);
  const Eigen::Vector3d torque =
      chain.pose(frame).R *
      Eigen::Map<const Eigen::Vector3d>(channels.data() + person::kWrenchChannel + 3);
  const Eigen::VectorXd tau = chain.jacobian(frame).bottomRows<3>().transpose() * torque;
  // -9 Nm about the pitch axis: boom up is positive, stick and bucket down
  constexpr double kDigits = 5e-3;  // Nm; the file has three digits per component
  EXPECT_NEAR(tau[0], 0.0, kDigits);
  EXPECT_NEAR(tau[1], -9.0, kDigits);
  EXPECT_NEAR(tau[2], 9.0, kDigits);
  EXPECT_NEAR(tau[3], 9.0, kDigits);
}

TEST(Script, SegmentsActInTheOrderOfTheirStart) {
  const std::vector<SourceText> texts = {
      {"script.yaml",
       "segments:\n  - {start_s: 4, duration_s: 1, by: {x_m: 1}}\n"
       "  - {start_s: 2, duration_s: 1, x_m: 5}\n"}};
  SourceReader reader(texts);
  const Script script = load_script("script.yaml", free_space().twin.model, reader);
  EXPECT_EQ(person::evaluate(script.script, 3.5)[0], 5.0);
  EXPECT_EQ(person::evaluate(script.script, 6.0)[0], 6.0);
  EXPECT_EQ(script.script.duration_s, 5.0);
}

TEST(Twin, LocksHoldTheJointTheyName) {
  const std::string yaml =
      "name: door\nurdf: models/twins/door/door.urdf\nend_effector: handle\n"
      "locks: [{name: jam, joint: lever, position_rad: 0.1, "
      "engaged_while: {hinge: {above_rad: 0.2, below_rad: 0.4}}}]\n";
  std::vector<SourceText> texts = door().twin.sources;
  texts[1].name = "models/twins/door/door.urdf";
  texts.push_back({"twin.yaml", yaml});
  SourceReader reader(texts);
  const Twin twin = load_twin("twin.yaml", reader);
  ASSERT_EQ(twin.model.locks.size(), 1u);
  const rendering::Lock& lock = twin.model.locks[0];
  EXPECT_EQ(lock.dof, 1);
  EXPECT_EQ(lock.position, 0.1);
  EXPECT_EQ(lock.engaged_while[0].dof, 0);
  EXPECT_EQ(lock.engaged_while[0].range.lb, 0.2);
  EXPECT_EQ(lock.engaged_while[0].range.ub, 0.4);
}

TEST(Scenario, NamesEveryLimitInTheOrderOfTheTasks) {
  std::vector<std::string> names;
  for (const LimitInfo& limit : door().limits) names.push_back(limit.name);
  EXPECT_EQ(names, (std::vector<std::string>{"m1",       "m2",       "m3",       "m4",
                                             "m5",       "m6",       "q4+q5",    "motor m1",
                                             "motor m2", "motor m3", "motor m4", "motor m5",
                                             "motor m6", "hand x",   "hand y",   "hand z",
                                             "elbow x",  "elbow y",  "elbow z",  "self-collision",
                                             "hinge",    "lever"}));
  EXPECT_EQ(door().limits[6].kind, LimitKind::kVirtualJoint);
  EXPECT_EQ(door().limits[7].kind, LimitKind::kMotor);
  EXPECT_FALSE(door().limits[7].range.bounded());
  EXPECT_EQ(door().limits[13].kind, LimitKind::kCartesian);
  EXPECT_FALSE(door().limits[13].is_angle);
  EXPECT_EQ(door().limits[19].kind, LimitKind::kSelfCollision);
  EXPECT_EQ(door().limits[20].kind, LimitKind::kTwinJoint);
  EXPECT_EQ(door().limits[20].range.ub, 1.75);
  EXPECT_FALSE(door().limits[18].range.bounded());
}

TEST(Scenario, DrivesThatFollowPositionsHaveMotorsThatTheLawKnows) {
  const SimulatedDeviceConfig arm = load_simulated_device("models/arms/ur5e/device.yaml");
  EXPECT_EQ(arm.control.method, tracking::Method::kDrives);
  EXPECT_EQ(arm.control.error_max, kInfinity);
  EXPECT_EQ(arm.model.motors().size(), 6u);
  EXPECT_TRUE(arm.model.has_rated_accelerations());
  EXPECT_EQ(plant_of(arm), PlantKind::kPositionDrives);
  EXPECT_FALSE(door().device.model.has_rated_accelerations());

  std::string text = read_file("models/arms/ur5e/device.yaml", 1'000'000);
  const std::string control = "control: {method: drives}";
  text.replace(text.find(control), control.size(), "control: {method: drives, latency_s: 0.01}");
  const TemporaryFolder folder;
  for (const char* file : {"ur5e.urdf", "simulation.yaml"}) {
    folder.write(std::string("ur5e/") + file,
                 read_file(std::string("models/arms/ur5e/") + file, 1'000'000));
  }
  folder.write("handle.yaml", read_file("models/arms/handle.yaml", 1'000'000));
  const std::string message =
      message_of([&] { (void)load_device(folder.write("ur5e/device.yaml", text)); });
  EXPECT_NE(message.find("latency_s"), std::string::npos) << message;
}

TEST(Scenario, WithoutMotorModelItHasNoMotorLimitsAndTheSameEvents) {
  Scenario scenario = door();
  const Scenario before = scenario;
  scenario.device.rendering.law = rendering::Law::kPaper;
  settle_law(scenario);
  EXPECT_TRUE(scenario.device.model.motors().empty());
  EXPECT_EQ(scenario.limits.size() + 6, before.limits.size());
  const auto hinge = [](const Scenario& of) {
    return of.limits[of.events[0].all_of[0].index].name;
  };
  EXPECT_EQ(hinge(before), "hinge");
  EXPECT_EQ(hinge(scenario), "hinge");
  scenario.device.rendering.law = rendering::Law::kGauss;
  settle_law(scenario);
  EXPECT_EQ(scenario.limits.size(), before.limits.size());
  EXPECT_EQ(hinge(scenario), "hinge");

  Scenario waiting = before;
  waiting.events[0].all_of[0].index = 7;
  waiting.device.rendering.bounds = rendering::Bounds::kPaper;
  EXPECT_EQ(message_of([&] { settle_law(waiting); }),
            "event 'locked': waits for 'motor m1', which is a limit only where the law models the "
            "torques of the motors: law gauss, bounds recoverable, plant elastic");
}

TEST(Scenario, ExpectsTheEventsOfTheFiguresInTheirOrder) {
  EXPECT_EQ(names_of(free_space().events),
            (std::vector<std::string>{"t_a", "t_b", "t_b'", "t_c", "t_d", "t_e", "t_f", "t_g"}));
  EXPECT_EQ(names_of(excavator().events),
            (std::vector<std::string>{"boom", "t_a", "t_b", "t_c", "t_d", "t_e", "unload"}));
  EXPECT_EQ(
      names_of(door().events),
      (std::vector<std::string>{"locked", "handle pressed", "pulled", "locked again", "unlocked",
                                "open stop", "velocity limit", "closed and locked"}));
  EXPECT_EQ(door().person, person::PersonKind::kScript);
  EXPECT_EQ(door().duration_s, 14.0);
}

TEST(Scenario, ConditionsPointAtLimitsJointsAndCoordinates) {
  const auto& pushed = door().events[0].all_of;
  ASSERT_EQ(pushed.size(), 2u);
  EXPECT_EQ(pushed[0].kind, ConditionKind::kLocked);
  EXPECT_EQ(pushed[0].index, 20);  // hinge in the catalogue
  EXPECT_EQ(pushed[1].kind, ConditionKind::kForceAbove);
  EXPECT_EQ(pushed[1].value, 10.0);

  const auto& popped = door().events[4].all_of;
  ASSERT_EQ(popped.size(), 2u);
  EXPECT_EQ(popped[0].kind, ConditionKind::kTwinAbove);
  EXPECT_EQ(popped[0].index, 1);  // lever in q_a
  EXPECT_EQ(popped[0].value, 0.5);
  EXPECT_EQ(popped[1].index, 0);

  const auto& turned = free_space().events[0].all_of;
  EXPECT_EQ(turned[0].kind, ConditionKind::kTurns);
  EXPECT_EQ(turned[0].index, 0);
  const auto& elbow = free_space().events[1].all_of;
  EXPECT_EQ(elbow[0].kind, ConditionKind::kLimit);
  EXPECT_EQ(elbow[0].index, 16);
  EXPECT_EQ(elbow[0].side, LimitState::kUpper);
  const auto& gantry = free_space().events[6].all_of;
  EXPECT_EQ(gantry[0].kind, ConditionKind::kGantryAbove);
  EXPECT_EQ(gantry[0].index, 1);
}

TEST(Scenario, LoadsAgainFromItsSourcesAlone) {
  const std::vector<SourceText>& sources = door().sources;
  ASSERT_EQ(sources.size(), 7u);
  EXPECT_EQ(sources.front().name, "models/scenarios/door.yaml");
  EXPECT_EQ(door().device.sources.front().name, "models/haptic_giant/device.yaml");
  EXPECT_EQ(door().device.sources.size(), 3u);
  EXPECT_EQ(door().twin.sources.size(), 2u);
  EXPECT_EQ(door().script.sources.size(), 1u);

  std::vector<SourceText> recorded = sources;
  for (SourceText& source : recorded) source.name.insert(0, "recorded/");  // not on this disk
  const Scenario again = load_scenario(recorded);
  EXPECT_EQ(again.title, "Door");
  EXPECT_EQ(again.events.size(), door().events.size());
  EXPECT_EQ(again.limits.size(), door().limits.size());
}

}  // namespace
}  // namespace hg::config
