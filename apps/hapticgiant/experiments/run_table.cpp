#include "apps/hapticgiant/experiments/run_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::apps {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// times are whole cycles up to rounding
constexpr double kTick_s = 1e-7;

template <typename Vector>
double at(const Vector& values, int i) {
  return i < values.size() ? values[i] : kNone;
}

}  // namespace

bool is_angle(const model::Joint& joint) noexcept {
  return joint.type != model::JointType::kPrismatic;
}

RunTable::RunTable(const config::Scenario& scenario, double period_s)
    : scenario_(scenario), period_s_(period_s), open_(scenario.limits.size(), -1) {
  add_column("time_s", [](const Sample& s) { return s.record.time_s; });
  add_column("running",
             [](const Sample& s) { return s.record.mode == Mode::kRunning ? 1.0 : 0.0; });
  add_column("force_N", [](const Sample& s) { return s.record.robot.w_H.head<3>().norm(); });
  add_column("torque_Nm", [](const Sample& s) { return s.record.robot.w_H.tail<3>().norm(); });
  add_column("felt_limit", [](const Sample& s) { return s.record.felt_limit; });
  add_column("hand_to_twin_m", [](const Sample& s) { return s.record.sync_error; });
  add_device_columns(scenario);
  add_twin_columns(scenario);
}

void RunTable::add_column(std::string name, std::function<double(const Sample&)> of) {
  columns_.push_back({std::move(name), std::move(of), {}});
}

void RunTable::add_device_columns(const config::Scenario& scenario) {
  const DeviceModel& device = scenario.device.model;
  for (int i = 0; i < device.n_m; ++i) {
    const model::Joint& joint = device.chain.joints()[static_cast<std::size_t>(device.n_p + i)];
    const std::string position = joint.name + (is_angle(joint) ? "_rad" : "_m");
    add_column(position, [i](const Sample& s) { return at(s.record.reference.q_m, i); });
    add_column(position + "_per_s",
               [i](const Sample& s) { return at(s.record.reference.dq_m, i); });
  }
  for (const VirtualJoint& joint : device.virtual_joints) {
    add_column(joint.name + "_rad", [weights = joint.weights](const Sample& s) {
      const VectorM& q = s.record.reference.q_m;
      return q.size() == weights.size() ? weights.dot(q) : kNone;
    });
  }
  for (int i = 0; i < device.n_p; ++i) {
    const model::Joint& joint = device.chain.joints()[static_cast<std::size_t>(i)];
    const std::string position = joint.name + (is_angle(joint) ? "_rad" : "_m");
    add_column(position, [i](const Sample& s) { return at(s.record.robot.q_p, i); });
    add_column(position + "_per_s", [i](const Sample& s) { return at(s.record.robot.dq_p, i); });
  }
  for (int axis = 0; axis < 3; ++axis) {
    add_column(fmt::format("hand_{}_m", "xyz"[axis]),
               [axis](const Sample& s) { return s.record.T_B_H.p[axis]; });
  }
  add_column("hand_azimuth_rad", [](const Sample& s) {
    return std::atan2(s.record.T_B_H.R(1, 2), s.record.T_B_H.R(0, 2));
  });
  for (int axis = 0; device.elbow >= 0 && axis < 2; ++axis) {
    add_column(fmt::format("elbow_{}_m", "xy"[axis]),
               [axis](const Sample& s) { return s.record.p_B_elbow[axis]; });
  }
}

void RunTable::add_twin_columns(const config::Scenario& scenario) {
  const auto& dofs = scenario.twin.model.dofs;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (dofs[i].q_index < 0) continue;
    const int q = dofs[i].q_index, v = static_cast<int>(i);
    const char* unit = dofs[i].is_angle ? "rad" : "m";
    add_column(fmt::format("{}_{}", dofs[i].name, unit),
               [q](const Sample& s) { return at(s.record.twin.q_a, q); });
    add_column(fmt::format("{}_{}_per_s", dofs[i].name, unit),
               [v](const Sample& s) { return at(s.record.twin.dq_a, v); });
    add_column(fmt::format("{}_{}", dofs[i].name, dofs[i].is_angle ? "Nm" : "N"),
               [v](const Sample& s) { return at(s.record.tau_a, v); });
  }
}

void RunTable::note_locks(const CycleRecord& record) {
  for (std::size_t i = 0; i < open_.size(); ++i) {
    const bool is_locked =
        static_cast<int>(i) < record.limit_count && record.limits[i].cause == LimitCause::kLock;
    if (!is_locked) {
      open_[i] = -1;
      continue;
    }
    if (open_[i] < 0) {
      open_[i] = static_cast<int>(locked_.size());
      locked_.push_back({scenario_.limits[i].name, record.time_s, record.time_s});
    }
    locked_[static_cast<std::size_t>(open_[i])].to_s = record.time_s;
  }
}

void RunTable::add(const Sample& sample) {
  note_locks(sample.record);
  if (sample.record.time_s < due_s_ - kTick_s) return;
  due_s_ = sample.record.time_s + period_s_;
  for (Column& column : columns_) column.values.push_back(column.of(sample));
}

const std::vector<double>& RunTable::operator[](std::string_view name) const {
  std::vector<std::string> names;
  for (const Column& column : columns_) {
    if (column.name == name) return column.values;
    names.push_back(column.name);
  }
  const std::string wanted(name);
  throw SetupError(wanted + ": no such signal, did you mean '" + nearest_name(wanted, names) +
                   "'?");
}

RowRange RunTable::between(double from_s, double to_s) const {
  const std::vector<double>& times = columns_.front().values;
  const auto row = [&](double time_s) {
    return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time_s - kTick_s) -
                                    times.begin());
  };
  return {row(from_s), row(to_s)};
}

std::string RunTable::to_csv(double period_s) const {
  std::string text;
  for (const Column& column : columns_) text += (text.empty() ? "" : ",") + column.name;
  text += '\n';
  const std::vector<double>& times = columns_.front().values;
  double due_s = 0.0;
  for (std::size_t row = 0; row < rows(); ++row) {
    if (times[row] < due_s - kTick_s) continue;
    due_s = times[row] + period_s;
    const char* separator = "";
    for (const Column& column : columns_) {
      fmt::format_to(std::back_inserter(text), "{}{:.6g}", separator, column.values[row] + 0.0);
      separator = ",";
    }
    text += '\n';
  }
  return text;
}

}  // namespace hg::apps
