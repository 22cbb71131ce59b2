#include "hg/explanation/fault_figures.h"

#include <fmt/format.h>

#include <cmath>

namespace hg::explanation {
namespace {

std::string name_in(const std::vector<std::string>& list, int index, const char* otherwise) {
  const bool is_known = index >= 0 && index < static_cast<int>(list.size());
  return is_known ? list[static_cast<std::size_t>(index)] : fmt::format("{} {}", otherwise, index);
}

// which value of a sample is meant, counted as safety::check_sensors counts
std::string sensor_name(int index, const Names& names, const SensorFrame& sensors) {
  const struct {
    const char* what;
    Eigen::Index size;
    const std::vector<std::string>* parts;
  } kGroups[] = {{"link encoder", sensors.q_m.size(), &names.joints},
                 {"speed", sensors.dq_m.size(), &names.joints},
                 {"gantry encoder", sensors.q_p.size(), &names.gantry},
                 {"force/torque sensor, component", 6, nullptr},
                 {"motor encoder", sensors.theta_m.size(), &names.joints},
                 {"torque sensor", sensors.tau_m.size(), &names.joints},
                 {"accelerometer, component", 3, nullptr},
                 {"gyroscope, component", 3, nullptr},
                 {"temperature", sensors.temperature_m.size(), &names.joints}};
  for (const auto& group : kGroups) {
    if (index < group.size) {
      return fmt::format("{} {}", group.what,
                         group.parts != nullptr ? name_in(*group.parts, index, "number")
                                                : fmt::format("{}", index + 1));
    }
    index -= static_cast<int>(group.size);
  }
  return {};
}

}  // namespace

std::string part_of(const Fault& fault, const Names& names, const SensorFrame& sensors) {
  const int index = fault.index;
  if (index < 0) return {};
  const auto n_m = static_cast<int>(sensors.q_m.size());
  switch (fault.code) {
    case FaultCode::kSensorNotFinite:
      return sensor_name(index, names, sensors);
    case FaultCode::kWrenchTooLarge:
      return index == 0 ? "force in N" : "torque in Nm";
    case FaultCode::kSafeSpeedExceeded:
      return index == 0 ? "handle" : "gantry";
    case FaultCode::kCycleOverrun:
      return index == 0 ? "in a row" : "in a second";
    case FaultCode::kLimitExceeded:
      return index < static_cast<int>(names.limits.size())
                 ? names.limits[static_cast<std::size_t>(index)].name
                 : fmt::format("number {}", index);
    case FaultCode::kGantryExceeded:
    case FaultCode::kGantryDeviates:
      return name_in(names.gantry, index, "axis");
    case FaultCode::kSensorJump:
      // joints, then axes of the gantry
      if (index >= n_m) return name_in(names.gantry, index - n_m, "axis");
      [[fallthrough]];
    case FaultCode::kSensorImplausible:
    case FaultCode::kJointTorqueExceeded:
    case FaultCode::kTooHot:
    case FaultCode::kMotorDeviates:
    case FaultCode::kTorqueUnexplained:
    case FaultCode::kSpeedExceeded:
    case FaultCode::kTrackingLost:
    case FaultCode::kAccelerationExceeded:
      return name_in(names.joints, index, "number");
    default:
      return fmt::format("number {}", index);
  }
}

std::string figures_of(const Fault& fault, const Names& names, const SensorFrame& sensors) {
  const auto is_bit = [](double value) { return value == 0.0 || value == 1.0; };
  std::string text = part_of(fault, names, sensors);
  const char* separator = text.empty() ? "" : ": ";
  if (!std::isfinite(fault.value)) return fmt::format("{}{}not finite", text, separator);
  if (is_bit(fault.value) && is_bit(fault.limit)) return text;  // yes or no
  return fmt::format("{}{}{:.4g}, limit {:.4g}", text, separator, fault.value, fault.limit);
}

}  // namespace hg::explanation
