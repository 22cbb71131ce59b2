#include "hg/signals/sensor_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "hg/core/fields.h"
#include "hg/core/interval.h"

namespace hg {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr RequiredSensors kRequired = {.n_p = 2, .n_m = 6, .has_imu = true};
constexpr RequiredSensors kTorques = {.n_p = 2, .n_m = 6, .has_torque_loop = true, .has_imu = true};

SensorFrame good_sensors() {
  SensorFrame sensors;
  sensors.q_m = VectorM::Zero(6);
  sensors.dq_m = VectorM::Zero(6);
  sensors.q_p = VectorP::Zero(2);
  return sensors;
}

SensorFrame complete_sensors() {
  SensorFrame sensors = good_sensors();
  sensors.theta_m = sensors.tau_m = VectorM::Zero(6);
  return sensors;
}

TEST(CheckValues, GoodOnesPass) {
  EXPECT_EQ(check_values(good_sensors(), kRequired).code, FaultCode::kNone);
  EXPECT_EQ(check_values(complete_sensors(), kTorques).code, FaultCode::kNone);
}

TEST(CheckValues, NamesTheComponentThatIsNotFinite) {
  // counted through: 6 joints, 6 speeds, 2 gantry axes, 6 components of the wrench, 6 motors, 6
  // torques, accelerometer, gyroscope
  const auto expect_named = [](auto&& corrupt, int index) {
    SensorFrame sensors = complete_sensors();
    corrupt(sensors);
    const Fault fault = check_values(sensors, kRequired);
    EXPECT_EQ(fault.code, FaultCode::kSensorNotFinite) << index;
    EXPECT_EQ(fault.index, index);
  };
  expect_named([](SensorFrame& s) { s.q_m[3] = kNan; }, 3);
  expect_named([](SensorFrame& s) { s.q_p[1] = kInfinity; }, 13);
  expect_named([](SensorFrame& s) { s.w_S[5] = kNan; }, 19);
  expect_named([](SensorFrame& s) { s.theta_m[0] = kNan; }, 20);
  expect_named([](SensorFrame& s) { s.tau_m[5] = kInfinity; }, 31);
  expect_named([](SensorFrame& s) { s.a_S[1] = kNan; }, 33);
  expect_named([](SensorFrame& s) { s.omega_S[2] = -kInfinity; }, 37);
}

TEST(CheckValues, WhatADeviceWithoutInertialUnitSaysOfItDoesNotMatter) {
  SensorFrame sensors = good_sensors();
  sensors.a_S[0] = sensors.omega_S[0] = kNan;
  const RequiredSensors without = {.n_p = 2, .n_m = 6};
  EXPECT_EQ(check_values(sensors, without).code, FaultCode::kNone);
  sensors.w_S[1] = kNan;
  EXPECT_EQ(check_values(sensors, without).index, 15);
}

// Archive over the fields() of a frame: all its numbers, with the names of their members. Empty
// vectors get six entries.
struct Numbers {
  std::vector<std::pair<std::string, double*>> all;

  template <typename T>
  void operator()(const char* name, T& value, const char*, const Unit& = unit::kNone) {
    if constexpr (HasFields<T>) {
      fields(*this, value);
    } else if constexpr (std::is_same_v<T, double>) {
      all.emplace_back(name, &value);
    } else if constexpr (std::is_class_v<T>) {
      if constexpr (T::SizeAtCompileTime == Eigen::Dynamic) {
        if (value.size() == 0) value = T::Zero(6);
      }
      for (Eigen::Index i = 0; i < value.size(); ++i) all.emplace_back(name, value.data() + i);
    }
  }
};

TEST(CheckValues, LooksAtEveryNumberOfAFrameButInertialUnitsOnLinks) {
  SensorFrame sensors = good_sensors();
  Numbers numbers;
  fields(numbers, sensors);
  ASSERT_GT(numbers.all.size(), 30U);
  for (const auto& [name, number] : numbers.all) {
    const double kept = std::exchange(*number, kNan);
    const FaultCode code = check_values(sensors, kRequired).code;
    EXPECT_EQ(code == FaultCode::kSensorNotFinite, name != "inertial") << name;
    *number = kept;
  }
}

// Archive over the fields() of a frame: gives the vector number `which`, of those of any length,
// `size` zeros. `name` stays empty if there are fewer.
struct Resize {
  int which = 0;
  Eigen::Index size = 0;
  std::string name;

  template <typename T>
  void operator()(const char* field, T& value, const char*, const Unit& = unit::kNone) {
    if constexpr (HasFields<T>) {
      fields(*this, value);
    } else if constexpr (std::is_class_v<T>) {
      if constexpr (T::SizeAtCompileTime == Eigen::Dynamic) {
        if (which-- != 0) return;
        size = std::min(size, Eigen::Index{T::MaxSizeAtCompileTime});
        value = T::Zero(size);
        name = field;
      }
    }
  }
};

TEST(CheckValues, EveryVectorOfAnyLengthIsRefusedWithTheWrongOne) {
  std::vector<std::string> seen;
  for (int which = 0;; ++which) {
    std::string name;
    for (const Eigen::Index size : {0, 1, 5, 7}) {
      SensorFrame sensors = complete_sensors();
      Resize resize = {.which = which, .size = size, .name = {}};
      fields(resize, sensors);
      name = resize.name;
      if (name.empty() || name == "inertial") continue;
      const bool is_right = resize.size == (name == "q_p" ? 2 : 6);
      const bool may_lack = name == "temperature_m" && size == 0;
      const FaultCode code = check_values(sensors, kTorques).code;
      EXPECT_EQ(code == FaultCode::kNone, is_right || may_lack) << name << " " << size;
    }
    if (name.empty()) break;
    seen.push_back(name);
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"q_m", "dq_m", "theta_m", "tau_m", "q_p",
                                            "temperature_m", "inertial"}));
}

TEST(CheckValues, OnlyATorqueLoopNeedsMotorEncodersAndTorqueSensors) {
  SensorFrame sensors = complete_sensors();
  sensors.theta_m.resize(0);
  EXPECT_EQ(check_values(sensors, kRequired).code, FaultCode::kNone);
  const Fault fault = check_values(sensors, kTorques);
  EXPECT_EQ(fault.code, FaultCode::kSensorIncomplete);
  EXPECT_EQ(fault.index, 4);
  EXPECT_EQ(fault.value, 0.0);
  EXPECT_EQ(fault.limit, 6.0);
}

}  // namespace
}  // namespace hg
