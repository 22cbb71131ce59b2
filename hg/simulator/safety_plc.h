/// The safety controller of the simulated device: it monitors switches, scanner and speeds
/// on its own and removes the power, whatever the program does.
///
/// Source: [HG] III-D layers 1 and 4, [HANDBOOK] 6.5, 6.8:
///   motion = stop buttons free and operator holds and
///            (user holds or (override key and scanner field clear and speed <= SLS))
/// Every input has two channels, which must agree within the discrepancy time. The active field of
/// the scanner follows from the speed. A trip of the controller is latched until its reset button
/// is pressed (an edge) with the cause gone. Where motion is not permitted the device has the time
/// of a controlled stop before its power is removed; after it, standstill is monitored.
///
/// Models a Pilz PNOZmulti with motion monitoring as far as it interacts with the program; nothing
/// about it is certified. No allocation, noexcept. Copyable.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hg/signals/frames.h"
#include "hg/simulator/hardware_faults.h"

namespace hg::simulator {

/// Set-up data of the safety controller.
struct SafetyPlcConfig {
  double period = 1e-3;           ///< period of step(), s
  double discrepancy = 0.5;       ///< tolerated discrepancy between the channels of an input, s
  double response = 0.01;         ///< response time of the controller to its switches, s
  double scanner_response = 0.1;  ///< [HANDBOOK] 6.8: 67 to 134 ms at 15 Hz, s
  double stop_time = 1.0;         ///< SS1: time until the power is removed, s
  double safe_speed = 0.25;       ///< SLS, m/s; above it the large field is active
  double standstill = 0.1;  ///< SOS: limit for handle and gantry without permitted motion, m/s
};

/// Occupied field of the scanner: the small one is part of the large one.
enum class ScannerField : std::uint8_t { kNone = 0, kLarge = 1, kSmall = 2 };

/// State of one input with two wires.
struct TwoChannels {
  std::array<bool, 2> is_on{};

  static TwoChannels both(bool on) noexcept { return {{on, on}}; }
};

/// Inputs of the controller in one period.
struct SafetyPlcInput {
  TwoChannels stop_free = TwoChannels::both(true);  ///< all stop buttons are out
  TwoChannels operator_enable = TwoChannels::both(true);
  TwoChannels user_hold = TwoChannels::both(false);  ///< dead-man switch at the handle
  TwoChannels override_key = TwoChannels::both(false);
  ScannerField field = ScannerField::kNone;
  double hand_speed = 0.0;    ///< m/s
  double gantry_speed = 0.0;  ///< m/s
  bool drives_on = false;     ///< the program has switched them on
  bool reset = false;
  HardwareFaults faults;  ///< faults of single channels
};

/// Inputs of the formula, after filtering.
struct MotionPermit {
  bool stop_free = true, operator_enable = true, user_hold = false;
  bool override_key = false, is_field_clear = true, is_slow = true;

  bool has_power() const noexcept { return stop_free && operator_enable; }
  bool is_given() const noexcept {
    return has_power() && (user_hold || (override_key && is_field_clear && is_slow));
  }
};

/// Cause of a trip, for displaying the simulation.
enum class PlcTrip : std::uint8_t {
  kNone = 0,
  kStopButton = 1,
  kScanner = 2,
  kSafeSpeed = 3,
  kStandstill = 4,
};

class SafetyPlc {
 public:
  SafetyPlc() : SafetyPlc(SafetyPlcConfig{}) {}
  explicit SafetyPlc(const SafetyPlcConfig& config);

  /// Advances by one period.
  void step(const SafetyPlcInput& input) noexcept;

  /// Signals reported to the program.
  const SafetyInputs& outputs() const noexcept { return outputs_; }
  /// Whether the drives have power; false: safe torque off, the brakes are closed.
  bool has_power() const noexcept { return has_power_; }
  const MotionPermit& permit() const noexcept { return permit_; }
  PlcTrip trip() const noexcept { return trip_; }

 private:
  // An input delayed by some periods.
  struct Delay {
    std::vector<std::uint8_t> values;  // one more than the delay in periods
    std::size_t next = 0;

    std::uint8_t shift(std::uint8_t value) noexcept;
  };

  bool evaluate(int input, TwoChannels channels, const HardwareFaults& faults) noexcept;
  void evaluate_all(const SafetyPlcInput& input) noexcept;
  void watch_motion(const SafetyPlcInput& input) noexcept;
  void trip(PlcTrip cause) noexcept;
  void reset(const SafetyPlcInput& input) noexcept;

  SafetyPlcConfig config_;
  int discrepancy_, stop_time_;  // periods
  std::array<Delay, kSafetyInputs> inputs_;
  Delay field_;
  std::array<int, kSafetyInputs> differing_{};  // periods
  bool differs_now_ = false, has_disagreement_ = false;
  PlcTrip trip_ = PlcTrip::kNone;
  bool was_reset_ = false;                // the button was pressed before
  bool moved_alone_ = false;              // motion was permitted by the key before
  int not_permitted_ = 0, no_power_ = 0;  // periods
  bool has_power_ = true;
  MotionPermit permit_;
  SafetyInputs outputs_;
};

}  // namespace hg::simulator
