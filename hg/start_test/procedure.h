/// The test before the first run of a day: every input of the safety controller is operated once,
/// the power goes from a standing arm, and a person leans on the handle while the brakes hold.
///
/// Sequential code that advances through a Station: a device with a control cycle, and its
/// operator. Independent of real time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/types.h"
#include "hg/signals/frames.h"
#include "hg/signals/start_test_config.h"
#include "hg/signals/state.h"

namespace hg::start_test {

/// Action requested from the operator of the device.
enum class Act : std::uint8_t {
  kNone,
  kTurnKeyOn,
  kTurnKeyOff,
  kEnterField,
  kLeaveField,
  kTakeHandle,
  kLetGoOfHandle,
  kPressStop,
  kReleaseStop,  ///< and press the reset button of the safety controller
  kLetGoOfSwitch,
  kHoldSwitch,
  kLean,  ///< push, pull and twist the handle in all directions
};

/// State requested from the control cycle.
enum class Wish : std::uint8_t {
  kTare,  ///< drives off; faults are reset, and the handle is tared once it is released
  kOff,   ///< drives off
  kArm,   ///< drives on, the arm held where it stands; not after a fault
  kStay,  ///< unchanged: no request, whatever happens
};

/// Observed state in one period.
struct Observation {
  double time_s = 0.0;  ///< time on the device's clock
  SafetyInputs safety;
  bool dead_man = false;
  /// Position at the brakes: motor side, link side without motor encoders; unwrapped. Empty where
  /// the sample was invalid.
  VectorM q_m;
  VectorP q_p;              ///< gantry position
  VectorM load_m;           ///< load on the brakes of the joints, Nm or N
  VectorP load_p;           ///< load on the brakes of the gantry, Nm or N
  bool is_powered = false;  ///< the command that answered this sample has the drives on
  Mode mode = Mode::kOff;
  FaultCode fault = FaultCode::kNone;
  Refusal refusal = Refusal::kNone;
};

/// Exception that ends the periods, with the reason; thrown by Station::advance().
struct Ended {
  std::string why;
};

class Station {
 public:
  virtual ~Station() = default;
  /// Advances by one period. Throws Ended.
  virtual Observation advance(Wish wish) = 0;
  /// Asks the operator of the device to act.
  virtual void prompt(Act act, const std::string& words) = 0;
  /// Reports a result.
  virtual void report(const std::string& words) = 0;
};

/// Joint with a brake.
struct Joint {
  std::string name;
  bool is_slide = false;
  double least_load = 1.0;  ///< least load that tests a brake, Nm or N
};

struct Setup {
  StartTestConfig config;
  std::vector<Joint> gantry, manipulator;
  bool is_simulated = false;  ///< the simulated person never releases the handle
};

enum class Outcome : std::uint8_t { kPassed, kFailed, kUntested };

std::string_view to_string(Outcome outcome) noexcept;

struct Item {
  std::string name;
  Outcome outcome = Outcome::kUntested;
  std::string found;                      ///< result as text
  std::optional<double> answered_s = {};  ///< input only: time from request to operation, s
  /// Stop only: time from detection to drives commanded off, s
  std::optional<double> power_off_s = {};
  std::optional<double> motion = {};  ///< brake only: motion, rad or m
  std::optional<double> load = {};    ///< brake only: largest load, Nm or N
};

/// Runs the test; returns all items in its order, those not reached as kUntested.
std::vector<Item> run(const Setup& setup, Station& station);

/// Whether some item was tested and none has failed.
bool has_passed(const std::vector<Item>& items) noexcept;

}  // namespace hg::start_test
