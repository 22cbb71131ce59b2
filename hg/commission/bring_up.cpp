#include "hg/commission/bring_up.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "hg/commission/posture.h"
#include "hg/controller/safety/collision/nearest.h"

namespace hg::commission {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;                            // m/s^2
constexpr double kGravityRange = 0.5;                        // m/s^2, of the accelerometer at rest
constexpr double kGravityAngle = 0.052;                      // rad: 3 degrees
constexpr double kWay = 0.08, kSlideWay = 0.02;              // rad, m: one stroke
constexpr double kLeastWay = 0.018, kLeastSlideWay = 0.004;  // shorter ones show nothing
constexpr double kPeak = 1.875;        // of a minimum-jerk motion, times its mean speed
constexpr double kSpeedShare = 0.5;    // of the largest speed of a joint
constexpr double kMarginShare = 0.25;  // of a stroke, kept from the end of a range
constexpr double kAboveFloor = 0.02;   // m, of the handle
constexpr double kTouch = 1e-3;        // m, closer than this counts
constexpr double kStill = 0.002, kSlideStill = 5e-4;  // rad, m: at rest
constexpr double kApart = 0.05;                       // rad between motor and link encoder at rest
constexpr double kCounts = 3.0;        // Nm of weight from which a torque sensor is looked at
constexpr double kTorqueRatio = 0.25;  // of the weight, and as much in Nm as it counts from
constexpr double kForce = 6.0, kTorque = 1.0;  // N, Nm without a hand
constexpr double kPull = 10.0;                 // N that count as a pull
constexpr double kPullAngle = 0.6;             // rad between a pull and what is measured
constexpr double kPullFits = 0.35;             // rad by which a person pulls elsewhere
constexpr double kPullTime = 0.5;              // s for which it lasts
constexpr double kWait = 60.0;                 // s for a person
constexpr double kSees = 0.004;                // m that a person sees
constexpr double kLooks = 0.2;                 // s between two looks at a person's answer

// Runs one step after the other and keeps their outcomes.
class Steps {
 public:
  Steps(Rig& rig, const Options& options)
      : rig_(rig),
        options_(options),
        model_(rig.config().model),
        chain_(model_.chain),
        shapes_(rig.config().collision.shapes, rig.config().collision.pairs.watched) {}

  std::vector<Item> run() {
    step("samples", [&] { return samples(); });
    step("at rest", [&] { return at_rest(); });
    step("positions", [&] { return positions(); });
    if (has_imu()) step("gravity", [&] { return gravity(); });
    if (has_torques()) step("torque sensors", [&] { return torque_sensors(); });
    step("handle at rest", [&] { return handle_at_rest(); });
    step("pulls", [&] { return pulls(); });
    step("drives", [&] { return drives(); });
    const int n = model_.n_p + model_.n_m;
    for (int i = n - 1; i >= model_.n_p; --i) step(name_of(model_, i), [&] { return stroke(i); });
    for (int i = model_.n_p - 1; i >= 0; --i) step(name_of(model_, i), [&] { return stroke(i); });
    step("brakes", [&] { return brakes(); });
    step("drives again", [&] { return drives_again(); });
    if (options_.falls_silent) step("silence", [&] { return silence(); });
    step("not seen", [&] { return not_seen(); });
    switch_off();
    return std::move(items_);
  }

 private:
  bool has_imu() const { return rig_.config().estimation.wrench.has_imu; }
  bool has_torques() const { return rig_.config().control.method != tracking::Method::kDrives; }
  bool is_slide(int joint) const { return model_.chain.joints()[joint].is_slide(); }
  void say(const std::string& words) { rig_.crew().say(rig_.sensors().time_s, words); }

  // `test` says what is wrong, empty = nothing, and leaves what it measured in found_.
  void step(const std::string& name, const std::function<std::string()>& test) {
    Item item = {.name = name, .found = {}};
    if (!is_failed_) {
      found_.clear();
      try {
        const std::string problem = test();
        item.outcome = problem.empty() ? Outcome::kPassed : Outcome::kFailed;
        item.found = problem.empty() ? found_ : problem;
      } catch (const Ended& end) {
        item.outcome = Outcome::kFailed;
        item.found = end.why;
      }
      is_failed_ = item.outcome == Outcome::kFailed;
      if (is_failed_) switch_off();
      if (is_left_out_) item.outcome = Outcome::kUntested;
      is_left_out_ = false;
      say(fmt::format("{:18} {}{}", name, is_failed_ ? "FAILED: " : "", item.found));
    }
    items_.push_back(std::move(item));
  }

  // The rig has switched them off itself where it ends.
  void switch_off() {
    try {
      if (rig_.is_on()) rig_.power_off();
    } catch (const Ended&) {
      return;
    }
  }

  void place(const VectorPM& q) { chain_.update(q, Eigen::VectorXd::Zero(q.size())); }
  void place_chain() { place(rig_.positions()); }

  std::string samples() {
    constexpr double kSlow = 0.02;     // of the period
    constexpr double kMissing = 0.01;  // of the samples
    std::uint64_t first = 0, last = 0, missing = 0, errors = 0;
    double begin = 0.0, end = 0.0;
    const auto filled_in = [&] { return options_.filled_in ? options_.filled_in() : 0; };
    const std::uint64_t before = filled_in();
    rig_.rest(2.0, [&](const SensorFrame& sensors, const RobotState&) {
      if (first == 0) {
        first = sensors.sequence;
        begin = sensors.time_s;
      } else {
        missing += sensors.sequence - last - 1;
      }
      last = sensors.sequence;
      end = sensors.time_s;
      errors += sensors.bus_errors;
    });
    const double period = (end - begin) / static_cast<double>(last - first);
    const std::uint64_t held = filled_in() - before;
    found_ = fmt::format("one every {:.3f} ms, {} missing, {} filled in, {} bus errors",
                         1e3 * period, missing, held, errors);
    if (static_cast<double>(missing + held + errors) >
        kMissing * static_cast<double>(last - first)) {
      return found_ + ": cable, network or bus, or a computer that is too busy";
    }
    if (std::abs(period / rig_.dt() - 1.0) < kSlow) return "";
    return fmt::format("one every {:.3f} ms by the device's clock, expected {:.3f} (rate_Hz)",
                       1e3 * period, 1e3 * rig_.dt());
  }

  // Encoders stand, speeds are zero, both encoders of a joint agree.
  std::string at_rest() {
    const VectorPM from = rig_.positions();
    VectorPM most = VectorPM::Zero(from.size());
    VectorM speed = VectorM::Zero(model_.n_m);
    constexpr double kFor = 1.0;  // s
    rig_.rest(kFor, [&](const SensorFrame& sensors, const RobotState&) {
      most = most.cwiseMax((rig_.positions() - from).cwiseAbs());
      speed += rig_.dt() / kFor * sensors.dq_m;
    });
    for (int i = 0; i < most.size(); ++i) {
      if (most[i] > (is_slide(i) ? kSlideStill : kStill)) {
        return fmt::format("{} moves with its brake closed, by {:.2f} {}", name_of(model_, i),
                           1e3 * most[i], is_slide(i) ? "mm" : "mrad");
      }
    }
    for (int i = 0; i < model_.n_m; ++i) {
      const std::string& name = model_.manipulator_joint(i);
      if (std::abs(speed[i]) > 10.0 * kStill) {
        return fmt::format("{} stands, and its speed says {:.3f} per second", name, speed[i]);
      }
      const RobotState& robot = rig_.robot();
      if (robot.theta_m.size() <= i) continue;
      const double apart = robot.theta_m[i] - robot.q_m[i];
      if (std::abs(apart) > kApart) {
        return fmt::format(
            "{}: motor and link encoder are {:.3f} rad apart: zero position, sign or "
            "gear ratio of one of them",
            name, apart);
      }
    }
    found_ = "all joints stand";
    return "";
  }

  std::string positions() {
    const VectorM& q = rig_.robot().q_m;
    const auto is_in_range = [&](int joint, double at) {
      const limits::JointLimits& range = model_.joint_limits[joint];
      return at >= range.q_min && at <= range.q_max;
    };
    for (int i = 0; i < model_.n_m; ++i) {
      if (is_in_range(i, q[i])) continue;
      std::string swapped;
      for (int k = 0; k < model_.n_m; ++k) {
        if (k == i || !is_in_range(i, q[k]) || !is_in_range(k, q[i])) continue;
        swapped +=
            (swapped.empty() ? ", or it is swapped with " : " or ") + model_.manipulator_joint(k);
      }
      return fmt::format(
          "{} is at {:.3f}, outside of its range {:.3f} .. {:.3f}: its zero "
          "position or sign{}; or it stands there",
          model_.manipulator_joint(i), q[i], model_.joint_limits[i].q_min,
          model_.joint_limits[i].q_max, swapped);
    }
    found_ = "within their ranges";
    return "";
  }

  // The accelerometer at rest against the posture.
  std::string gravity() {
    const Vector3d a_S = measure_at_rest();
    if (std::abs(a_S.norm() - kGravity) > kGravityRange) {
      return fmt::format("the accelerometer reads {:.2f} m/s^2 at rest, expected {:.2f}: its unit",
                         a_S.norm(), kGravity);
    }
    at_rest_.directions = {{.in_B = Vector3d::UnitZ(), .in_S = a_S, .within = kGravityAngle}};
    const double angle = kGravityAngle * misfit(at_rest_, model_, chain_);
    found_ = fmt::format("{:.2f} m/s^2, {:.1f} degrees from where the posture has it", a_S.norm(),
                         angle * 180.0 / M_PI);
    if (angle <= kGravityAngle) return "";
    if (M_PI - angle < kGravityAngle) {
      return "the accelerometer reads gravity upside down: its sign, or its axes";
    }
    return found_ + in_words(explain(at_rest_, model_, chain_),
                             "several joints, or the axes of the accelerometer");
  }

  static std::string in_words(const std::string& causes, const std::string& otherwise) {
    return causes.empty() ? ": " + otherwise : "; it would fit if " + causes;
  }

  // At rest they carry the weight of the links beyond them.
  std::string torque_sensors() {
    measure_at_rest();
    int counted = 0;
    const int wrong = wrong_torque(at_rest_, model_, chain_, counted);
    found_ = fmt::format("{} of {} joints carry weight, as they should", counted, model_.n_m);
    if (wrong < 0) return "";
    chain_.update(at_rest_.q, Eigen::VectorXd::Zero(at_rest_.q.size()));
    return fmt::format(
        "{} carries {:.1f} Nm of weight, and its sensor reads {:.1f}: sign, unit or zero of the "
        "sensor, or the masses in the URDF",
        model_.manipulator_joint(wrong), chain_.gravity()[model_.n_p + wrong], at_rest_.tau[wrong]);
  }

  // Posture and torques; returns the accelerometer.
  Vector3d measure_at_rest() {
    constexpr double kFor = 1.0;  // s
    Vector3d a_S = Vector3d::Zero();
    at_rest_.tau = VectorM::Zero(has_torques() ? model_.n_m : 0);
    rig_.rest(kFor, [&](const SensorFrame& sensors, const RobotState&) {
      a_S += rig_.dt() / kFor * sensors.a_S;
      if (has_torques()) at_rest_.tau += rig_.dt() / kFor * sensors.tau_m;
    });
    at_rest_.q = rig_.positions();
    return a_S;
  }

  std::string drives() {
    say("-> keep clear, hand at the emergency stop; hold the enabling switch, if there is one, and "
        "HOLD THE KEY: the drives come on and hold");
    return switch_on();
  }

  // Waits for key and enabling switch; leaves how far joints moved in found_.
  std::string switch_on() {
    wait_for(
        [&] {
          const SafetyInputs& safety = rig_.sensors().safety;
          return rig_.crew().holds_key() && safety.operator_enable && !safety.emergency_stop;
        },
        rig_.sensors().safety.operator_enable ? "the key was not held"
                                              : "the enabling switch was not held");
    VectorPM moved;
    if (!rig_.power_on(moved)) return problem_of_hold(moved, model_);
    found_ = fmt::format("on, all joints hold, moved by {:.1f} mrad or mm at most",
                         1e3 * moved.cwiseAbs().maxCoeff());
    return "";
  }

  // The way of a stroke: the longest of some that keep to the ranges, the speed of the joint, the
  // Cartesian limits, the floor and what is close, first towards the middle; 0: none does.
  double way_of(int joint) {
    const VectorPM q = rig_.positions();
    Interval range;
    double length = is_slide(joint) ? kSlideWay : kWay;
    if (joint < model_.n_p) {
      range = model_.gantry_range[joint];
    } else {
      const limits::JointLimits& limits = model_.joint_limits[joint - model_.n_p];
      range = {limits.q_min, limits.q_max};
      length = std::min(length, kSpeedShare * limits.dq_max * Rig::kDuration / kPeak);
    }
    const double margin = kMarginShare * length;
    const double towards = range.ub - q[joint] >= q[joint] - range.lb ? 1.0 : -1.0;
    for (const double share : {1.0, 0.5, 0.25}) {
      for (const double side : {towards, -towards}) {
        const double way = side * share * length;
        const double end = q[joint] + way + side * margin;
        if (end >= range.lb && end <= range.ub && is_free(q, joint, way)) return way;
      }
    }
    return 0.0;
  }

  // Whether a way comes no closer to anything than it may, or than where it begins.
  bool is_free(const VectorPM& q, int joint, double way) {
    constexpr double kSteps = 4.0;
    place(q);
    const double from = shapes_.distance(chain_), z_from = chain_.pose(model_.handle).p.z();
    const std::vector<double> beyond_from = beyond_limits();
    const double allowed = std::min(from, rig_.config().collision.safe_distance);
    for (double step = 1.0; step <= kSteps; ++step) {
      VectorPM there = q;
      there[joint] += way * step / kSteps;
      place(there);
      if (shapes_.distance(chain_) < allowed - kTouch) return false;
      const double z = chain_.pose(model_.handle).p.z();
      if (z < std::min(z_from, rig_.config().floor_z + kAboveFloor)) return false;
      const std::vector<double> beyond = beyond_limits();
      for (std::size_t i = 0; i < beyond.size(); ++i) {
        if (beyond[i] > std::max(0.0, beyond_from[i]) + kTouch) return false;
      }
    }
    return true;
  }

  // How far each frame with Cartesian limits is beyond them, m; negative inside.
  std::vector<double> beyond_limits() const {
    std::vector<double> beyond;
    for (const CartesianLimit& limit : model_.cartesian_limits) {
      const Vector3d& p = chain_.pose(limit.frame).p;
      for (int axis = 0; axis < 3; ++axis) {
        beyond.push_back(
            std::max(limit.axes[axis].q_min - p[axis], p[axis] - limit.axes[axis].q_max));
      }
    }
    return beyond;
  }

  std::string stroke(int joint) {
    const double way = way_of(joint);
    if (std::abs(way) < (is_slide(joint) ? kLeastSlideWay : kLeastWay)) {
      is_left_out_ = true;
      found_ =
          "not led: no way is free of its range, the Cartesian limits, the floor or other parts";
      return "";
    }
    place_chain();
    const model::ChainData before = chain_;
    const Vector6 J = before.jacobian(model_.handle).col(joint);
    const Vector3d p = way * J.head<3>(), turn = way * J.tail<3>();
    const std::string seen = words_of(p, turn);
    say(fmt::format("-> {}: the handle should {}; hold the key", name_of(model_, joint), seen));
    const bool sees_turn = has_imu() && !is_slide(joint);
    if (!sees_turn) ask({.words = {}, .way = p, .turn = turn});  // from here on it is looked at
    const Stroke there = rig_.lead(joint, way);
    if (std::string problem = problem_of(there, model_, before); !problem.empty()) return problem;
    if (!sees_turn) {
      ask({.words = fmt::format("did the handle {}?", seen), .way = p, .turn = turn});
      if (!wait_for_answer()) {
        return fmt::format(
            "{} does not move as the model says: the sign of command and encoder "
            "together, swapped joints, or its axis in the URDF",
            name_of(model_, joint));
      }
    }
    say("-> and back; hold the key");
    const Stroke back = rig_.lead(joint, -way);
    place_chain();
    if (std::string problem = problem_of(back, model_, chain_); !problem.empty()) return problem;
    found_ = fmt::format("led by {:.0f} {} and back", 1e3 * way, is_slide(joint) ? "mm" : "mrad");
    if (!has_torques() || joint < model_.n_p) {
      found_ += fmt::format(", {:.0f} ms late", 1e3 * std::max(0.0, there.late));
      return "";
    }
    // load, speed and stiction are in it, so that it is said and not judged
    found_ += fmt::format(", friction {:.1f} Nm (file: {:.1f})", friction_of(there, back),
                          model_.actuators[joint - model_.n_p].coulomb_friction);
    return "";
  }

  static std::string words_of(const Vector3d& p, const Vector3d& turn) {
    if (p.norm() < kSees) {
      return fmt::format("turn by {:.0f} degrees about ({:.1f}, {:.1f}, {:.1f}) of the base frame",
                         turn.norm() * 180.0 / M_PI, turn.x() / turn.norm(), turn.y() / turn.norm(),
                         turn.z() / turn.norm());
    }
    Eigen::Index axis = 0;
    p.cwiseAbs().maxCoeff(&axis);
    return fmt::format("move by {:.0f} mm, mostly towards {}{}", 1e3 * p.norm(),
                       p[axis] > 0.0 ? "+" : "-", "xyz"[axis]);
  }

  std::string brakes() {
    constexpr double kFor = 2.0;  // s
    const VectorPM from = rig_.positions();
    rig_.power_off();
    rig_.rest(kFor);
    const VectorPM moved = (rig_.positions() - from).cwiseAbs();
    const StartTestConfig& bounds = rig_.config().start_test;
    for (int i = 0; i < moved.size(); ++i) {
      const double allowed = is_slide(i) ? bounds.slide_brake_motion : bounds.brake_motion;
      if (moved[i] <= allowed) continue;
      return fmt::format("{} gives way by {:.1f} {} when the drives go off: its brake",
                         name_of(model_, i), 1e3 * moved[i], is_slide(i) ? "mm" : "mrad");
    }
    found_ = fmt::format("hold, {:.1f} mrad or mm at most", 1e3 * moved.maxCoeff());
    return "";
  }

  std::string drives_again() {
    say("-> the drives come on again; HOLD THE KEY");
    if (std::string problem = switch_on(); !problem.empty()) return problem;
    if (!options_.falls_silent) rig_.power_off();
    return "";
  }

  std::string silence() {
    constexpr double kLongest = 0.2;  // s
    say("-> keep clear: no command is sent for 0.2 s, and the driver has to switch the drives off");
    const FaultCode fault = rig_.fall_silent(kLongest);
    if (fault == FaultCode::kNone) {
      return fmt::format(
          "without any command for {:.1f} s it still sends samples, or a joint left its place: its "
          "driver must switch the drives off and say so",
          kLongest);
    }
    if (fault == FaultCode::kDeviceSilent) {
      return "without commands it fell silent itself, and may have its drives on; its "
             "driver must say goodbye";
    }
    // a watchdog has switched the drives off, whether or not the session ended with them
    const bool is_off = fault == FaultCode::kCommandsLost;
    found_ = fmt::format("it {}: {}", is_off ? "switched the drives off" : "ended the session",
                         to_string(fault));
    return "";
  }

  // No failure: what a person has to look at otherwise.
  std::string not_seen() {
    const std::string names = unseen_zeros(rig_.positions(), model_, chain_);
    found_ = names.empty() ? "nothing"
                           : "the zero positions of " + names +
                                 ", which neither gravity nor another joint shows: compare them "
                                 "with the marks of the machine";
    return "";
  }

  std::string handle_at_rest() {
    say("-> keep off the handle");
    Vector6 mean = Vector6::Zero();
    constexpr double kFor = 1.0;  // s
    rig_.rest(kFor);
    rig_.rest(kFor, [&](const SensorFrame&, const RobotState& robot) {
      mean += rig_.dt() / kFor * robot.w_H;
    });
    const double force = mean.head<3>().norm(), torque = mean.tail<3>().norm();
    found_ = fmt::format("{:.1f} N, {:.2f} Nm without a hand", force, torque);
    without_hand_ = mean;
    if (force <= kForce && torque <= kTorque) return "";
    return found_ +
           ": mass or centre of the payload (identify payload), or sign, unit or zero of the "
           "force/torque sensor";
  }

  // Pulls along the axes of B show how the sensor stands in it.
  std::string pulls() {
    found_.clear();
    std::vector<Direction> directions = at_rest_.directions;
    bool is_wrong = false;
    for (int axis = 2; axis >= 0; --axis) {
      const Vector3d direction = Vector3d::Unit(axis), force = pull(direction);
      place_chain();
      const Eigen::Matrix3d R_B_S = chain_.pose(model_.handle).R * model_.T_H_S.R;
      directions.push_back({direction, R_B_S.transpose() * force, kPullFits});
      is_wrong = is_wrong || angle_between(force, direction) > kPullAngle;
      found_ += fmt::format("{}{} as ({:.0f}, {:.0f}, {:.0f}) N", found_.empty() ? "" : ", ",
                            "xyz"[axis], force.x(), force.y(), force.z());
    }
    if (!is_wrong) return "";
    at_rest_.q = rig_.positions();
    at_rest_.directions = std::move(directions);
    return found_ + in_words(explain(at_rest_, model_, chain_),
                             "sign, order or pose of the force/torque sensor");
  }

  // Mean force of a pull, in B, N.
  Vector3d pull(const Vector3d& direction) {
    Eigen::Index axis = 0;
    direction.maxCoeff(&axis);
    say(fmt::format("-> pull at the handle towards +{} of the base frame{}, with about 20 N",
                    "xyz"[axis], axis == 2 ? ", up" : ""));
    rig_.crew().pull(direction);
    Vector3d sum = Vector3d::Zero();
    double lasted = 0.0;
    const auto force = [&]() -> Vector3d {
      return rig_.robot().w_H.head<3>() - without_hand_.head<3>();
    };
    wait_for(
        [&] {
          const bool pulls = force().norm() > kPull;
          lasted = pulls ? lasted + rig_.dt() : 0.0;
          sum = pulls ? Vector3d(sum + rig_.dt() * force()) : Vector3d::Zero();
          return lasted > kPullTime;
        },
        "the handle was not pulled", rig_.dt());
    rig_.crew().pull(Vector3d::Zero());
    say("-> let go");
    double quiet = 0.0;
    wait_for(
        [&] {
          quiet = force().norm() < 0.5 * kPull ? quiet + rig_.dt() : 0.0;
          return quiet > kPullTime;
        },
        "the handle was not let go of", rig_.dt());
    return sum / kPullTime;
  }

  void ask(const Question& question) { rig_.crew().ask(question); }

  bool wait_for_answer() {
    std::optional<bool> answer;
    for (double t = 0.0; t < kWait; t += kLooks) {
      answer = rig_.crew().answer();
      if (answer) return *answer;
      rig_.hold(kLooks);
    }
    throw Ended{"no answer was given"};
  }

  void wait_for(const std::function<bool()>& is_so, const std::string& otherwise,
                double every_s = kLooks) {
    for (double t = 0.0; t < kWait; t += every_s) {
      if (is_so()) return;
      rig_.rest(every_s);
    }
    throw Ended{otherwise};
  }

  Rig& rig_;
  Options options_;
  const DeviceModel& model_;
  model::ChainData chain_;
  collision::Nearest shapes_;
  std::vector<Item> items_;
  std::string found_;
  AtRest at_rest_;
  Vector6 without_hand_ = Vector6::Zero();
  bool is_failed_ = false, is_left_out_ = false;
};

}  // namespace

std::vector<Item> run(Rig& rig, const Options& options) { return Steps(rig, options).run(); }

}  // namespace hg::commission
