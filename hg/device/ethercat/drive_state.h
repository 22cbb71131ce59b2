/// The state machine of a drive (CiA 402): what its status word says, and the control word that
/// leads it on.
#pragma once

#include <cstdint>
#include <string_view>

namespace hg::ethercat {

enum class DriveState : std::uint8_t {
  kNotReady,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};

inline DriveState state_of(std::uint16_t status) noexcept {
  switch (status & 0x4FU) {
    case 0x40:
      return DriveState::kSwitchOnDisabled;
    case 0x0F:
      return DriveState::kFaultReactionActive;
    case 0x08:
      return DriveState::kFault;
    default:
      break;
  }
  switch (status & 0x6FU) {
    case 0x21:
      return DriveState::kReadyToSwitchOn;
    case 0x23:
      return DriveState::kSwitchedOn;
    case 0x27:
      return DriveState::kOperationEnabled;
    case 0x07:
      return DriveState::kQuickStopActive;
    default:
      return DriveState::kNotReady;
  }
}

inline std::string_view to_string(DriveState state) noexcept {
  switch (state) {
    case DriveState::kNotReady:
      return "not ready";
    case DriveState::kSwitchOnDisabled:
      return "switch on disabled";
    case DriveState::kReadyToSwitchOn:
      return "ready to switch on";
    case DriveState::kSwitchedOn:
      return "switched on";
    case DriveState::kOperationEnabled:
      return "operation enabled";
    case DriveState::kQuickStopActive:
      return "quick stop active";
    case DriveState::kFaultReactionActive:
      return "fault reaction active";
    case DriveState::kFault:
      return "fault";
  }
  return "";
}

inline bool has_failed(DriveState state) noexcept {
  return state == DriveState::kFault || state == DriveState::kFaultReactionActive;
}

/// Whether its motor has power.
inline bool has_power(DriveState state) noexcept {
  return state == DriveState::kOperationEnabled || state == DriveState::kQuickStopActive ||
         state == DriveState::kFaultReactionActive;
}

/// Whether the drive follows its targets: enabled, and its brake is open (bit 12).
inline bool is_following(std::uint16_t status) noexcept {
  return state_of(status) == DriveState::kOperationEnabled && (status & 0x1000U) != 0;
}

inline constexpr std::uint16_t kDisableVoltage = 0x00;
inline constexpr std::uint16_t kQuickStop = 0x02;  ///< stops from every state without fault
inline constexpr std::uint16_t kShutDown = 0x06;
inline constexpr std::uint16_t kSwitchOn = 0x07;
inline constexpr std::uint16_t kEnableOperation = 0x0F;
inline constexpr std::uint16_t kResetFault = 0x80;

/// The next control word on the way to switched on, brakes closed, or to operation enabled.
inline std::uint16_t control_word(DriveState state, bool enables) noexcept {
  switch (state) {
    case DriveState::kSwitchOnDisabled:
      return kShutDown;
    case DriveState::kReadyToSwitchOn:
      return kSwitchOn;
    case DriveState::kSwitchedOn:
    case DriveState::kOperationEnabled:
      return enables ? kEnableOperation : kSwitchOn;
    case DriveState::kNotReady:
    case DriveState::kQuickStopActive:
    case DriveState::kFaultReactionActive:
    case DriveState::kFault:
      return kDisableVoltage;
  }
  return kDisableVoltage;
}

}  // namespace hg::ethercat
