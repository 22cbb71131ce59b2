#include "hg/analysis/fault_figures.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>

#include "hg/signals/sensor_check.h"

namespace hg::analysis {

std::string name_in(const std::vector<std::string>& list, int index, const char* otherwise) {
  const bool is_known = index >= 0 && index < static_cast<int>(list.size());
  return is_known ? list[index] : fmt::format("{} {}", otherwise, index);
}

namespace {

// Vectors that follow each other, as they are counted where the fault is found.
struct Group {
  const char* what;
  Eigen::Index size;
  const std::vector<std::string>* parts = nullptr;  ///< null: components
};

std::string part_in(std::initializer_list<Group> groups, int index) {
  for (const Group& group : groups) {
    if (index < group.size) {
      return fmt::format("{} {}", group.what,
                         group.parts != nullptr ? name_in(*group.parts, index, "number")
                                                : fmt::format("{}", index + 1));
    }
    index -= static_cast<int>(group.size);
  }
  return {};
}

// Name of the value with this index of all of a sample, for example "torque sensor m2".
std::string value_in(const SensorFrame& sensors, int index, const Names& names) {
  std::string found;
  for_each_sensor(sensors, [&](const SensorKind& kind, const auto& values) {
    const auto size = static_cast<int>(values.size());
    if (index >= 0 && index < size) {
      switch (kind.per) {
        case ValuePer::kJoint:
          found = fmt::format("{} {}", kind.name, name_in(names.joints, index, "number"));
          break;
        case ValuePer::kAxis:
          found = fmt::format("{} {}", kind.name, name_in(names.gantry, index, "number"));
          break;
        case ValuePer::kComponent:
          found = size == 1 ? std::string(kind.name)
                            : fmt::format("{}, component {}", kind.name, index + 1);
          break;
      }
    }
    index -= size;
  });
  return found;
}

std::string kind_in(const SensorFrame& sensors, int index) {
  std::string found;
  for_each_sensor(sensors, [&](const SensorKind& kind, const auto&) {
    if (index-- == 0) found = kind.name;
  });
  return found;
}

constexpr const char* kForceSensor = "force/torque sensor, component";
constexpr const char* kAccelerometer = "accelerometer, component";
constexpr const char* kGyroscope = "gyroscope, component";

bool is_yes_or_no(FaultCode code) {
  switch (code) {
    case FaultCode::kEmergencyStop:
    case FaultCode::kOperatorReleased:
    case FaultCode::kScannerField:
    case FaultCode::kSafetyInputsDisagree:
    case FaultCode::kDriveFault:
    case FaultCode::kSolverFailed:
    case FaultCode::kOscillation:
      return true;
    default:
      return false;
  }
}

std::string limit_name(const Names& names, int index) {
  return index < static_cast<int>(names.limits.size()) ? names.limits[index].name
                                                       : fmt::format("number {}", index);
}

std::string value_of_command(const Names& names, const SensorFrame& sensors, int index) {
  const auto n_m = static_cast<int>(sensors.q_m.size());
  const auto n_p = static_cast<int>(sensors.q_p.size());
  return part_in({{"position", n_m, &names.joints},
                  {"speed", n_m, &names.joints},
                  {"acceleration", n_m, &names.joints},
                  {"torque", sensors.tau_m.size(), &names.joints},
                  {"speed", n_p, &names.gantry}},
                 index);
}

// As the cycle counts what it is given for the twin.
std::string value_of_twin_input(int index) {
  return part_in({{"wrench, component", 6},
                  {"joint of the twin", kMaxTwin},
                  {"pose of the base, component", 6},
                  {"velocity of the base, component", 6},
                  {"acceleration of the base, component", 6}},
                 index);
}

}  // namespace

std::string part_of(const Fault& fault, const Names& names, const SensorFrame& sensors) {
  const int index = fault.index;
  if (index < 0) return {};
  const auto n_m = static_cast<int>(sensors.q_m.size());
  switch (fault.code) {
    case FaultCode::kSensorNotFinite:
      return value_in(sensors, index, names);
    case FaultCode::kSensorIncomplete:
      return kind_in(sensors, index);
    case FaultCode::kSensorFrozen:
      return part_in({{"torque sensor", n_m, &names.joints},
                      {kForceSensor, 6},
                      {kAccelerometer, 3},
                      {kGyroscope, 3}},
                     index);
    case FaultCode::kCommandNotFinite:
      return value_of_command(names, sensors, index);
    case FaultCode::kCollisionAhead:
      return name_in(names.pairs, index, "pair");
    case FaultCode::kOscillation:
      return std::string(to_string(static_cast<Shaking>(index)));
    case FaultCode::kTwinForceWrong:
      return value_of_twin_input(index);
    case FaultCode::kWrenchTooLarge:
      return index == 0 ? "force in N" : "torque in Nm";
    case FaultCode::kSafeSpeedExceeded:
      return index == 0 ? "handle" : "gantry";
    case FaultCode::kCycleOverrun:
      return index == 0 ? "in a row" : "in a second";
    case FaultCode::kLimitExceeded:
    case FaultCode::kLimitNotHeld:
      return limit_name(names, index);
    case FaultCode::kGantryExceeded:
    case FaultCode::kGantryDeviates:
      return name_in(names.gantry, index, "axis");
    case FaultCode::kBrakingPosition:
    case FaultCode::kBrakingSpeed:
    case FaultCode::kStopTooFar:
    case FaultCode::kBrakesSlip:
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
  std::string text = part_of(fault, names, sensors);
  const char* separator = text.empty() ? "" : ": ";
  if (fault.code == FaultCode::kSensorIncomplete) {
    return fmt::format("{}: {:g} values, {:g} expected", text, fault.value, fault.limit);
  }
  if (!std::isfinite(fault.value)) return fmt::format("{}{}not finite", text, separator);
  const bool has_figures = fault.value != 0.0 || fault.limit != 0.0;
  if (is_yes_or_no(fault.code) || !has_figures) return text;
  return fmt::format("{}{}{:.4g}, limit {:.4g}", text, separator, fault.value, fault.limit);
}

}  // namespace hg::analysis
