/// Description of device.yaml, in the order of its reference page.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/config/law_names.h"
#include "hg/config/schema.h"

namespace hg::config {

struct DeviceJoint {
  JointUnit unit = JointUnit::kEither;
  limits::JointLimits limits;
  std::optional<ActuatorModel> actuator;
};

/// A capsule of device.yaml around the shape of a link and of what is fixed to it.
struct LinkCapsule {
  std::string name;
  int link = -1;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< Ends of its segment in the link, m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0.0;  ///< m
};

/// Two links, or else two capsules, that are not watched.
struct UnwatchedPair {
  std::vector<int> links, capsules;
};

/// A device in the making: what is known of it so far, and the names and parts it is made from.
struct DeviceDraft {
  /// Its chain comes last
  DeviceConfig device = {.model = {.chain = model::ChainModel::free_body({})}};
  std::filesystem::path tool;
  ChainPart part;
  std::vector<std::string> link_names;  ///< link names of the URDF
  int flange = -1;
  std::vector<std::string> joint_names, frame_names;  ///< names of the chain
  std::vector<DeviceJoint> joints;                    ///< all joints, with the limits of the URDF
  std::vector<int> gantry, manipulator;               ///< indices of joints
  bool has_joints = false;                            ///< both lists are usable
  JointUnit gantry_unit = JointUnit::kEither;
  std::vector<std::string> manipulator_names;
  Placement sensor;
  bool watches_collisions = true;
  std::vector<LinkCapsule> capsules;
  std::vector<UnwatchedPair> unwatched;
};

/// Whether start posture and gantry target have a closed form.
inline constexpr std::array<Choice<bool>, 2> kKinematics = {
    {{"haptic_giant", true}, {"generic", false}}};

inline constexpr JointKey kBrake = {"ddq_brake_rad_per_s2", "ddq_brake_m_per_s2"};

template <class V>
void describe_chain(V& v, DeviceDraft& d) {
  v.words("name", d.device.name, "name of the device", Need::kRequired);
  v.path("urdf", d.device.urdf, "kinematics and inertia; its limits are the defaults of joints",
         Need::kRequired);
}

/// The end effector: what the user holds, either a link of the URDF or a tool.
template <class V>
void describe_tool(V& v, DeviceDraft& d) {
  v.path("tool", d.tool, "handle with its sensor, screwed onto the flange: a tool file");
  v.name("flange", d.flange, d.link_names, "a link of the URDF", "to which the tool is screwed");
  v.rule(v.is_given("tool") == v.is_given("flange"), "tool",
         "a tool needs 'flange', and a flange needs 'tool'");
  v.rule(!v.is_given("tool") || !v.is_given("handle"), "handle",
         "the tool brings the handle: give either 'handle' or 'tool'");
  v.rule(!v.is_given("tool") || !v.is_given("sensor"), "sensor",
         "the file of the tool says where the sensor is");
  v.rule(v.is_given("tool") || v.is_given("handle"), "",
         "a device needs 'handle' (a link of the URDF) or 'tool' with 'flange'");
}

template <class V>
void describe_structure(V& v, DeviceDraft& d) {
  const bool has_gantry = v.names("gantry", d.gantry, d.joint_names, "a joint of the URDF",
                                  "prepositioning joints, from the root on: at most 2, prismatic "
                                  "or revolute; without it there is no gantry") ||
                          !v.is_given("gantry");
  const bool has_manipulator =
      v.names("manipulator", d.manipulator, d.joint_names, "a joint of the URDF",
              "the joints after the gantry, to the tip", Need::kRequired);
  d.has_joints = has_gantry && has_manipulator;
  v.name("handle", d.device.model.handle, d.frame_names, "a link of the URDF",
         "frame H, held by the user; with a tool it has the name 'handle'");
  v.name("elbow", d.device.model.elbow, d.frame_names, "a link of the URDF",
         "frame to be recorded and shown");
  v.number("floor_z_m", d.device.floor_z, kAnyNumber,
           "height of the floor in B: drawn on the page and, if given, not to be hit");
  d.device.has_floor = v.is_given("floor_z_m");
  v.group(
      "sensor", [&](auto& child) { describe(child, d.sensor); },
      "force/torque sensor S in the handle frame H");
  v.path("simulation", d.device.simulation_file,
         "of the simulated device: its sensors, and how it differs from this file; without it "
         "nothing differs and the sensors are ideal");
  v.choice("kinematics", d.device.model.has_closed_form, kKinematics,
           "how the start posture and the gantry's target are found: in closed form or, for any "
           "device, numerically");
  v.number("rate_Hz", d.device.model.rate_Hz, {.lb = 100.0, .ub = 20000.0}, "cycles per second");
}

template <class V>
void describe(V& v, DeviceJoint& joint, bool is_gantry) {
  describe_positions(v, joint.limits, joint.unit);
  if (v.covers(!is_gantry)) describe_ratings(v, joint.limits, joint.unit, Need::kOptional);
}

template <class V>
void describe(V& v, VirtualJoint& joint, const std::vector<std::string>& names) {
  v.words("name", joint.name, "shown with the limit", Need::kRequired);
  joint.weights = per_joint(names.size(), 0.0);
  v.numbers_by_name(
      "weights", names, "a manipulator joint", {.lb = -1e3, .ub = 1e3},
      [&](int index, double weight) { set_joint(joint.weights, index, weight); },
      "factor of each revolute joint in the sum");
  const bool is_complete = !names.empty() && names.size() <= kMaxManipulator;
  v.rule(!is_complete || joint.weights.norm() > 0.0, "weights",
         "at least one joint must have a weight");
  describe_positions(v, joint.limits, JointUnit::kAngle);
  describe_ratings(v, joint.limits, JointUnit::kAngle, Need::kRequired);
}

template <class V>
void describe(V& v, CartesianLimit& limit, const std::vector<std::string>& frames) {
  v.words("name", limit.name, "shown with the limit", Need::kRequired);
  v.name("frame", limit.frame, frames, "a link of the URDF", "its origin is limited",
         Need::kRequired);
  limits::JointLimits ratings = {.dq_max = 1.5, .ddq_max = 5.0};  // [HANDBOOK] 3.7
  describe_ratings(v, ratings, JointUnit::kLength, Need::kOptional);
  v.number("margin_m", limit.margin, kNotNegative, "the rendered box is smaller on every side");
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    limits::JointLimits axis = ratings;
    const auto read = [&](auto& child) { describe_positions(child, axis, JointUnit::kLength); };
    if (!v.group(kAxes[i], read, "along this axis of B; without it there is no limit")) continue;
    v.rule(axis.q_max - axis.q_min > 2.0 * limit.margin, kAxes[i],
           "the margin must leave some of the range");
    limit.axes[i] = axis;
  }
}

template <class V>
void describe_limits(V& v, DeviceDraft& d) {
  v.groups_by_name(
      "joints", d.joint_names, "a joint of the URDF",
      [&](auto& child, int index) {
        const bool is_gantry = std::ranges::find(d.gantry, index) != d.gantry.end();
        describe(child, d.joints[index], is_gantry);
      },
      "limits; what is not given is taken from the URDF");
  d.device.model.posture = per_joint(d.manipulator_names.size(), kNoDefault);
  v.numbers_by_name(
      "posture", d.manipulator_names, "a manipulator joint", kJointPosition,
      [&](int index, double goal) { set_joint(d.device.model.posture, index, goal); },
      "where these joints should be, rad or m: the gantry moves so that they are, a seventh joint "
      "goes there, and the start is chosen near it");
  v.list(
      "virtual_joints",
      [&](auto& child) {
        describe(child, d.device.model.virtual_joints.emplace_back(), d.manipulator_names);
      },
      "limits of sums of joints, for example near a singularity; at most 2");
  v.list(
      "cartesian_limits",
      [&](auto& child) {
        describe(child, d.device.model.cartesian_limits.emplace_back(), d.frame_names);
      },
      "boxes in B, highest priority first; at most 2");
  v.rule(d.device.model.virtual_joints.size() <= kMaxVirtualJoints, "virtual_joints",
         "at most 2 are possible");
  v.rule(d.device.model.cartesian_limits.size() <= kMaxCartesianFrames, "cartesian_limits",
         "at most 2 are possible");
}

// ---- estimation and payload ----

template <class V>
void describe(V& v, Payload& payload) {
  v.number("mass_kg", payload.mass, kNotNegative, "mass");
  v.vector("centre_of_mass_m", payload.com, kAnyNumber, "in the sensor's frame S");
  v.inertia("inertia_kg_m2", payload.inertia,
            "about the centre of mass, axes of S: [ixx, iyy, izz] or [ixx, iyy, izz, ixy, ixz, "
            "iyz]");
}

template <class V>
void describe_wrench(V& v, estimation::WrenchConfig& wrench) {
  v.number("wrench_low_pass_Hz", wrench.low_pass_Hz, kNotNegative,
           "first-order low-pass of the user's wrench, 0 = none; 50 for a noisy sensor");
  v.flag("has_imu", wrench.has_imu,
         "whether accelerometer and gyroscope in the sensor take part: then the payload's inertia "
         "is compensated, otherwise its weight alone, and they are compared with the "
         "encoders (rules 116, 117): they must be within 1 cm of the sensor's origin");
  v.number("angular_low_pass_Hz", wrench.alpha_low_pass_Hz, kNotNegative,
           "first-order low-pass of the gyroscope's differences, 0 = none");
  v.flag("needs_tare", wrench.tare.is_needed,
         "no arming before the force/torque sensor has been tared, with the handle not held");
  v.number("noise_N", wrench.tare.noise_force, kPositive,
           "rms of a force of the sensor: what varies more is not tared");
  v.number("noise_Nm", wrench.tare.noise_torque, kPositive, "rms of a torque of the sensor");
}

template <class V>
void describe_inertial_units(V& v, DeviceDraft& d) {
  estimation::InertialUnitsConfig& units = d.device.estimation.units;
  v.names("inertial_units", units.frames, d.frame_names, "a link of the chain",
          "links that carry an inertial unit, from root to tip; how it sits there is learnt");
  v.rule(units.frames.size() <= kMaxInertialUnits, "inertial_units",
         "at most " + std::to_string(kMaxInertialUnits) + " are possible",
         std::to_string(units.frames.size()));
  v.rule(std::ranges::is_sorted(units.frames), "inertial_units",
         "must be in the order from root to tip");
  v.number("inertial_delay_s", units.delay, kNotNegative,
           "from motion to reading; rounded to periods, at least one");
  const double longest = (estimation::InertialUnitsState::kPast - 2) / d.device.model.rate_Hz;
  v.rule(units.delay <= longest, "inertial_delay_s",
         "must be at most " + std::to_string(estimation::InertialUnitsState::kPast - 2) +
             " periods, here " + model::to_text(longest) + " s",
         model::to_text(units.delay));
  v.flag("inertial_feed_back", units.feeds_back,
         "true: the control uses what the units say; false: it is only recorded");
  const bool has_units = !units.frames.empty();
  for (const char* key : {"inertial_delay_s", "inertial_feed_back"}) {
    v.rule(has_units || !v.is_given(key), key, "concerns inertial_units, and there are none");
  }
}

template <class V>
void describe_estimation(V& v, DeviceDraft& d) {
  const bool has_gantry = !d.has_joints || !d.gantry.empty();
  v.group(
      "estimation",
      [&](auto& child) {
        child.number("observer_pole_Hz", d.device.estimation.observer_pole_Hz, kPositive,
                     "Kalman filter of the gantry: large trusts the encoder, small the drive");
        child.rule(has_gantry || !child.is_given("observer_pole_Hz"), "observer_pole_Hz",
                   "concerns the gantry, and there is none");
        child.number("link_pole_Hz", d.device.estimation.link_pole_Hz, kPositive,
                     "observer of the link side of elastic joints");
        child.number("motor_low_pass_Hz", d.device.estimation.motor_low_pass_Hz, kNotNegative,
                     "first-order low-pass of the motor side's speed, 0 = none");
        describe_wrench(child, d.device.estimation.wrench);
        describe_inertial_units(child, d);
      },
      "from sensors to state");
  v.group(
      "payload", [&](auto& child) { describe(child, d.device.estimation.wrench.payload); },
      "what hangs beyond the force/torque sensor, handle included; 'hapticgiant identify payload' "
      "measures it");
}

// ---- drive, law, safety ----

template <class V>
void describe(V& v, safety::MonitorConfig& monitor) {
  v.number("force_max_N", monitor.force_max, kPositive, "force of the user");
  v.number("torque_max_Nm", monitor.torque_max, kPositive, "torque of the user");
  v.number("position_tolerance_rad", monitor.position_tolerance, kPositive,
           "beyond the limit of a revolute joint");
  v.number("position_tolerance_m", monitor.slide_tolerance, kPositive,
           "beyond the limit of a prismatic joint");
  v.number("cartesian_tolerance_m", monitor.cartesian_tolerance, kPositive,
           "outside a Cartesian limit");
  v.number("speed_tolerance", monitor.speed_tolerance, kFromOne, "times the largest speed");
  v.number("virtual_tolerance_rad", monitor.virtual_tolerance, kPositive,
           "beyond the limit of a virtual joint; m where its joints are prismatic");
  v.number("acceleration_tolerance", monitor.acceleration_tolerance, kFromOne,
           "times the largest acceleration of a joint, of its reference");
  v.number("torque_tolerance", monitor.torque_tolerance, kTolerance,
           "times the peak torque of a joint");
  v.number("unexplained_tolerance", monitor.unexplained_tolerance, kTolerance,
           "joint torque that motion and user's wrench do not explain, times its peak torque");
  v.number("motor_tolerance", monitor.motor_tolerance, kTolerance,
           "torque of a motor off its command and friction, times its peak torque");
  v.number("sync_tolerance_m", monitor.sync_tolerance, kPositive, "between handle and twin");
  v.number("tracking_tolerance_rad", monitor.tracking_tolerance, kPositive,
           "between reference and measured position of a revolute joint");
  v.number("tracking_tolerance_m", monitor.slide_tracking_tolerance, kPositive,
           "the same of a prismatic joint");
  v.number("plausibility_rad", monitor.plausibility, kPositive,
           "motor side minus twist of the spring minus link side of a joint; m where prismatic");
  v.number("gyroscope_tolerance_rad", monitor.gyroscope_tolerance, kPositive,
           "by how much the gyroscope may turn otherwise than the encoders within some seconds, "
           "besides 1.5 % of how far it turns and 0.3 % of its way there and back");
  v.number("accelerometer_tolerance_m_per_s", monitor.accelerometer_tolerance, kPositive,
           "by how much the handle may get faster than the encoders say, within half a second");
  v.number(
      "tilt_tolerance_rad", monitor.tilt_tolerance, kPositive,
      "largest angle between measured gravity and gravity by the posture when the device is armed");
  v.number("jump_factor", monitor.jump_factor, kFromOne,
           "times what the largest speed allows in a sample, of a measured position");
  v.number("frozen_samples", monitor.frozen_samples, kCount,
           "in a row with the same bits of wrench, inertial unit or a joint torque; 0: these "
           "sensors have no noise and are not checked");
  v.number("clock_tolerance", monitor.clock_tolerance, kTolerance,
           "mean error of the device's clock, periods per sample");
  v.number("temperature_max_C", monitor.temperature_max, kPositive, "of a motor");
  v.number("gantry_tolerance_m", monitor.gantry_tolerance, kPositive,
           "beyond the range of a prismatic axis of the gantry");
  v.number("gantry_tolerance_rad", monitor.turn_tolerance, kPositive,
           "beyond the range of a revolute axis of the gantry");
  v.number("gantry_deviation_m_per_s", monitor.gantry_deviation, kPositive,
           "speed of a prismatic axis of the gantry from what its drive should do");
  v.number("gantry_deviation_rad_per_s", monitor.turn_deviation, kPositive,
           "the same of a revolute axis");
  v.number("gantry_gap_m", monitor.gantry_gap, kPositive,
           "of a prismatic axis of the gantry from where its drive should have taken it; an error "
           "is forgotten within two seconds");
  v.number("gantry_gap_rad", monitor.turn_gap, kPositive, "the same of a revolute axis");
  v.number("gantry_drift_m", monitor.gantry_drift, kPositive,
           "the same of a prismatic axis, besides 0.5 % of its way, where an error is forgotten "
           "within a minute: encoders that drift, drives that creep");
  v.number("gantry_drift_rad", monitor.turn_drift, kPositive, "the same of a revolute axis");
  v.number("safe_speed_m_per_s", monitor.safe_speed, kPositive,
           "of handle and gantry while the handle is not held");
  v.number("overruns_in_a_row", monitor.overruns_in_a_row, kCount,
           "cycles that may be late one after the other");
  v.number("overruns_per_s", monitor.overruns_per_s, kNotNegative,
           "cycles that may be late again and again");
  v.number("stop_time_s", monitor.stop_time, kPositive,
           "that a controlled stop may take before the drives are switched off");
  v.number(
      "stop_distance_rad", monitor.stop_distance, kPositive,
      "that a revolute joint may move in a stop; the brakes close at 90 % of it; not given: 1.25 "
      "times what a stop from full speed needs");
  v.number("stop_distance_m", monitor.slide_stop_distance, kPositive,
           "the same of a prismatic joint");
  v.number("gantry_stop_distance_m", monitor.gantry_stop_distance, kPositive,
           "the same of a prismatic axis of the gantry");
  v.number("gantry_stop_distance_rad", monitor.turn_stop_distance, kPositive,
           "the same of a revolute axis of the gantry");
  v.number("braking_gap_rad", monitor.braking_gap, kPositive,
           "of a revolute joint in a stop from where its reference has led");
  v.number("braking_gap_m", monitor.slide_braking_gap, kPositive, "the same of a prismatic joint");
  v.number("braking_deviation_rad_per_s", monitor.braking_deviation, kPositive,
           "of its speed from that of its reference");
  v.number("braking_deviation_m_per_s", monitor.slide_braking_deviation, kPositive,
           "the same of a prismatic joint");
  v.number("brake_slip_rad", monitor.brake_slip, kPositive,
           "that a revolute joint or axis may move at rest with its brake closed, once the device "
           "had power; a machine without brakes needs a large one");
  v.number("brake_slip_m", monitor.slide_brake_slip, kPositive, "the same of a prismatic one");
}

template <class V>
void describe(V& v, safety::SanitiserConfig& sanitiser) {
  v.flag("strict", sanitiser.is_strict,
         "cut torques to 0 instead of to the torque that holds the joint");
  v.number("margin_rad", sanitiser.margin, kNotNegative, "beyond the limit of a revolute joint");
  v.number("margin_m", sanitiser.slide_margin, kNotNegative,
           "beyond the limit of a prismatic joint");
  v.number("torque_rise_s", sanitiser.torque_rise, kPositive, "from no torque to the peak torque");
}

template <class V>
void describe(V& v, StartTestConfig& test) {
  const std::vector<std::string> names(kSafetyInputNames.begin(), kSafetyInputNames.end());
  std::vector<int> inputs;
  if (v.names("inputs", inputs, names, "an input of the safety controller",
              "that this device has and a person operates in the test; without it all, but for the "
              "dead-man switch of a tool that has none")) {
    test.has_input.fill(false);
    for (const int input : inputs) test.has_input[input] = true;
  }
  v.number("valid_for_s", test.valid_for_s, kPositive, "how long the result of a test counts");
  v.number("brake_motion_rad", test.brake_motion, kPositive,
           "that a braked revolute joint or axis may move under its load");
  v.number("brake_motion_m", test.slide_brake_motion, kPositive, "the same of a prismatic one");
  v.number("posture_rad", test.posture, kPositive,
           "that a revolute joint or axis may stand elsewhere than the last run has left it");
  v.number("posture_m", test.slide_posture, kPositive, "the same of a prismatic one");
}

template <class V>
void describe(V& v, rendering::RenderingOptions& options, std::size_t manipulator_joints) {
  LawPreset law = LawPreset::kGauss;
  v.choice("law", law, kLawPresets,
           "preset of the law; paper and as_published need six joints, see docs/concepts/law.md");
  set_parts(options, law);
  v.choice("bounds", options.bounds, kBounds,
           "for experiments, instead of the preset's: how limits become bounds on accelerations");
  v.choice("gantry", options.gantry, kGantries,
           "for experiments, instead of the preset's: what moves the gantry");
  v.choice("braking", options.braking, kBrakings,
           "for experiments, instead of the preset's: whether motors brake before each limit "
           "separately or before all that are near together");
  v.number("T_C_s", options.T_C, kPositive,
           "bounds paper: time within which virtual joints and frames return, at least a period");
  v.number("solver_budget", options.solver_budget, kCount,
           "active sets after which the solver of a cycle ends with what it has, all limits of the "
           "device kept; 0: it continues until its result is proven");
  v.rule(options.solver_budget == std::floor(options.solver_budget), "solver_budget",
         "must be a whole number", model::to_text(options.solver_budget));
  v.number("kP_posture_1_per_s2", options.kP_posture, kNotNegative,
           "of a seventh joint, towards its goal");
  v.number("kD_posture_1_per_s", options.kD_posture, kNotNegative, "of a seventh joint, damping");
  v.rule(options.law != rendering::Law::kPaper || manipulator_joints <= 6, "law",
         "the law of the paper needs six manipulator joints: use gauss");
}

template <class V>
void describe_prepositioning(V& v, DeviceDraft& d) {
  // values not given stay within the drive's limits
  d.device.prepositioning.dq_max =
      std::min(d.device.prepositioning.dq_max, d.device.model.drive.dq_max);
  d.device.prepositioning.ddq_max =
      std::min(d.device.prepositioning.ddq_max, d.device.model.drive.ddq_max);
  v.group(
      "prepositioning",
      [&](auto& child) {
        child.number("k_ppu_1_per_s", d.device.prepositioning.k_ppu, kPositive, "gain, eq. (27)");
        child.joint_number(kSpeed, d.gantry_unit, d.device.prepositioning.dq_max, kPositive,
                           "largest speed used, never above that of the drive");
        child.joint_number(
            kBrake, d.gantry_unit, d.device.prepositioning.ddq_max, kPositive,
            "deceleration that can be relied on, never above the drive's acceleration");
        child.rule(d.device.prepositioning.dq_max <= d.device.model.drive.dq_max,
                   kSpeed.of(d.gantry_unit),
                   "must not exceed the speed of the drive, " +
                       model::to_text(d.device.model.drive.dq_max),
                   model::to_text(d.device.prepositioning.dq_max));
        child.rule(d.device.prepositioning.ddq_max <= d.device.model.drive.ddq_max,
                   kBrake.of(d.gantry_unit),
                   "must not exceed the acceleration of the drive, " +
                       model::to_text(d.device.model.drive.ddq_max),
                   model::to_text(d.device.prepositioning.ddq_max));
      },
      "how the gantry moves along with the hand");
}

template <class V>
void describe(V& v, LinkCapsule& capsule, const std::vector<std::string>& links) {
  v.words("name", capsule.name, "shown where it is the nearest to another shape", Need::kRequired);
  v.name("link", capsule.link, links, "a link of the URDF",
         "it moves with this link; the URDF's shapes of what is fixed to it do not count then",
         Need::kRequired);
  v.vector("from_m", capsule.from, kAnyNumber, "one end of its segment, in the link");
  v.vector("to_m", capsule.to, kAnyNumber, "the other end");
  v.number("radius_m", capsule.radius, kPositive, "around the segment", Need::kRequired);
}

template <class V>
void describe(V& v, UnwatchedPair& pair, const DeviceDraft& d) {
  std::vector<std::string> capsules;
  for (const LinkCapsule& capsule : d.capsules) capsules.push_back(capsule.name);
  v.names("links", pair.links, d.link_names, "a link of the URDF",
          "two links, each with all that is fixed to it");
  v.names("capsules", pair.capsules, capsules, "the name of a capsule", "or two capsules");
  v.rule(v.is_given("links") != v.is_given("capsules"), "", "needs either links or capsules");
  for (const auto& [key, names] : {std::pair("links", &pair.links), {"capsules", &pair.capsules}}) {
    v.rule(names->size() == 2 || !v.is_given(key), key, "must be two",
           std::to_string(names->size()));
  }
}

template <class V>
void describe_collision(V& v, DeviceDraft& d) {
  v.flag("is_watched", d.watches_collisions,
         "stop before the device hits itself, its frame or the floor");
  v.number("safe_distance_m", d.device.collision.safe_distance, kPositive,
           "between any two parts while the device brakes");
  v.list(
      "capsules", [&](auto& child) { describe(child, d.capsules.emplace_back(), d.link_names); },
      "shapes in place of meshes: 'hapticgiant new device' fits them");
  v.list(
      "unwatched", [&](auto& child) { describe(child, d.unwatched.emplace_back(), d); },
      "pairs that are not watched, because they never touch, or leave no room to move");
}

template <class V>
void describe_behaviour(V& v, DeviceDraft& d) {
  for (const char* key : {"drive", "prepositioning"}) {
    v.rule(!d.has_joints || !d.gantry.empty() || !v.is_given(key), key,
           "concerns the gantry, and there is none");
  }
  v.group(
      "drive",
      [&](auto& child) {
        child.number("dead_time_s", d.device.model.drive.dead_time, kNotNegative,
                     "until a command has effect");
        child.number("lag_s", d.device.model.drive.lag, kPositive, "time constant of the speed");
        child.joint_number(kSpeed, d.gantry_unit, d.device.model.drive.dq_max, kPositive,
                           "largest speed");
        child.joint_number(kAcceleration, d.gantry_unit, d.device.model.drive.ddq_max, kPositive,
                           "largest acceleration");
        child.rule(std::lround(d.device.model.drive.dead_time * d.device.model.rate_Hz) <=
                       CommandDelay::kMaxPeriods,
                   "dead_time_s", "must be shorter than 256 cycles",
                   model::to_text(d.device.model.drive.dead_time));
      },
      "how the gantry follows its velocity command");
  v.group(
      "synchronisation",
      [&](auto& child) {
        child.number("kP_tran_1_per_s2", d.device.rendering.kP_tran, kPositive, "position");
        child.number("kD_tran_1_per_s", d.device.rendering.kD_tran, kPositive, "velocity");
        child.number("kP_rot_1_per_s2", d.device.rendering.kP_rot, kPositive, "orientation");
        child.number("kD_rot_1_per_s", d.device.rendering.kD_rot, kPositive, "angular velocity");
      },
      "gains that pull the handle onto the twin, eq. (11)");
  v.group(
      "rendering", [&](auto& child) { describe(child, d.device.rendering, d.manipulator.size()); },
      "the law, see docs/concepts/law.md");
  describe_prepositioning(v, d);
  describe_estimation(v, d);
  v.group(
      "passivity",
      [&](auto& child) {
        child.choice("reaction", d.device.passivity.reaction, kPassivityReactions,
                     "to hand and device shaking each other: nothing, a warning, or "
                     "more inertia and damping of the twin until the shaking ends");
        child.number("damping_Ns_per_m", d.device.passivity.damping, kPositive,
                     "of the handle while shaking is damped, besides that of the twin");
        child.number("least_mass_kg", d.device.passivity.least_mass, kPositive,
                     "that is felt at the handle while shaking is damped");
      },
      "energy and oscillation at the handle, docs/concepts/passivity.md");
  v.group(
      "compliance",
      [&](auto& child) {
        child.flag("is_on", d.device.compliance.is_on,
                   "arm and gantry give way to what touches the arm, before the device stops; only "
                   "with torque sensors in the joints");
      },
      "contact anywhere along the arm, docs/concepts/compliance.md");
  v.group(
      "collision", [&](auto& child) { describe_collision(child, d); },
      "self-collision, from the collision elements of the URDF and the capsules given here; "
      "docs/concepts/collision.md");
  for (double* distance :
       {&d.device.monitor.stop_distance, &d.device.monitor.slide_stop_distance,
        &d.device.monitor.gantry_stop_distance, &d.device.monitor.turn_stop_distance}) {
    *distance = kNoDefault;  // from the ratings
  }
  v.group(
      "monitor", [&](auto& child) { describe(child, d.device.monitor); },
      "when the device is stopped by a fault, docs/concepts/safety.md");
  v.group(
      "sanitiser", [&](auto& child) { describe(child, d.device.sanitiser); },
      "what is taken out of commands near and beyond limits, docs/concepts/safety.md");
  v.group(
      "start_test", [&](auto& child) { describe(child, d.device.start_test); },
      "brakes and stop inputs before the first run of a day, docs/reference/start_test.md");
}

// ---- joints with series elastic actuators and their control ----

inline constexpr std::array<Choice<tracking::Method>, 2> kMethods = {
    {{"modal", tracking::Method::kModal}, {"motor_pd", tracking::Method::kMotorPd}}};

template <class V>
void describe(V& v, ActuatorModel& actuator) {
  constexpr auto kNeeded = Need::kRequired;
  v.number("rotor_inertia_kg_m2", actuator.rotor_inertia, kPositive,
           "of motor and gear at the output: motor inertia times ratio squared", kNeeded);
  v.number("stiffness_Nm_per_rad", actuator.stiffness, kPositive, "of gear and torque sensor",
           kNeeded);
  v.number("damping_Nms_per_rad", actuator.damping, kNotNegative, "in parallel with the stiffness");
  v.number("coulomb_friction_Nm", actuator.coulomb_friction, kNotNegative, "of motor and gear");
  v.number("viscous_friction_Nms_per_rad", actuator.viscous_friction, kNotNegative,
           "of motor and gear");
  v.number("load_friction", actuator.load_friction, kShare,
           "further Coulomb friction per torque of the joint");
  v.number("stiction", actuator.stiction, kFromOne, "break-away torque over Coulomb friction");
  v.number("stribeck_rad_per_s", actuator.stribeck_speed, kPositive,
           "speed at which stiction has mostly gone");
  v.number("presliding_rad", actuator.presliding, {.lb = 0.0, .ub = 0.01},
           "way until dry friction slips, as its feedforward has it; 0 = at once, its sign changes "
           "over friction_speed_rad_per_s");
  v.number("presliding_elements", actuator.presliding_elements,
           {.lb = 1.0, .ub = static_cast<double>(kSlipElements)},
           "equal elements in which it begins to slip, one after the other");
  v.rule(actuator.presliding_elements == std::floor(actuator.presliding_elements),
         "presliding_elements", "must be a whole number",
         model::to_text(actuator.presliding_elements));
  v.number("torque_max_Nm", actuator.torque_max, kPositive, "peak torque", kNeeded);
  v.number("torque_rated_Nm", actuator.torque_rated, kPositive, "that it gives for ever", kNeeded);
  v.number("full_torque_to_rad_per_s", actuator.speed_full_torque, kPositive,
           "speed up to which there is peak torque", kNeeded);
  v.number("no_load_rad_per_s", actuator.speed_no_load, kPositive,
           "speed at which no torque is left", kNeeded);
  v.rule(actuator.speed_no_load > actuator.speed_full_torque, "no_load_rad_per_s",
         "must be above full_torque_to_rad_per_s", model::to_text(actuator.speed_no_load));
  v.rule(actuator.torque_rated <= actuator.torque_max, "torque_rated_Nm",
         "must not be above torque_max_Nm", model::to_text(actuator.torque_rated));
}

template <class V>
void describe(V& v, tracking::ControlConfig& config) {
  v.choice("method", config.method, kMethods,
           "modal: all states of the arm in its modes; motor_pd: each motor for itself");
  v.number("latency_s", config.loop.latency, {.lb = 0.0, .ub = 0.64},
           "expected from a sample to the torque at the drive; the true one is measured");
  v.number("current_lag_s", config.loop.current_lag, kNotNegative, "time constant of the current");
  v.number("integral_1_per_s", config.integral_rate, kNotNegative,
           "modal: rate at which a remaining error goes");
  v.number("flatness_Hz", config.flatness_Hz, kPositive,
           "low-pass of the derivatives of the torques fed forward");
  v.number("wrench_lead_s", config.wrench_lead, {.lb = 0.0, .ub = 0.01},
           "modal: by which the user's wrench is fed forward early, for what sensor, filter and "
           "springs cost");
  v.number("lead_low_pass_Hz", config.lead_low_pass_Hz, {.lb = 1.0, .ub = 200.0},
           "modal: low-pass of the wrench's rate of change, which wrench_lead_s takes");
  v.number("stiff_low_pass_Hz", config.stiff_low_pass_Hz, kNotNegative,
           "modal: low-pass of what is fed forward to stiff modes, 0 = none");
  v.number("rotor_pole_rad_per_s", config.poles.w0, {.lb = 1.0, .ub = 250.0},
           "modal: natural frequency of the shaped rotor on its spring");
  v.number("link_pole_rad_per_s", config.poles.w1, kPositive,
           "modal: natural frequency with which the links follow");
  v.number("link_damping", config.poles.z1, {.lb = 0.1, .ub = 2.0}, "modal: damping ratio of that");
  v.number("spring_damping", config.poles.z2, {.lb = 0.01, .ub = 1.0},
           "modal: damping ratio of each mode's fast oscillation");
  v.number("motor_pole_rad_per_s", config.poles.w_motor, kPositive,
           "modal: double pole of modes that are controlled from the motor side alone");
  v.number("error_max_rad", config.error_max, kPositive,
           "the reference is never further ahead of the joint: a joint that is held back takes "
           "reference and twin with it");
  v.number("friction_share", config.friction_share, {.lb = 0.0, .ub = 2.0},
           "of the Coulomb friction that is fed forward");
  v.number("friction_speed_rad_per_s", config.friction_speed, kPositive,
           "speed over which it changes its sign");
  v.number("friction_learning_1_per_s", config.friction_learning, kNotNegative,
           "modal: rate at which the true friction is learnt, 0 = never");
}

template <class V>
void describe_control(V& v, DeviceDraft& d) {
  v.groups_by_name(
      "actuators", d.joint_names, "a joint of the URDF",
      [&](auto& child, int index) { describe(child, d.joints[index].actuator.emplace()); },
      "series elastic joints, for all or none of the manipulator; without them the drives follow "
      "a reference of positions");
  v.rule(v.is_given("actuators") || !v.is_given("control"), "control",
         "concerns 'actuators', and there are none");
  if (v.is_given("actuators")) {
    d.device.control.method = tracking::Method::kModal;
    d.device.control.error_max = 0.007;  // [C] 6: 5 to 10 mrad
  }
  v.group(
      "control",
      [&](auto& child) {
        describe(child, d.device.control);
        const double longest = tracking::kMostLatency / d.device.model.rate_Hz;
        child.rule(d.device.control.loop.latency <= longest, "latency_s",
                   "must be at most 64 periods, " + model::to_text(longest) + " s at this rate_Hz",
                   model::to_text(d.device.control.loop.latency));
        const double most = tracking::largest_flatness_Hz(d.device.model.rate_Hz);
        child.rule(d.device.control.flatness_Hz < most, "flatness_Hz",
                   "must be below " + model::to_text(std::floor(10.0 * most) / 10.0) +
                       ", or the torques fed forward oscillate at this rate_Hz",
                   model::to_text(d.device.control.flatness_Hz));
      },
      "how motor torques make the joints follow the reference");
}

}  // namespace hg::config
