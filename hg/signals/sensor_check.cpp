#include "hg/signals/sensor_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "hg/core/fields.h"

namespace hg {
namespace {

// Archive over the fields() of a frame that sums 0 x over all numbers x: 0, or NaN if one of them
// is not finite. Skips the members at `unchecked`.
struct FiniteSum {
  std::array<const void*, 3> unchecked;
  double nothing = 0.0;

  template <typename T>
  void operator()(const char*, const T& value, const char*, const Unit& = unit::kNone) noexcept {
    if (std::ranges::find(unchecked, static_cast<const void*>(&value)) != unchecked.end()) return;
    if constexpr (HasFields<T>) {
      fields(*this, value);
    } else if constexpr (std::is_same_v<T, double>) {
      nothing += 0.0 * value;
    } else if constexpr (std::is_class_v<T>) {
      for (Eigen::Index i = 0; i < value.size(); ++i) nothing += 0.0 * value.data()[i];
    } else {
      static_assert(std::is_integral_v<T> || std::is_enum_v<T>);
    }
  }
};

bool has_bad_value(const SensorFrame& sensors, bool has_imu) noexcept {
  FiniteSum sum = {.unchecked = {&sensors.inertial}};
  if (!has_imu) sum.unchecked = {&sensors.inertial, &sensors.a_S, &sensors.omega_S};
  fields(sum, sensors);
  return sum.nothing != 0.0;
}

// Index of the first value that is not finite, counted through all sensors; -1 = none of them.
int first_bad_value(const SensorFrame& sensors, bool has_imu) noexcept {
  int passed = 0, found = -1;
  for_each_sensor(sensors, [&](const SensorKind&, const auto& values) {
    const void* const at = &values;
    const bool counts = has_imu || (at != &sensors.a_S && at != &sensors.omega_S);
    for (int i = 0; i < values.size() && found < 0; ++i) {
      if (counts && !std::isfinite(values[i])) found = passed + i;
    }
    passed += static_cast<int>(values.size());
  });
  return found;
}

bool may_lack(const SensorKind& kind, const RequiredSensors& required) noexcept {
  return kind.may_lack == MayLack::kAlways ||
         (kind.may_lack == MayLack::kWithoutTorqueLoop && !required.has_torque_loop);
}

// value = number of values, limit = that which is right, index = kind of sensor
Fault check_sizes(const SensorFrame& sensors, const RequiredSensors& required) noexcept {
  Fault fault;
  std::int16_t kind_index = 0;
  for_each_sensor(sensors, [&](const SensorKind& kind, const auto& values) {
    const std::int16_t index = kind_index++;
    if (kind.per == ValuePer::kComponent || fault.code != FaultCode::kNone) return;
    const Eigen::Index right = kind.per == ValuePer::kJoint ? required.n_m : required.n_p;
    const Eigen::Index size = values.size();
    if (size == right || (size == 0 && may_lack(kind, required))) return;
    fault = {FaultCode::kSensorIncomplete, index, static_cast<double>(size),
             static_cast<double>(right)};
  });
  return fault;
}

}  // namespace

Fault check_values(const SensorFrame& sensors, const RequiredSensors& required) noexcept {
  const Fault size = check_sizes(sensors, required);
  if (size.code != FaultCode::kNone) return size;
  if (!has_bad_value(sensors, required.has_imu)) return {};
  const int index = first_bad_value(sensors, required.has_imu);
  return {FaultCode::kSensorNotFinite, static_cast<std::int16_t>(index), NAN, 0.0};
}

}  // namespace hg
