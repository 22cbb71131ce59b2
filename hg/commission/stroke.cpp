#include "hg/commission/stroke.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hg::commission {
namespace {

using Eigen::Vector3d;

constexpr double kStood = 0.2;  // share of the commanded way below which a joint has not moved
constexpr double kSwing = 0.01, kSlideSwing = 0.003;  // rad, m, of a joint that is held
constexpr double kRatio = 0.1;  // largest deviation of a ratio of encoders and speeds
constexpr double kRatioUnderWay = 0.3;
constexpr double kTurnRatio = 0.1;    // the same of the gyroscope
constexpr double kAxisAngle = 0.087;  // rad, largest deviation of an axis: 5 degrees
constexpr double kZeroStep = 0.01;    // rad, step of the search for a zero position
constexpr double kZeroFits = 0.035;   // rad, below which a zero position explains an axis

std::string unit_of(const DeviceModel& device, int joint) {
  return device.chain.joints()[joint].is_slide() ? "mm" : "mrad";
}

// A ratio of two motions that should be equal, in words; empty: they are, within `allowed`.
std::string words_of_ratio(double ratio, double allowed) {
  if (std::abs(ratio - 1.0) <= allowed) return "";
  if (std::abs(ratio + 1.0) <= allowed) return "the other way";
  return fmt::format("{:.2f} times as far", ratio);
}

// The joints between `joint` and the sensor of which another zero position explains a measured
// axis. Turning about joint k turns the axes of all joints before it, seen from S.
std::string wrong_zero(const Vector3d& axis, int joint, const std::vector<Vector3d>& axes,
                       const DeviceModel& device) {
  std::string names;
  for (int k = joint + 1; k < std::ssize(axes); ++k) {
    if (axes[k].isZero()) continue;
    double best = M_PI, offset = 0.0;
    for (double d = -M_PI; d < M_PI; d += kZeroStep) {
      const double angle = angle_between(Eigen::AngleAxisd(-d, axes[k]) * axes[joint], axis);
      if (angle >= best) continue;
      best = angle;
      offset = d;
    }
    if (best > kZeroFits) continue;
    names += fmt::format("{}{} by about {:.0f} degrees", names.empty() ? "" : ", or ",
                         name_of(device, k), offset * 180.0 / M_PI);
  }
  return names;
}

// The joint that moved most while it was held and `stroke.joint` was led; -1: none by much.
int swinging_beside(const Stroke& stroke, const DeviceModel& device) {
  int found = -1;
  double most = 1.0;
  for (int i = 0; i < stroke.moved.size(); ++i) {
    const double allowed = device.chain.joints()[i].is_slide() ? kSlideSwing : kSwing;
    const double swing = (stroke.highest[i] - stroke.lowest[i]) / allowed;
    if (i == stroke.joint || swing <= most) continue;
    most = swing;
    found = i;
  }
  return found;
}

// Whether motor encoder and speed of the joint that was led agree with its link encoder.
std::string problem_of_ratios(const Stroke& stroke, const DeviceModel& device) {
  const int k = stroke.joint - device.n_p;
  const std::string& name = name_of(device, stroke.joint);
  const double moved = stroke.moved[stroke.joint];
  if (k >= 0 && stroke.motors.size() > k) {
    if (const std::string wrong = words_of_ratio(stroke.motors[k] / moved, kRatio);
        !wrong.empty()) {
      return fmt::format(
          "the motor of {} moves {} as its link: sign, gear ratio or order of the motor encoders",
          name, wrong);
    }
  }
  if (k >= 0) {
    if (const std::string wrong = words_of_ratio(stroke.by_speed[k] / moved, kRatio);
        !wrong.empty()) {
      return fmt::format(
          "by its speed {} moves {} as by its encoder: sign, unit or order of the "
          "speeds",
          name, wrong);
    }
  }
  return "";
}

std::string problem_of_turn(const Stroke& stroke, const DeviceModel& device,
                            const model::ChainData& chain) {
  const double moved = stroke.moved[stroke.joint];
  const std::string& name = name_of(device, stroke.joint);
  const std::vector<Vector3d> axes = axes_in_sensor(device, chain);
  const Vector3d turned = moved < 0.0 ? Vector3d(-stroke.turned) : stroke.turned;
  const double ratio = turned.norm() / std::abs(moved);
  if (ratio < kStood) {
    return fmt::format("the encoder of {} moves, and the gyroscope feels no turn", name);
  }
  const double angle = angle_between(turned, axes[stroke.joint]);
  if (M_PI - angle < kAxisAngle) {
    return fmt::format(
        "{} turns the other way than its axis in the URDF says: the sign of command and encoder "
        "together, or of that axis",
        name);
  }
  if (angle > kAxisAngle) {
    for (int k = 0; k < std::ssize(axes); ++k) {
      if (k == stroke.joint || axes[k].isZero()) continue;
      const double other = angle_between(turned, axes[k]);
      if (other > kAxisAngle && M_PI - other > kAxisAngle) continue;
      return fmt::format("{} turns where {} was commanded and reported: they are swapped",
                         name_of(device, k), name);
    }
    const std::string zero = wrong_zero(turned.normalized(), stroke.joint, axes, device);
    return fmt::format("the axis of {} is {:.0f} degrees from where the model has it: {}", name,
                       angle * 180.0 / M_PI,
                       zero.empty() ? "the model of the links beyond it, or the pose of the sensor"
                                    : "zero position of " + zero);
  }
  const std::string wrong = words_of_ratio(ratio, kTurnRatio);
  if (wrong.empty()) return "";
  return fmt::format("{} turns {} as its encoder says: gear ratio of command and encoder", name,
                     wrong);
}

}  // namespace

const std::string& name_of(const DeviceModel& device, int joint) {
  return device.chain.joints()[joint].name;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

double friction_of(const Stroke& there, const Stroke& back) {
  return 0.5 * (there.way > 0.0 ? there.torque - back.torque : back.torque - there.torque);
}

std::vector<Vector3d> axes_in_sensor(const DeviceModel& device, const model::ChainData& chain) {
  const model::Jacobian& J = chain.jacobian(device.handle);
  const Eigen::Matrix3d R_S_B = (chain.pose(device.handle).R * device.T_H_S.R).transpose();
  std::vector<Vector3d> axes;
  for (int i = 0; i < device.n_p + device.n_m; ++i) {
    axes.emplace_back(R_S_B * J.col(i).tail<3>());
  }
  return axes;
}

std::string problem_of(const Stroke& stroke, const DeviceModel& device,
                       const model::ChainData& chain) {
  const int i = stroke.joint;
  const std::string& name = name_of(device, i);
  const double moved = stroke.moved[i];
  Eigen::Index most = 0;
  stroke.moved.cwiseAbs().maxCoeff(&most);
  const double other = std::abs(stroke.moved[most]);
  if (most != i && other > kStood * std::abs(stroke.way)) {
    const std::string& name_of_other = name_of(device, static_cast<int>(most));
    if (std::abs(moved) < kStood * other) {
      return fmt::format("{} moves when {} is led: commands or encoders are swapped", name_of_other,
                         name);
    }
    if (stroke.is_cut) {
      return fmt::format("{} leaves its place while {} is led: it is not held as its model says",
                         name_of_other, name);
    }
  }
  if (std::abs(moved) < kStood * std::abs(stroke.way)) {
    return fmt::format("{} does not move: {:.1f} of {:.1f} {}", name, 1e3 * moved, 1e3 * stroke.way,
                       unit_of(device, i));
  }
  if (moved * stroke.way < 0.0) {
    return fmt::format("{} moves against its command: the sign of its command or its encoder",
                       name);
  }
  // a stroke that was cut off was under way, with the encoder behind
  const double allowed = stroke.is_cut ? kRatioUnderWay : kRatio;
  if (const std::string wrong = words_of_ratio(moved / stroke.way, allowed); !wrong.empty()) {
    return fmt::format("{} moves {} as commanded: gear ratio or unit of its command or its encoder",
                       name, wrong);
  }
  if (const int swinging = swinging_beside(stroke, device); swinging >= 0) {
    return fmt::format("{} swings while {} is led: it is not held as its model says",
                       name_of(device, swinging), name);
  }
  if (const std::string wrong = problem_of_ratios(stroke, device); !wrong.empty()) return wrong;
  if (stroke.has_gyroscope && !device.chain.joints()[i].is_slide()) {
    const std::string turn = problem_of_turn(stroke, device, chain);
    if (!turn.empty()) return turn;
  }
  if (stroke.is_cut)
    return fmt::format("{} does not follow its command, or its drive is not on yet", name);
  return "";
}

std::string problem_of_hold(const VectorPM& moved, const DeviceModel& device) {
  constexpr double kAlso = 0.5;  // of the largest motion: this joint is meant, too
  const double most = moved.cwiseAbs().maxCoeff();
  std::vector<std::string> names;
  for (int i = 0; i < moved.size(); ++i) {
    if (std::abs(moved[i]) >= kAlso * most) names.push_back(name_of(device, i));
  }
  return fmt::format(
      "{} left {} as soon as the drives held the arm: the sign of command or encoder, or the "
      "command or encoder of another joint",
      fmt::join(names, ", "), names.size() > 1 ? "their places" : "its place");
}

}  // namespace hg::commission
