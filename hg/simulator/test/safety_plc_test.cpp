#include "hg/simulator/safety_plc.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hg::simulator {
namespace {

constexpr int kSettle = 300;  // periods: longer than all responses

struct Bench {
  SafetyPlc plc;
  SafetyPlcInput input;

  void run(int periods) {
    for (int k = 0; k < periods; ++k) plc.step(input);
  }
  void reset() {
    input.reset = true;
    run(1);
    input.reset = false;
    run(1);
  }
};

TEST(SafetyPlc, GivesPowerToAMachineWithoutStopRequests) {
  Bench bench;
  EXPECT_TRUE(bench.plc.has_power());
  bench.run(2000);
  EXPECT_TRUE(bench.plc.has_power());
  EXPECT_EQ(bench.plc.trip(), PlcTrip::kNone);
  const SafetyInputs& out = bench.plc.outputs();
  EXPECT_TRUE(out.operator_enable && out.is_field_clear);
  EXPECT_FALSE(out.emergency_stop || out.override_key || out.has_disagreement);
}

// [HANDBOOK] 6.8, with the words of the formula as a second way to say it
TEST(SafetyPlc, PermitsMotionByTheFormulaForAllInputs) {
  for (unsigned bits = 0; bits < 64; ++bits) {
    const bool stop_free = bits & 1U, operator_holds = bits & 2U, user_holds = bits & 4U;
    const bool key = bits & 8U, clear = bits & 16U, slow = bits & 32U;
    Bench bench;
    bench.input = {.stop_free = TwoChannels::both(stop_free),
                   .operator_enable = TwoChannels::both(operator_holds),
                   .user_hold = TwoChannels::both(user_holds),
                   .override_key = TwoChannels::both(key),
                   .field = clear ? ScannerField::kNone : ScannerField::kSmall,
                   .hand_speed = slow ? 0.25 : 0.26};
    bench.run(kSettle);
    bool expected = false;
    if (stop_free && operator_holds && user_holds) expected = true;
    if (stop_free && operator_holds && key && clear && slow) expected = true;
    EXPECT_EQ(bench.plc.permit().is_given(), expected) << bits;
    EXPECT_EQ(bench.plc.outputs().emergency_stop, !stop_free) << bits;
    EXPECT_EQ(bench.plc.outputs().operator_enable, operator_holds) << bits;
    EXPECT_EQ(bench.plc.outputs().override_key, key) << bits;
    EXPECT_EQ(bench.plc.outputs().is_field_clear, clear) << bits;
    EXPECT_TRUE(bench.plc.has_power()) << "a controlled stop has its time";
    bench.run(1000);
    EXPECT_EQ(bench.plc.has_power(), stop_free && operator_holds) << bits;
  }
}

TEST(SafetyPlc, LatchesAStopUntilItsResetWithTheButtonOut) {
  Bench bench;
  bench.input.drives_on = true;
  bench.run(50);
  bench.input.stop_free = TwoChannels::both(false);
  bench.run(10);
  EXPECT_FALSE(bench.plc.outputs().emergency_stop) << "its response takes 10 ms";
  bench.run(1);
  EXPECT_TRUE(bench.plc.outputs().emergency_stop);
  bench.run(999);
  EXPECT_TRUE(bench.plc.has_power());
  bench.run(2);
  EXPECT_FALSE(bench.plc.has_power()) << "whatever the program does";
  bench.reset();
  EXPECT_TRUE(bench.plc.outputs().emergency_stop) << "the button is still pressed";
  bench.input.stop_free = TwoChannels::both(true);
  bench.input.reset = true;  // kept pressed since before: no edge once the button is out
  bench.run(1);
  bench.run(50);
  EXPECT_TRUE(bench.plc.outputs().emergency_stop);
  bench.input.reset = false;
  bench.run(1);
  bench.reset();
  EXPECT_FALSE(bench.plc.outputs().emergency_stop);
  EXPECT_FALSE(bench.plc.has_power()) << "not to drives that the program has left on";
  bench.input.drives_on = false;
  bench.run(1);
  EXPECT_TRUE(bench.plc.has_power());
}

TEST(SafetyPlc, AShortPressIsEnough) {
  Bench bench;
  bench.input.stop_free = TwoChannels::both(false);
  bench.run(1);
  bench.input.stop_free = TwoChannels::both(true);
  bench.run(50);
  EXPECT_TRUE(bench.plc.outputs().emergency_stop);
}

TEST(SafetyPlc, ChannelsMayDifferForHalfASecondAndCountAsOffMeanwhile) {
  for (const int channel : {0, 1}) {
    Bench bench;
    bench.run(20);
    bench.input.operator_enable.is_on[channel] = false;
    bench.run(11 + 499);
    EXPECT_FALSE(bench.plc.outputs().operator_enable);
    EXPECT_FALSE(bench.plc.outputs().has_disagreement);
    bench.run(1);
    EXPECT_TRUE(bench.plc.outputs().has_disagreement);
    bench.input.operator_enable = TwoChannels::both(true);
    bench.run(2000);
    EXPECT_TRUE(bench.plc.outputs().has_disagreement) << "latched";
    EXPECT_FALSE(bench.plc.has_power());
    bench.reset();
    EXPECT_FALSE(bench.plc.outputs().has_disagreement);
    EXPECT_TRUE(bench.plc.has_power());
  }
  Bench brief;
  for (int k = 0; k < 5; ++k) {
    brief.input.operator_enable.is_on[0] = false;
    brief.run(400);
    brief.input.operator_enable.is_on[0] = true;
    brief.run(20);
  }
  EXPECT_FALSE(brief.plc.outputs().has_disagreement);
}

TEST(SafetyPlc, IsAsSlowAsConfiguredAtEveryRate) {
  for (const double period : {1e-3, 1e-4}) {
    Bench bench;
    bench.plc = SafetyPlc({.period = period, .scanner_response = 0.3});
    bench.run(100);
    bench.input.field = ScannerField::kSmall;
    const int periods = static_cast<int>(std::lround(0.3 / period));
    bench.run(periods);
    EXPECT_TRUE(bench.plc.outputs().is_field_clear) << period;
    bench.run(1);
    EXPECT_FALSE(bench.plc.outputs().is_field_clear) << period;
  }
}

TEST(SafetyPlc, ABrokenWireStopsAndAStuckOneIsFoundWhenTheSwitchIsUsed) {
  Bench broken;
  broken.run(20);
  broken.input.faults.open_channels = 1U << 0;  // stop buttons
  broken.run(11);
  EXPECT_TRUE(broken.plc.outputs().emergency_stop);
  EXPECT_FALSE(broken.plc.outputs().has_disagreement);
  broken.run(500);
  EXPECT_TRUE(broken.plc.outputs().has_disagreement);
  broken.reset();
  EXPECT_TRUE(broken.plc.outputs().has_disagreement) << "the wire is still broken";

  Bench stuck;
  stuck.input.faults.stuck_channels = 1U << 1;  // operator's enabling switch
  stuck.run(1000);
  EXPECT_TRUE(stuck.plc.outputs().operator_enable);
  EXPECT_FALSE(stuck.plc.outputs().has_disagreement);
  stuck.input.operator_enable = TwoChannels::both(false);
  stuck.run(11);
  EXPECT_FALSE(stuck.plc.outputs().operator_enable);
  stuck.run(500);
  EXPECT_TRUE(stuck.plc.outputs().has_disagreement);
}

// with the handle not held, the key turned, slowly
Bench alone() {
  Bench bench;
  bench.input.override_key = TwoChannels::both(true);
  bench.input.drives_on = true;
  bench.input.hand_speed = 0.2;
  bench.run(kSettle);
  EXPECT_TRUE(bench.plc.permit().is_given());
  return bench;
}

TEST(SafetyPlc, WithoutAHandItTripsBeyondTheSafeSpeedOfHandleOrGantry) {
  for (const bool is_gantry : {false, true}) {
    Bench bench = alone();
    (is_gantry ? bench.input.gantry_speed : bench.input.hand_speed) = 0.251;
    bench.run(1);
    EXPECT_EQ(bench.plc.trip(), PlcTrip::kSafeSpeed);
    EXPECT_TRUE(bench.plc.outputs().emergency_stop);
    bench.input.gantry_speed = bench.input.hand_speed = 0.0;
    bench.run(1001);
    EXPECT_FALSE(bench.plc.has_power());
  }
  Bench held = alone();
  held.input.user_hold = TwoChannels::both(true);
  held.run(kSettle);
  held.input.hand_speed = 1.4;
  held.run(kSettle);
  EXPECT_EQ(held.plc.trip(), PlcTrip::kNone);
}

TEST(SafetyPlc, WithoutAHandItTripsOnEntryWhenFastInTheLargeField) {
  Bench bench = alone();
  bench.input.field = ScannerField::kLarge;
  bench.run(kSettle);
  EXPECT_EQ(bench.plc.trip(), PlcTrip::kNone) << "slow: only the small field counts";
  EXPECT_TRUE(bench.plc.outputs().is_field_clear);
  bench.input.field = ScannerField::kSmall;
  bench.run(100);
  EXPECT_TRUE(bench.plc.outputs().is_field_clear) << "the scanner needs 100 ms";
  bench.run(1);
  EXPECT_FALSE(bench.plc.outputs().is_field_clear);
  EXPECT_EQ(bench.plc.trip(), PlcTrip::kScanner);
  bench.input.field = ScannerField::kNone;
  bench.run(kSettle);
  EXPECT_FALSE(bench.plc.outputs().is_field_clear) << "latched";
  bench.reset();
  EXPECT_TRUE(bench.plc.outputs().is_field_clear);

  Bench fast;
  fast.input.user_hold = TwoChannels::both(true);
  fast.input.hand_speed = 1.0;
  fast.input.field = ScannerField::kLarge;
  fast.run(kSettle);
  EXPECT_FALSE(fast.plc.outputs().is_field_clear);
  EXPECT_EQ(fast.plc.trip(), PlcTrip::kNone) << "the handle is held";
}

TEST(SafetyPlc, ADeviceThatDoesNotStopWhenTheHandLetsGoLosesItsPower) {
  Bench bench;
  bench.input.drives_on = true;
  bench.input.user_hold = TwoChannels::both(true);
  bench.input.hand_speed = 1.0;
  bench.run(100);
  bench.input.user_hold = TwoChannels::both(false);
  bench.run(900);
  EXPECT_EQ(bench.plc.trip(), PlcTrip::kNone);
  Bench stops = bench;
  stops.input.hand_speed = 0.0;
  stops.run(5000);
  EXPECT_EQ(stops.plc.trip(), PlcTrip::kNone);
  bench.run(200);
  EXPECT_EQ(bench.plc.trip(), PlcTrip::kStandstill);
  bench.run(1001);
  EXPECT_FALSE(bench.plc.has_power());
}

}  // namespace
}  // namespace hg::simulator
