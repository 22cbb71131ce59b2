#include "hg/signals/fault.h"

namespace hg {

std::string_view to_string(FaultCode code) noexcept {
  switch (code) {
    case FaultCode::kNone:
      return "no fault";
    case FaultCode::kSensorNotFinite:
      return "measured value is not finite";
    case FaultCode::kSequenceGap:
      return "device skipped or repeated a sample";
    case FaultCode::kEmergencyStop:
      return "emergency stop";
    case FaultCode::kDeviceSilent:
      return "remote device is silent";
    case FaultCode::kDeviceGone:
      return "remote device has ended the session";
    case FaultCode::kWrenchTooLarge:
      return "user wrench exceeds the sensor's range";
    case FaultCode::kSolverFailed:
      return "rendering problem was not solved";
    case FaultCode::kReferenceNotFinite:
      return "rendering gave a value that is not finite";
    case FaultCode::kCommandNotFinite:
      return "control gave a value that is not finite";
    case FaultCode::kLimitExceeded:
      return "position limit exceeded";
    case FaultCode::kSpeedExceeded:
      return "speed rating exceeded";
    case FaultCode::kTrackingLost:
      return "device does not follow its reference";
    case FaultCode::kSyncLost:
      return "handle and twin are apart";
    case FaultCode::kLatencyGrew:
      return "latency of the torque loop has grown beyond what is stable";
  }
  return "unknown fault";
}

}  // namespace hg
