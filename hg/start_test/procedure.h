/// The test before the first run of a day: every input of the safety controller is operated once,
/// the power goes from a standing arm, and a person leans on the handle while the brakes hold.
///
/// Plain code from top to bottom that lives through a Station, which is a device with a control
/// cycle, and who operates it. Nothing here keeps real time.
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

/// What whoever operates the device is asked to do.
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
  kLean,  ///< on the handle: push, pull and twist it in all directions
};

/// What the control cycle is wanted to do.
enum class Wish : std::uint8_t {
  kTare,  ///< drives off; faults are reset, and the handle is tared once nobody holds it
  kOff,   ///< drives off
  kArm,   ///< drives on, the arm held where it stands; not after a fault
  kStay,  ///< as it is: whatever happens now, nobody has requested it
};

/// One period.
struct Observation {
  double time_s = 0.0;  ///< on the device's clock
  SafetyInputs safety;
  bool dead_man = false;
  /// Where the brakes sit: motor side, link side without motor encoders; unwrapped. Empty where the
  /// sample was no good.
  VectorM q_m;
  VectorP q_p;              ///< gantry
  VectorM load_m;           ///< that the brakes of the joints carry, Nm or N
  VectorP load_p;           ///< likewise of the gantry
  bool is_powered = false;  ///< the command that answered this sample has the drives on
  Mode mode = Mode::kOff;
  FaultCode fault = FaultCode::kNone;
  Refusal refusal = Refusal::kNone;
};

/// Why no period follows; thrown by Station::live().
struct Ended {
  std::string why;
};

class Station {
 public:
  virtual ~Station() = default;
  /// The next period. Throws Ended.
  virtual Observation live(Wish wish) = 0;
  /// Something to do for whoever operates the device.
  virtual void ask(Act act, const std::string& words) = 0;
  /// What came of it.
  virtual void tell(const std::string& words) = 0;
};

/// One brake.
struct Joint {
  std::string name;
  bool is_slide = false;
  double least_load = 1.0;  ///< from which on it says something to hold it, Nm or N
};

struct Setup {
  StartTestConfig config;
  std::vector<Joint> gantry, manipulator;
  bool is_simulated = false;  ///< its person never lets go of the handle
};

enum class Outcome : std::uint8_t { kPassed, kFailed, kUntested };

std::string_view to_string(Outcome outcome) noexcept;

struct Item {
  std::string name;
  Outcome outcome = Outcome::kUntested;
  std::string found;                       ///< for people
  std::optional<double> answered_s = {};   ///< of an input: after it was asked for
  std::optional<double> power_off_s = {};  ///< of a stop: commanded off after it was seen
  std::optional<double> motion = {};       ///< of a brake, rad or m
  std::optional<double> load = {};         ///< of a brake, the largest, Nm or N
};

/// All items in the order of the test, those that were not reached as kUntested.
std::vector<Item> run(const Setup& setup, Station& station);

/// Nothing has failed, and something was tested.
bool has_passed(const std::vector<Item>& items) noexcept;

}  // namespace hg::start_test
