#include "hg/identify/joint_recording.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "hg/core/error.h"
#include "hg/identify/recorded_device.h"
#include "hg/identify/settling.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::identify {
namespace {

std::vector<std::string> joint_names(const DeviceModel& device) {
  std::vector<std::string> names;
  for (int i = 0; i < device.n_m; ++i) names.push_back(device.manipulator_joint(i));
  return names;
}

// Collects the motion, with the device of the recording unless another is given.
class Reader final : public recording::RecordingListener {
 public:
  Reader(const std::string& file, std::optional<config::SimulatedDeviceConfig> device)
      : file_(file), device_(std::move(device)) {}

  void configuration(const recording::NamedText& text) override {
    if (!joints_) configuration_.push_back(text);
  }
  void event(const recording::Event&) override {}
  void sample(const Sample& sample) override {
    if (!joints_) start();
    joints_->add(sample);
  }

  config::SimulatedDeviceConfig& device() { return *device_; }
  const JointRecording& joints() const { return *joints_; }

 private:
  void start() {
    if (device_) {
      refuse_other();
    } else {
      device_ = recorded_device(file_, configuration_);
    }
    joints_.emplace(device_->model);
  }

  // A configuration that is not understood names no joints: the given device counts.
  void refuse_other() const {
    std::vector<std::string> recorded;
    try {
      recorded = joint_names(scenario::recorded_scenario(configuration_).device.model);
    } catch (const SetupError&) {
      return;
    }
    const std::vector<std::string> given = joint_names(device_->model);
    if (recorded == given) return;
    throw SetupError(fmt::format("{}: is of another device, with the joints {}; {} has {}", file_,
                                 fmt::join(recorded, ", "), device_->name, fmt::join(given, ", ")));
  }

  const std::string& file_;
  std::optional<config::SimulatedDeviceConfig> device_;
  std::optional<JointRecording> joints_;
  std::vector<recording::NamedText> configuration_;
};

template <typename Moments, typename Vector>
Series columns(const Moments& moments, Vector member) {
  const auto rows = static_cast<Eigen::Index>(moments.size());
  Series series(rows, (moments.front().*member).size());
  for (Eigen::Index k = 0; k < rows; ++k) {
    series.row(k) = (moments[static_cast<std::size_t>(k)].*member).transpose();
  }
  return series;
}

}  // namespace

JointRecording::JointRecording(const DeviceModel& device)
    : n_p_(device.n_p), settling_(kSettling_s / device.dt()) {
  for (int i = 0; i < device.n_m; ++i) turns_.push_back(!device.is_slide(i));
}

double JointRecording::unwrapped(int joint, double angle, double near) const {
  if (!turns_[static_cast<std::size_t>(joint)]) return angle;
  return near + std::remainder(angle - near, 2.0 * std::numbers::pi);
}

void JointRecording::add(const Sample& sample) {
  const SensorFrame& sensors = sample.sensors;
  const auto n = std::ssize(turns_);
  if (sensors.q_m.size() != n || sensors.q_p.size() != n_p_) {
    throw SetupError(
        fmt::format("the recording is of another device, with {} joints and {} axes of a gantry; "
                    "this one has {} and {}",
                    sensors.q_m.size(), sensors.q_p.size(), n, n_p_));
  }
  const bool follows = samples_ > 0 && sensors.sequence == last_ + 1;
  if (samples_ > 0 && !follows) ++gaps_;
  ++samples_;
  last_ = sensors.sequence;
  const bool is_finite = sensors.q_m.allFinite() && sensors.theta_m.allFinite() &&
                         sensors.tau_m.allFinite() && sensors.q_p.allFinite() &&
                         sensors.w_S.allFinite() && sample.command.q_m.allFinite();
  const bool is_on = sample.command.enable && sample.command.q_m.size() == n;
  on_ = is_on && is_finite && follows ? on_ + 1 : 0;
  if (on_ > settling_) {
    take(sample);
  } else {
    is_cut_ = true;
  }
}

void JointRecording::take(const Sample& sample) {
  const SensorFrame& sensors = sample.sensors;
  const auto has_changed = [&](const Moment& last) {
    return last.theta.size() != sensors.theta_m.size() || last.tau.size() != sensors.tau_m.size();
  };
  if (is_cut_ || has_changed(parts_.back().back())) parts_.emplace_back();
  is_cut_ = false;
  ++used_;
  Moment moment = {sensors.q_m,        sensors.theta_m, sensors.tau_m,
                   sample.command.q_m, sensors.q_p,     sensors.w_S};
  std::vector<Moment>& part = parts_.back();
  for (int i = 0; i < static_cast<int>(turns_.size()); ++i) {
    if (!part.empty()) moment.q[i] = unwrapped(i, moment.q[i], part.back().q[i]);
    moment.command[i] = unwrapped(i, moment.command[i], moment.q[i]);
    if (i < moment.theta.size()) moment.theta[i] = unwrapped(i, moment.theta[i], moment.q[i]);
  }
  part.push_back(std::move(moment));
}

std::vector<JointMotion> JointRecording::parts() const {
  std::vector<JointMotion> result;
  for (const std::vector<Moment>& part : parts_) {
    result.push_back({columns(part, &Moment::q), columns(part, &Moment::theta),
                      columns(part, &Moment::tau), columns(part, &Moment::command),
                      columns(part, &Moment::q_p), columns(part, &Moment::wrench_S)});
  }
  return result;
}

RecordedJoints read_joints(const std::string& file,
                           std::optional<config::SimulatedDeviceConfig> device) {
  Reader reader(file, std::move(device));
  std::vector<recording::Loss> losses = recording::read_recording(file, reader).losses;
  const JointRecording& joints = reader.joints();
  refuse_if_cut_up(file, losses, joints.used(), joints.gaps());
  if (joints.used() == 0) {
    throw SetupError(fmt::format(
        "{}{}: none of its {} samples has drives that have been on for {:g} s and finite values: "
        "record a run in which the device moves",
        recording::to_text(losses), file, joints.samples(), kSettling_s));
  }
  const double used_s = static_cast<double>(joints.used()) * reader.device().model.dt();
  return {std::move(reader.device()), std::move(losses), joints.parts(), used_s};
}

Series smoothed(const Series& x, int half) {
  Eigen::VectorXd window(2 * half + 1);
  for (int i = -half; i <= half; ++i) {
    window[i + half] = 1.0 + std::cos(std::numbers::pi * i / (half + 1));
  }
  window /= window.sum();
  Series result = x;
  for (Eigen::Index k = half; k + half < x.rows(); ++k) {
    result.row(k).noalias() = window.transpose() * x.middleRows(k - half, 2 * half + 1);
  }
  return result;
}

Series slope(const Series& x, double period_s) {
  Series result = Series::Zero(x.rows(), x.cols());
  const Eigen::Index inner = x.rows() - 2;
  if (inner < 1) return result;
  result.middleRows(1, inner) = (x.bottomRows(inner) - x.topRows(inner)) / (2.0 * period_s);
  return result;
}

}  // namespace hg::identify
