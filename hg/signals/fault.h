/// Faults are data: they stop the device, are recorded and shown. Codes never change meaning.
#pragma once

#include <cstdint>
#include <string_view>

namespace hg {

enum class FaultCode : std::uint16_t {
  kNone = 0,
  kSensorNotFinite = 100,     ///< a measured value is NaN or infinite
  kSequenceGap = 101,         ///< the device skipped or repeated a sample
  kEmergencyStop = 102,       ///< the safety inputs asked for a stop
  kDeviceSilent = 103,        ///< nothing was heard from a remote device for too long
  kDeviceGone = 104,          ///< a remote device has ended the session
  kWrenchTooLarge = 110,      ///< the user's force or torque exceeds the sensor's range
  kSolverFailed = 200,        ///< the rendering problem was not solved
  kReferenceNotFinite = 201,  ///< the rendering gave NaN or infinity
  kCommandNotFinite = 202,    ///< the control gave NaN or infinity
  kLimitExceeded = 300,       ///< a joint or frame left its limit by more than the tolerance
  kSpeedExceeded = 301,       ///< a joint is faster than its rating allows
  kTrackingLost = 302,        ///< the device is too far from its reference
  kSyncLost = 303,            ///< handle and twin are too far apart
  kLatencyGrew = 304,         ///< commands reach the drives later than the torque loop can bear
};

/// One line for humans, for example "measured value is not finite".
std::string_view to_string(FaultCode code) noexcept;

struct Fault {
  FaultCode code = FaultCode::kNone;
  std::int16_t index = -1;  ///< joint, limit or component it concerns; -1 = none
  double value = 0.0;       ///< the offending value
  double limit = 0.0;       ///< what it was compared with
};

}  // namespace hg
