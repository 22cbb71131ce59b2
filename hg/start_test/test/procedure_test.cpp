#include "hg/start_test/procedure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

namespace hg::start_test {
namespace {

constexpr double kPeriod = 0.01;

/// A machine and a person in one: what is requested happens at once, unless a test changes it.
/// Faults stay until they are reset.
class Machine final : public Station {
 public:
  Machine() {
    seen_.q_m = seen_.load_m = VectorM::Zero(1);
    seen_.q_p = seen_.load_p = VectorP::Zero(1);
  }

  Observation advance(Wish wish) override {
    seen_.time_s += kPeriod;
    if (seen_.time_s > ends_s) throw Ended{"remote device is silent"};
    if (pressed_s_ > 0.0 && seen_.time_s >= pressed_s_) {
      seen_.safety.emergency_stop = true;
      pressed_s_ = 0.0;
    }
    step(wish);
    seen_.is_powered = seen_.mode == Mode::kArmed;
    leans_ = leans_ && wish == Wish::kOff;
    seen_.load_m[0] = leans_ ? 5.0 : 0.0;
    seen_.load_p[0] = leans_ ? 50.0 : 0.0;
    Observation now = seen_;
    if (corrupt) corrupt(now);
    return now;
  }

  void prompt(Act act, const std::string& words) override {
    prompts.push_back(words);
    SafetyInputs& safety = seen_.safety;
    leans_ = act == Act::kLean;
    if (act == ignored) return;
    if (act == Act::kTurnKeyOn || act == Act::kTurnKeyOff) {
      safety.override_key = act == Act::kTurnKeyOn;
    }
    if (act == Act::kEnterField || act == Act::kLeaveField) {
      safety.is_field_clear = act == Act::kLeaveField;
    }
    if (act == Act::kTakeHandle || act == Act::kLetGoOfHandle) {
      seen_.dead_man = act == Act::kTakeHandle;
    }
    if (act == Act::kPressStop || act == Act::kReleaseStop) {
      safety.emergency_stop = act == Act::kPressStop && press_delay_s == 0.0;
      if (act == Act::kPressStop) pressed_s_ = seen_.time_s + press_delay_s;
    }
    if (act == Act::kLetGoOfSwitch || act == Act::kHoldSwitch) {
      safety.operator_enable = act == Act::kHoldSwitch;
    }
  }
  void report(const std::string& words) override { reported += words + "\n"; }

  double time_s() const { return seen_.time_s; }

  std::function<void(Observation&)> corrupt;
  std::function<bool(const Observation&)> breaks;  ///< a rule: the gantry does not obey
  bool is_stopped_by_inputs = true;
  double press_delay_s = 0.0;  ///< of the emergency stop
  int armings = 0;
  Act ignored = Act::kNone;
  double ends_s = 1e9;
  std::vector<std::string> prompts;
  std::string reported;

 private:
  void step(Wish wish) {
    const bool is_stop = is_stopped_by_inputs && seen_.safety.emergency_stop;
    const bool is_enabled = !is_stopped_by_inputs || seen_.safety.operator_enable;
    Mode& mode = seen_.mode;
    const bool is_broken = breaks && breaks(seen_);
    if ((is_stop || is_broken) && mode != Mode::kFault) {
      mode = Mode::kFault;
      seen_.fault = is_stop ? FaultCode::kEmergencyStop : FaultCode::kGantryDeviates;
    } else if (mode == Mode::kFault && wish == Wish::kTare && !is_stop && !is_broken) {
      mode = Mode::kReady;
      seen_.fault = FaultCode::kNone;
    } else if (mode == Mode::kArmed && (wish == Wish::kOff || !is_enabled)) {
      mode = Mode::kReady;
    } else if (mode == Mode::kReady && wish == Wish::kArm && is_enabled) {
      mode = Mode::kArmed;
      ++armings;
    }
  }

  Observation seen_{.mode = Mode::kReady};
  bool leans_ = false;
  double pressed_s_ = 0.0;
};

Setup setup() {
  return {.gantry = {{"slide", true, 20.0}}, .manipulator = {{"shoulder", false, 2.0}}};
}

const Item& item(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::ranges::find(items, name, &Item::name);
  EXPECT_NE(found, items.end()) << name;
  return *found;
}

TEST(StartTest, AGoodMachinePassesEveryItem) {
  Machine machine;
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_TRUE(has_passed(items)) << machine.reported;
  EXPECT_EQ(items.size(), 8U);
  for (const Item& each : items) EXPECT_EQ(each.outcome, Outcome::kPassed) << each.name;
  EXPECT_EQ(item(items, "brake shoulder").found, "held 5.0 Nm, moved by 0.00 mrad (allowed: 10)");
  EXPECT_LE(item(items, "emergency stop").power_off_s.value(), kPeriod);
  EXPECT_EQ(item(items, "emergency stop").found, "seen, commanded off 0 ms later, and back");
  EXPECT_EQ(machine.armings, 2);
}

TEST(StartTest, AnInputThatDoesNothingIsNamed) {
  for (const auto& [act, name] : {std::pair{Act::kTurnKeyOn, "override key"},
                                  {Act::kEnterField, "scanner"},
                                  {Act::kTakeHandle, "dead-man switch"},
                                  {Act::kPressStop, "emergency stop"},
                                  {Act::kLetGoOfSwitch, "enabling switch"}}) {
    Machine machine;
    machine.ignored = act;
    const std::vector<Item> items = run(setup(), machine);
    EXPECT_FALSE(has_passed(items));
    EXPECT_EQ(item(items, name).outcome, Outcome::kFailed) << name;
    EXPECT_EQ(item(items, name).found, "nothing came within 30 s");
    EXPECT_EQ(std::ranges::count(items, Outcome::kFailed, &Item::outcome), 1) << machine.reported;
  }
}

TEST(StartTest, AnInputThatDoesNotComeBackFails) {
  Machine machine;
  machine.ignored = Act::kReleaseStop;
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "emergency stop").found, "it did not come back within 30 s");
}

TEST(StartTest, TheWrongInputIsReported) {
  Machine machine;
  machine.corrupt = [](Observation& seen) {
    std::swap(seen.safety.override_key, seen.safety.is_field_clear);
    seen.safety.override_key = !seen.safety.override_key;
    seen.safety.is_field_clear = !seen.safety.is_field_clear;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_NE(machine.reported.find("that was the scanner, not the override key"), std::string::npos);
  EXPECT_EQ(item(items, "override key").found, "not seen, the scanner answered instead");
}

TEST(StartTest, OneOfTwoChannelsIsAFailureOfTheInputThatWasOperated) {
  Machine machine;
  double since_s = -1.0;  // of the disagreement, which shows half a second later
  machine.corrupt = [&](Observation& seen) {
    if (!seen.safety.emergency_stop) since_s = seen.time_s;
    seen.safety.has_disagreement = seen.time_s > since_s + 0.5;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "emergency stop").outcome, Outcome::kFailed);
  EXPECT_NE(item(items, "emergency stop").found.find("only one of its two channels"),
            std::string::npos);
  EXPECT_EQ(item(items, "enabling switch").outcome, Outcome::kPassed);
}

TEST(StartTest, ADisagreementFailsTheRequestedInputEvenIfItEnds) {
  // of an input that is not shown, before and after the requested one
  for (const double at_s : {0.05, 0.5}) {
    Machine machine;
    double since_s = -1.0;
    machine.corrupt = [&](Observation& seen) {
      if (machine.prompts.empty() || machine.prompts.back() != "turn the override key on (30 s)")
        return;
      if (since_s < 0.0) since_s = seen.time_s;
      seen.safety.override_key = seen.time_s > since_s + 0.3;
      seen.safety.has_disagreement = std::abs(seen.time_s - since_s - at_s) < 0.5 * kPeriod;
    };
    const std::vector<Item> items = run(setup(), machine);
    EXPECT_EQ(item(items, "override key").outcome, Outcome::kFailed);
    EXPECT_EQ(std::ranges::count(items, Outcome::kFailed, &Item::outcome), 1) << machine.reported;
  }
}

TEST(StartTest, AnInputThatShowsForAMomentHasNotPassed) {
  Machine machine;
  double since_s = -1.0;
  machine.corrupt = [&](Observation& seen) {
    if (since_s < 0.0 && seen.safety.override_key) since_s = seen.time_s;
    seen.safety.override_key = seen.safety.override_key && seen.time_s < since_s + 0.1;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "override key").found, "it did not stay so for 1 s");
}

TEST(StartTest, ChannelsThatDisagreeAtRestEndTheTest) {
  Machine machine;
  machine.corrupt = [](Observation& seen) { seen.safety.has_disagreement = true; };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(items[0].outcome, Outcome::kFailed);
  EXPECT_EQ(item(items, "emergency stop").found, "not reached");
}

TEST(StartTest, ASupervisorThatDoesNotStopIsDetected) {
  Machine machine;
  machine.is_stopped_by_inputs = false;
  const std::vector<Item> items = run(setup(), machine);
  for (const char* name : {"emergency stop", "enabling switch"}) {
    EXPECT_EQ(item(items, name).found,
              "the drives were still commanded on 50 ms later (mode armed)");
  }
}

TEST(StartTest, AFaultWhileArmedFailsItsItemAndArmingIsAnnounced) {
  Machine machine;
  machine.ignored = Act::kPressStop;
  double armed_s = -1.0;
  machine.breaks = [&](const Observation& seen) {  // for one sample, after 5 s
    if (seen.mode == Mode::kArmed && armed_s < 0.0) armed_s = seen.time_s;
    return armed_s > 0.0 && std::abs(seen.time_s - armed_s - 5.0) < 0.5 * kPeriod;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "emergency stop").found,
            "the drives went off before it was operated: gantry does not move as commanded");
  EXPECT_EQ(item(items, "enabling switch").outcome, Outcome::kPassed);
  EXPECT_EQ(machine.armings, 2);  // one for each item, reported before
}

TEST(StartTest, AStopThatIsPressedTooLateIsReleasedBeforeTheNextItem) {
  Machine machine;
  double armed_s = -1.0;
  machine.breaks = [&](const Observation& seen) {
    if (seen.mode == Mode::kArmed && armed_s < 0.0) armed_s = seen.time_s;
    return armed_s > 0.0 && std::abs(seen.time_s - armed_s - 5.0) < 0.5 * kPeriod;
  };
  machine.press_delay_s = 4.5;
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "emergency stop").outcome, Outcome::kFailed);
  EXPECT_EQ(item(items, "enabling switch").outcome, Outcome::kPassed);
}

TEST(StartTest, AFaultThatComesWithTheDrivesIsNotTriedAgain) {
  Machine machine;
  machine.breaks = [](const Observation& seen) { return seen.mode == Mode::kArmed; };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "emergency stop").found,
            "the device could not be armed for it: gantry does not move as commanded");
  EXPECT_EQ(machine.armings, 3);  // two stops, and the power without them
}

TEST(StartTest, TheWrongStopIsReportedAndTheArmStaysOff) {
  Machine machine;
  bool is_pressed = false;
  machine.corrupt = [&](Observation& seen) {
    is_pressed = is_pressed || seen.safety.emergency_stop;
    if (!seen.safety.emergency_stop) return;
    seen.safety.emergency_stop = false;
    seen.safety.operator_enable = false;
    seen.fault = FaultCode::kNone;
    seen.mode = Mode::kReady;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "emergency stop").found,
            "the drives went off before it was operated: mode ready; the enabling switch answered");
  EXPECT_EQ(machine.armings, 1);
}

// Everything above a bound: nothing leans on the arm, it sags under its drives until it is stopped.
TEST(StartTest, WhatTheDrivesHoldIsNoLoadAndNoMotionOfABrake) {
  Machine machine;
  double q = 0.0;
  machine.corrupt = [&](Observation& seen) {
    seen.load_p[0] = seen.is_powered ? 90.0 : 0.0;
    if (seen.is_powered) q += 1e-4;
    seen.q_p[0] = q;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_GT(q, 0.01);
  EXPECT_EQ(item(items, "brake slide").found,
            "not loaded: it carried 0.0 N at most, 20.0 N for 1 s are needed");
}

TEST(StartTest, ABrakeThatGivesWayIsNamedAndNothingIsArmedAfterIt) {
  Machine machine;
  bool was_armed = false;
  machine.corrupt = [&](Observation& seen) {
    if (seen.load_m[0] > 0.0) seen.q_m[0] = 0.011;
    was_armed = was_armed || seen.is_powered;
  };
  const std::vector<Item> items = run(setup(), machine);
  const Item& brake = item(items, "brake shoulder");
  EXPECT_EQ(brake.outcome, Outcome::kFailed);
  EXPECT_EQ(brake.found, "SLIPS: moved by 11.0 mrad (allowed: 10), from 5.0 Nm on");
  EXPECT_FALSE(was_armed);
  EXPECT_EQ(item(items, "emergency stop").outcome, Outcome::kUntested);
  EXPECT_EQ(item(items, "scanner").outcome, Outcome::kUntested);
  EXPECT_EQ(machine.prompts.size(), 1U);  // to lean
}

TEST(StartTest, ASlippedBrakeEndsAllRequests) {
  Machine machine;
  std::size_t prompts = 0;
  machine.corrupt = [&](Observation& seen) {
    if (prompts == 0 && seen.safety.emergency_stop) prompts = machine.prompts.size();
    if (prompts > 0) seen.q_p[0] = 0.01;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "brake slide").outcome, Outcome::kFailed);
  EXPECT_EQ(machine.prompts.size(), prompts);
  for (const char* name : {"emergency stop", "enabling switch"}) {
    EXPECT_EQ(item(items, name).outcome, Outcome::kUntested);
    EXPECT_EQ(item(items, name).found, "a brake slips");
  }
}

TEST(StartTest, AnUnusableSampleIsNotUsedForBrakes) {
  for (const bool is_empty : {true, false}) {
    Machine machine;
    int count = 0;
    machine.corrupt = [&](Observation& seen) {
      if (++count % 7 != 0) return;
      if (is_empty) {
        seen.q_m.resize(0);
      } else {
        seen.q_p[0] = std::numeric_limits<double>::quiet_NaN();
      }
    };
    EXPECT_TRUE(has_passed(run(setup(), machine))) << machine.reported;
  }
}

TEST(StartTest, ABrakeThatClosesTooLateAfterAStopFails) {
  Machine machine;
  machine.corrupt = [](Observation& seen) {
    if (seen.safety.emergency_stop) seen.q_p[0] = 0.003;
  };
  const std::vector<Item> items = run(setup(), machine);
  EXPECT_EQ(item(items, "brake slide").outcome, Outcome::kFailed);
  EXPECT_EQ(item(items, "brake shoulder").outcome, Outcome::kPassed);
}

TEST(StartTest, ABrakeWithoutLoadFailsAMachineAndIsNotTestedInASimulation) {
  Machine machine;
  auto heavy = setup();
  heavy.manipulator[0].least_load = 6.0;
  const std::vector<Item> items = run(heavy, machine);
  EXPECT_EQ(item(items, "brake shoulder").outcome, Outcome::kFailed);
  heavy.is_simulated = true;
  Machine simulation;
  EXPECT_EQ(item(run(heavy, simulation), "brake shoulder").outcome, Outcome::kUntested);
  EXPECT_NE(machine.reported.find("still without load: shoulder"), std::string::npos);
}

TEST(StartTest, InputsThatADeviceDoesNotHaveAreLeftOut) {
  Machine machine;
  auto bare = setup();
  bare.config.has_input.fill(false);
  const std::vector<Item> items = run(bare, machine);
  EXPECT_EQ(item(items, "emergency stop").outcome, Outcome::kUntested);
  EXPECT_EQ(item(items, "power").outcome, Outcome::kPassed);  // brakes catch the arm at any rate
  for (const std::string& words : machine.prompts) {
    EXPECT_NE(words.find("handle"), std::string::npos) << words;
  }
}

TEST(StartTest, ATestThatEndsEarlyHasFailedWhereverItWas) {
  Machine whole;
  run(setup(), whole);
  ASSERT_GT(whole.time_s(), 10.0);
  for (double end_s = 0.1; end_s < whole.time_s(); end_s += 0.5) {
    Machine machine;
    machine.ends_s = end_s;
    const std::vector<Item> items = run(setup(), machine);
    EXPECT_FALSE(has_passed(items)) << end_s;
    EXPECT_EQ(item(items, "end").found, "the test has ended early: remote device is silent");
  }
}

}  // namespace
}  // namespace hg::start_test
