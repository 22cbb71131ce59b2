// A run of the reference device with a door: what a recording of it says about joints and limits,
// and samples whose values read_recording.py can predict.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "hg/recording/recorder.h"
#include "hg/signals/state.h"

namespace hg::recording {

/// A finite double whose bits are all in use: splitmix64 of `key`, exponent bits 0x3fe or 0x3ff.
inline double scrambled(std::uint64_t key) {
  std::uint64_t z = key + 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  z ^= z >> 31;
  return std::bit_cast<double>((z & 0x801fffffffffffff) | 0x3fe0000000000000);
}

inline LimitCatalogue example_limits() {
  LimitCatalogue limits;
  for (const char* joint : {"m1", "m2", "m3", "m4", "m5", "m6"}) {
    limits.push_back({LimitKind::kManipulatorJoint, joint, true, {-1.5, 2.0}});
  }
  limits.push_back({LimitKind::kVirtualJoint, "q4+q5", true, {0.1, 3.0}});
  for (const char* axis : {"elbow x", "elbow y", "elbow z"}) {
    limits.push_back({LimitKind::kCartesian, axis, false, {}});
  }
  limits.push_back({LimitKind::kTwinJoint, "hinge", true, {0.0, 1.57}});
  return limits;
}

inline RecordingInfo example_info(const std::filesystem::path& folder) {
  RecordingInfo info;
  info.folder = folder;
  info.name = "door";
  info.gantry_joints = {"p1", "p2"};
  info.manipulator_joints = {"m1", "m2", "m3", "m4", "m5", "m6"};
  info.twin_joints = {{"hinge", false}};
  info.limits = example_limits();
  info.configuration = {{"device.yaml", "urdf: device.urdf\n"}, {"twin.yaml", "urdf: door.urdf\n"}};
  info.version = "0.1.0";
  return info;
}

/// Inputs of a cycle: scrambled bits, so that a single wrong one is seen.
void fill_inputs(std::uint64_t cycle, auto noise, Sample& sample) {
  SensorFrame& sensors = sample.sensors;
  sensors.sequence = cycle;
  sensors.time_s = noise();
  for (VectorM* vector : {&sensors.q_m, &sensors.dq_m, &sensors.tau_m}) {
    *vector = VectorM::NullaryExpr(6, noise);
  }
  sensors.q_p = VectorP::NullaryExpr(2, noise);
  sensors.w_S = Vector6::NullaryExpr(noise);
  sensors.dead_man = true;
  sample.operator_input.request = cycle == 0 ? ModeRequest::kRun : ModeRequest::kNone;
  HandTarget& target = sample.operator_input.hand_target;
  target.active = true;
  target.p_B = Eigen::Vector3d::NullaryExpr(noise);
  target.press = noise();
}

/// A sample whose outputs move and are noisy like those of a real run, so that the size of the file
/// is realistic.
inline Sample example_sample(std::uint64_t cycle, double rate_Hz) {
  const double t = static_cast<double>(cycle) / rate_Hz;
  std::uint64_t key = 100 * cycle;
  const auto noise = [&key] { return scrambled(key++); };
  const auto moving = [&](auto& vector, int size, double scale) {
    vector.resize(size);
    for (int i = 0; i < size; ++i) {
      vector[i] = scale * (std::sin(t + i) + 1e-5 * noise());
    }
  };

  Sample sample;
  fill_inputs(cycle, noise, sample);
  CommandFrame& command = sample.command;
  command.sequence = cycle;
  command.enable = true;
  for (VectorM* vector : {&command.q_m, &command.dq_m, &command.ddq_m}) moving(*vector, 6, 1.0);
  moving(command.dq_p, 2, 0.3);
  command.hand_target = sample.operator_input.hand_target;

  CycleRecord& record = sample.record;
  record.cycle = cycle;
  record.time_s = t;
  record.mode = Mode::kRunning;
  record.robot.q_m = command.q_m;
  record.robot.dq_m = command.dq_m;
  for (VectorP* vector : {&record.robot.q_p, &record.robot.dq_p, &record.robot.ddq_p}) {
    moving(*vector, 2, 1.0);
  }
  record.robot.w_H << 3.0, 0.1 * std::sin(t), 0.0, 0.0, 0.0, 0.2;
  record.reference = {command.q_m, command.dq_m, command.ddq_m};
  moving(record.twin.q_a, 1, 1.0);
  moving(record.twin.dq_a, 1, 1.0);
  moving(record.twin.ddq_a, 1, 1.0);
  record.T_B_H.p = {1.0 + 0.1 * std::sin(t), 2.0, 0.5};
  record.T_B_H.R = Eigen::AngleAxisd(0.5 * t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  record.v_H = {0.1 * std::cos(t), 0.0, 0.0};
  record.a_H = {-0.1 * std::sin(t), 0.0, 0.0};
  record.p_B_elbow = {0.5, 1.5, 1.0};
  for (VectorA* vector : {&record.tau_a, &record.budget.inertia, &record.budget.damping,
                          &record.budget.friction, &record.budget.spring, &record.budget.surface,
                          &record.budget.limits, &record.budget.conflict}) {
    moving(*vector, 1, 2.0);
  }
  record.limit_count = static_cast<int>(example_limits().size());
  for (int i = 0; i < record.limit_count; ++i) {
    LimitReport& report = record.limits[i];
    report.position = std::sin(t + i) + 1e-5 * noise();
  }
  record.limits[3].state = LimitState::kUpper;
  record.limits[3].cause = LimitCause::kPosition;
  record.limits[3].reaction = -5.0 - std::sin(t);
  record.felt_limit = 3;
  moving(record.q_p_target, 2, 1.0);
  record.solver_status = SolverStatus::kSolved;
  record.solver_iterations = 2;
  record.state_hash = std::bit_cast<std::uint64_t>(noise());
  sample.cycle_time_us = 8.0 + std::abs(noise());
  return sample;
}

}  // namespace hg::recording
