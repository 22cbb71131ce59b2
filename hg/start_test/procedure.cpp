#include "hg/start_test/procedure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "hg/core/index.h"
#include "hg/start_test/brake_watch.h"

namespace hg::start_test {
namespace {

constexpr double kPatience = 30.0;  // s for one action of a person
constexpr double kHold = 1.0;       // s; longer than channels may usually differ (0.5 s)
constexpr double kRest = 1.5;       // s at the start, 0.5 s of it for a tare
constexpr double kWarning = 3.0;    // s before the drives switch on
constexpr double kArming = 20.0;    // s
constexpr double kReaction = 0.05;  // s from a stop to drives that are commanded off
constexpr double kLeaning = 90.0;   // s for all brakes
constexpr double kReminder = 5.0;   // s between two lists of brakes still to be loaded
constexpr const char* kReleaseStop =
    "pull the emergency stop out, and press the reset button of the safety controller";
constexpr const char* kSlips = "a brake slips";
constexpr const char* kOneWire = "only one of its two channels did: a wire or contact is broken";

/// One input: how it looks in a sample, and how it is operated.
struct Operation {
  SafetyInput input;
  Act act, undo;
  const char* words;       ///< instruction for `act`
  const char* undo_words;  ///< instruction for `undo`
};

constexpr Operation kOperations[] = {
    {SafetyInput::kOverrideKey, Act::kTurnKeyOn, Act::kTurnKeyOff, "turn the override key on",
     "turn the override key off"},
    {SafetyInput::kScanner, Act::kEnterField, Act::kLeaveField,
     "step into the field of the scanner and stay there",
     "leave the field, and press the reset button if there is one"},
    {SafetyInput::kDeadMan, Act::kTakeHandle, Act::kLetGoOfHandle,
     "take the handle and hold it, so that its dead-man switch closes", "let go of the handle"},
    {SafetyInput::kEmergencyStop, Act::kPressStop, Act::kReleaseStop, "press the emergency stop",
     kReleaseStop},
    {SafetyInput::kEnablingSwitch, Act::kLetGoOfSwitch, Act::kHoldSwitch,
     "let go of the enabling switch until the next request", "hold the enabling switch again"},
};

// whether the input is in the state after Operation::act
bool is_operated(SafetyInput input, const Observation& seen) noexcept {
  switch (input) {
    case SafetyInput::kOverrideKey:
      return seen.safety.override_key;
    case SafetyInput::kScanner:
      return !seen.safety.is_field_clear;
    case SafetyInput::kDeadMan:
      return seen.dead_man;
    case SafetyInput::kEmergencyStop:
      return seen.safety.emergency_stop;
    case SafetyInput::kEnablingSwitch:
      return !seen.safety.operator_enable;
  }
  return false;
}

bool stops_drives(SafetyInput input) noexcept {
  return input == SafetyInput::kEmergencyStop || input == SafetyInput::kEnablingSwitch;
}

class Procedure {
 public:
  Procedure(const Setup& setup, Station& station)
      : setup_(setup), station_(station), brakes_(setup) {}

  std::vector<Item> run() {
    items_.push_back({.name = "inputs at rest", .found = "not reached"});
    for (const Operation& operation : kOperations) {
      items_.push_back({.name = std::string(to_string(operation.input)), .found = "not reached"});
    }
    try {
      if (rest(items_[0])) {
        lean();
        std::size_t i = 1;
        for (const Operation& operation : kOperations) test(operation, items_[i++]);
        if (!was_stopped_ && !has_slipped_) remove_power();
      }
    } catch (const Ended& ended) {
      items_.push_back({.name = "end"});
      fail(items_.back(), fmt::format("the test has ended early: {}", ended.why));
    }
    for (Item& brake : brakes_.items()) {
      station_.report(fmt::format("{:<18} {}", brake.name, brake.found));
      items_.push_back(std::move(brake));
    }
    return std::move(items_);
  }

 private:
  using Seen = std::function<bool()>;

  bool has(SafetyInput input) const noexcept { return setup_.config.has_input[index(input)]; }

  void advance(Wish wish) {
    seen_ = station_.advance(wish);
    if (seen_.is_powered) powered_ = seen_;
    has_disagreed_ = has_disagreed_ || seen_.safety.has_disagreement;
    if (!watches_) return;
    for (const std::string& name : brakes_.look(seen_)) {
      has_slipped_ = true;
      station_.report(fmt::format("brake {:<12} SLIPS: let go of the handle and keep clear", name));
    }
  }

  // waits for a condition; false: time-out
  bool wait(Wish wish, double at_most_s, const Seen& until) {
    const double begin_s = seen_.time_s;
    while (!until()) {
      if (seen_.time_s - begin_s > at_most_s) return false;
      advance(wish);
    }
    return true;
  }
  void stay(Wish wish, double seconds) {
    wait(wish, seconds, [] { return false; });
  }

  // Waits until the requested input is operated; other inputs that respond instead are reported by
  // name. Returns why it failed; empty: it succeeded.
  std::string wait_for(SafetyInput wanted) {
    const Observation before = seen_;
    const bool is_armed = stops_drives(wanted);
    const auto is_lost = [&] { return is_armed && seen_.mode != Mode::kArmed; };
    std::array<bool, kSafetyInputCount> is_named{};
    std::string wrong;
    wait(is_armed ? Wish::kStay : Wish::kOff, kPatience, [&] {
      for (std::size_t i = 0; i < kSafetyInputCount; ++i) {
        const auto other = static_cast<SafetyInput>(i);
        const bool has_changed = is_operated(other, seen_) != is_operated(other, before);
        if (other == wanted || !has_changed || is_named[i]) continue;
        is_named[i] = true;
        wrong = to_string(other);
        station_.report(fmt::format("that was the {}, not the {}", wrong, to_string(wanted)));
      }
      return is_operated(wanted, seen_) || has_disagreed_ || is_lost();
    });
    if (is_operated(wanted, seen_)) return {};
    if (is_lost() && !has_disagreed_) {
      return fmt::format("the drives went off before it was operated: {}{}", why_off(),
                         wrong.empty() ? "" : fmt::format("; the {} answered", wrong));
    }
    if (!wrong.empty()) return fmt::format("not seen, the {} answered instead", wrong);
    return has_disagreed_ ? kOneWire : fmt::format("nothing came within {:g} s", kPatience);
  }

  std::string why_off() const {
    return seen_.fault == FaultCode::kNone ? fmt::format("mode {}", to_string(seen_.mode))
                                           : std::string(to_string(seen_.fault));
  }

  void prompt(Act act, const std::string& words, double at_most_s = kPatience) {
    station_.prompt(act, fmt::format("{} ({:g} s)", words, at_most_s));
  }

  bool fail(Item& item, std::string why) {
    item.outcome = Outcome::kFailed;
    item.found = std::move(why);
    station_.report(fmt::format("{:<18} FAILED: {}", item.name, item.found));
    return false;
  }
  void pass(Item& item, std::string found) {
    item.outcome = Outcome::kPassed;
    item.found = std::move(found);
    station_.report(fmt::format("{:<18} {}", item.name, item.found));
  }
  void leave_out(Item& item, std::string why) {
    item.found = std::move(why);
    station_.report(fmt::format("{:<18} not tested: {}", item.name, item.found));
  }

  // undo instruction for the first input that is not in its rest state; empty: none
  std::string not_at_rest() const {
    for (const Operation& operation : kOperations) {
      // the enabling switch is checked before arming
      if (!has(operation.input) || operation.input == SafetyInput::kEnablingSwitch) continue;
      if (operation.input == SafetyInput::kDeadMan && setup_.is_simulated) continue;
      if (is_operated(operation.input, seen_)) return operation.undo_words;
    }
    return seen_.safety.has_disagreement ? "press the reset button of the safety controller" : "";
  }

  std::string broken_input() const {
    if (seen_.safety.emergency_stop) return "those of the emergency stop";
    if (!seen_.safety.operator_enable) return "those of the enabling switch";
    return "those of the override key or of the dead-man switch";
  }

  bool rest(Item& item) {
    advance(Wish::kTare);
    watch_brakes();
    stay(Wish::kTare, kRest);
    watches_ = false;
    if (has_slipped_) {
      leave_out(item, kSlips);
      return false;
    }
    std::string shown;
    const bool is_at_rest = wait(Wish::kTare, kPatience, [&] {
      const std::string words = not_at_rest();
      if (!words.empty() && words != shown) {
        const bool is_stop = seen_.safety.emergency_stop || seen_.safety.has_disagreement;
        prompt(is_stop ? Act::kReleaseStop : Act::kNone, words);
      }
      shown = words;
      return words.empty();
    });
    if (!is_at_rest && seen_.safety.has_disagreement) {
      return fail(item, "two channels of an input disagree, while not operated: " + broken_input());
    }
    if (!is_at_rest) return fail(item, "still to do: " + shown);
    pass(item, "in their rest states");
    return true;
  }

  void test(const Operation& operation, Item& item) {
    if (!has(operation.input)) {
      item.found = "this device has none (start_test.inputs of device.yaml)";
      return;
    }
    if (has_slipped_) {
      leave_out(item, kSlips);
      return;
    }
    if (operation.input == SafetyInput::kDeadMan && setup_.is_simulated) {
      leave_out(item, "a simulated hand holds for good");
      return;
    }
    operate(operation, item);
    watches_ = false;
  }

  // A disagreement of channels at any time fails it permanently, even if it disappears.
  void operate(const Operation& operation, Item& item) {
    if (seen_.safety.has_disagreement) {
      fail(item, "two channels of an input disagree before the request");
      return;
    }
    const bool is_stop = stops_drives(operation.input);
    if (is_stop && !arm(item)) return;
    has_disagreed_ = false;
    prompt(operation.act, operation.words);
    const double asked_s = seen_.time_s;
    const std::string why_not = wait_for(operation.input);
    bool is_good = why_not.empty();
    if (is_good) {
      item.answered_s = seen_.time_s - asked_s;
      if (is_stop) is_good = check_stop(item);
    } else {
      fail(item, why_not);
      stay(Wish::kOff, kHold);
      if (!has_disagreed_) return;
    }
    stay(Wish::kOff, kHold);
    watches_ = false;
    if (is_good && has_disagreed_) is_good = fail(item, kOneWire);
    if (is_good && !is_operated(operation.input, seen_)) {
      is_good = fail(item, fmt::format("it did not stay so for {:g} s", kHold));
    }
    if (has_slipped_) {
      if (is_good) leave_out(item, kSlips);
      return;
    }
    prompt(operation.undo, has_disagreed_ && operation.undo != Act::kReleaseStop
                               ? fmt::format("{}, and press the reset button", operation.undo_words)
                               : std::string(operation.undo_words));
    const auto is_released = [&] {
      return !is_operated(operation.input, seen_) && !seen_.safety.has_disagreement;
    };
    const bool is_back = wait(Wish::kOff, kPatience, is_released);
    if (is_back) stay(Wish::kOff, kHold);
    if (!is_good) return;
    if (!is_back || !is_released()) {
      fail(item,
           fmt::format("it did not come back within {:g} s{}", kPatience,
                       seen_.safety.has_disagreement ? ", or one of its channels did not" : ""));
      return;
    }
    if (has_disagreed_) {
      fail(item, kOneWire);
      return;
    }
    pass(item, is_stop ? fmt::format("seen, commanded off {:.0f} ms later, and back",
                                     1e3 * item.power_off_s.value_or(0.0))
                       : "seen, and back");
  }

  // The stop itself: the supervisor removes the power, which is not requested during that time, and
  // the brakes take over the load of the drives.
  bool check_stop(Item& item) {
    const double seen_s = seen_.time_s;
    brakes_.begin(powered_, seen_s);
    watches_ = was_stopped_ = true;
    const bool is_off = wait(Wish::kStay, kReaction, [&] { return !seen_.is_powered; });
    if (!is_off) {
      return fail(item, fmt::format("the drives were still commanded on {:g} ms later (mode {})",
                                    1e3 * kReaction, to_string(seen_.mode)));
    }
    item.power_off_s = seen_.time_s - seen_s;
    return true;
  }

  void watch_brakes() {
    brakes_.begin(seen_, seen_.time_s);
    watches_ = true;
  }

  bool arm(Item& item) {
    if (seen_.safety.emergency_stop) {  // pressed too late for the item before, or still
      prompt(Act::kReleaseStop, kReleaseStop);
      if (!wait(Wish::kOff, kPatience, [&] { return !seen_.safety.emergency_stop; })) {
        return fail(item, "the emergency stop was not released, so that nothing could be armed");
      }
    }
    if (!seen_.safety.operator_enable) {
      prompt(Act::kHoldSwitch, "hold the enabling switch");
      if (!wait(Wish::kOff, kPatience, [&] { return seen_.safety.operator_enable; })) {
        return fail(item, "the enabling switch was not held, so that nothing could be armed");
      }
    }
    station_.report(fmt::format(
        "in {:g} s the drives come on and hold the arm where it stands: keep clear", kWarning));
    stay(Wish::kOff, kWarning);
    // the only reset of this item: any later fault of the standing arm ends it
    wait(Wish::kTare, kArming, [&] { return seen_.mode != Mode::kFault; });
    Refusal refusal = Refusal::kNone;
    if (seen_.mode != Mode::kFault) {
      wait(Wish::kArm, kArming, [&] {
        if (seen_.refusal != Refusal::kNone) refusal = seen_.refusal;
        return seen_.mode == Mode::kArmed || seen_.mode == Mode::kFault;
      });
    }
    if (seen_.mode == Mode::kArmed) {
      const bool is_lost = wait(Wish::kStay, kHold, [&] { return seen_.mode != Mode::kArmed; });
      if (!is_lost) return true;
    }
    const std::string why = seen_.fault == FaultCode::kNone && refusal != Refusal::kNone
                                ? std::string(to_string(refusal))
                                : why_off();
    advance(Wish::kOff);
    return fail(item, fmt::format("the device could not be armed for it: {}", why));
  }

  // A device without stop inputs: the program removes its power.
  void remove_power() {
    Item power = {.name = "power", .found = ""};
    if (arm(power)) {
      watch_brakes();
      stay(Wish::kOff, kHold);
      watches_ = false;
      pass(power, "taken from the standing arm");
    }
    items_.push_back(std::move(power));
  }

  void lean() {
    advance(Wish::kOff);
    prompt(Act::kLean,
           "push, pull and twist the handle hard, in all directions; the drives are off", kLeaning);
    watch_brakes();
    double reported_s = seen_.time_s;
    wait(Wish::kOff, kLeaning, [&] {
      const std::vector<std::string> left = brakes_.without_load();
      if (seen_.time_s - reported_s > kReminder && !left.empty()) {
        reported_s = seen_.time_s;
        station_.report(fmt::format("still without load: {}", fmt::join(left, ", ")));
      }
      return left.empty() || has_slipped_;
    });
    watches_ = false;
    if (!has_slipped_) prompt(Act::kLetGoOfHandle, "let go of the handle");
    stay(Wish::kOff, kHold);
  }

  const Setup& setup_;
  Station& station_;
  BrakeWatch brakes_;
  Observation seen_, powered_;  // the last observation; the last with the drives on
  std::vector<Item> items_;
  bool watches_ = false;        // brakes are monitored
  bool was_stopped_ = false;    // by an input, with power on
  bool has_slipped_ = false;    // a brake has slipped
  bool has_disagreed_ = false;  // channels of an input have disagreed since it was requested
};

}  // namespace

std::string_view to_string(Outcome outcome) noexcept {
  switch (outcome) {
    case Outcome::kPassed:
      return "passed";
    case Outcome::kFailed:
      return "failed";
    case Outcome::kUntested:
      return "not tested";
  }
  return "not tested";
}

std::vector<Item> run(const Setup& setup, Station& station) {
  return Procedure(setup, station).run();
}

bool has_passed(const std::vector<Item>& items) noexcept {
  const auto is = [](Outcome outcome) {
    return [outcome](const Item& item) { return item.outcome == outcome; };
  };
  return std::ranges::none_of(items, is(Outcome::kFailed)) &&
         std::ranges::any_of(items, is(Outcome::kPassed));
}

}  // namespace hg::start_test
