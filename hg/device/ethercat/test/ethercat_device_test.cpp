#include "hg/device/ethercat/ethercat_device.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/test/message_of.h"
#include "hg/device/ethercat/bus_check.h"
#include "hg/device/ethercat/bus_registers.h"
#include "hg/device/ethercat/test/fake_bus.h"

namespace hg::ethercat {
namespace {

constexpr double kTorque = 5.0;  // Nm
constexpr int kSilence = 10;     // exchanges

class Bench {
 public:
  FakeSegment segment;
  SensorFrame sensors;
  double speed = 0.0;  ///< that commands with drives on have, rad/s

  void connect() {
    device_ = std::make_unique<EthercatDevice>(EthercatConfig{.interface_name = "fake0",
                                                              .machine = segment.machine,
                                                              .n_m = static_cast<int>(kDrives),
                                                              .is_fast = true},
                                               std::make_unique<FakeBus>(segment));
    device_->read(sensors);
  }
  std::string refusal() {
    return message_of([&] { connect(); });
  }
  EthercatDevice& device() { return *device_; }
  FaultCode fault() const { return sensors.driver_fault; }

  /// One period with drives on or off, and the reset button.
  void cycle(bool is_on, bool is_reset = false, double torque = kTorque) {
    CommandFrame command;
    command.enable = is_on;
    command.q_m = VectorM::Zero(kDrives);
    command.dq_m = VectorM::Constant(kDrives, speed);
    command.tau_m = VectorM::Constant(kDrives, torque);
    command.panel.reset = is_reset;
    if (!is_on) disable(command);
    device_->write(command);
    device_->read(sensors);
  }
  void cycle(int count, bool is_on) {
    for (int i = 0; i < count; ++i) cycle(is_on);
  }
  /// Until both drives follow.
  void connect_and_enable() {
    connect();
    cycle(10, true);
    for (const FakeDrive& drive : segment.drives) {
      ASSERT_EQ(drive.control, kEnableOperation);
      ASSERT_EQ(drive.target, kTorque);
    }
    ASSERT_TRUE(segment.opens_brakes);
    ASSERT_EQ(fault(), FaultCode::kNone);
  }
  bool any_moves() const {
    return segment.drives[0].state() == DriveState::kOperationEnabled ||
           segment.drives[1].state() == DriveState::kOperationEnabled;
  }

 private:
  std::unique_ptr<EthercatDevice> device_;
};

void expect_words(const std::string& text, const std::string& words) {
  EXPECT_NE(text.find(words), std::string::npos) << "'" << text << "' without '" << words << "'";
}

// ---- late: this computer, or the bus ----

TEST(EthercatDevice, AnExchangeThatTookLongerThanItsPatienceIsLateHere) {
  constexpr auto kPause = std::chrono::milliseconds(20);
  Bench bench;
  bench.connect_and_enable();
  const LinkCounts before = bench.device().counts();
  bench.segment.on_exchange = [&] { std::this_thread::sleep_for(kPause); };
  bench.cycle(true);
  EXPECT_GE(bench.device().late_ns(), 18'000'000);  // but for the millisecond of its patience
  EXPECT_EQ(bench.device().counts().lost, before.lost);
}

TEST(EthercatDevice, AFrameThatDoesNotComeInTimeIsNotLateHere) {
  constexpr auto kPause = std::chrono::milliseconds(500);
  Bench bench;
  bench.segment.machine.answer_s = 0.6;
  bench.connect_and_enable();
  const LinkCounts before = bench.device().counts();
  bench.segment.on_exchange = [&] { std::this_thread::sleep_for(kPause); };
  bench.segment.answers = false;
  bench.cycle(true);
  EXPECT_LT(bench.device().late_ns(), 400'000'000);
  EXPECT_EQ(bench.device().counts().lost, before.lost + 1);
}

// ---- silence ----

TEST(EthercatDevice, WithoutAnswersKeepsCommandingDrivesToStop) {
  Bench bench;
  bench.connect_and_enable();
  bench.segment.answers = false;
  bench.cycle(kSilence, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDeviceSilent);
  expect_words(bench.device().farewell(), "fake0: no answer to 10 frames in a row");
  for (int i = 0; i < 50; ++i) {
    const int before = bench.segment.exchanges;
    bench.cycle(true);
    EXPECT_EQ(bench.segment.exchanges, before + 1);
    for (const FakeDrive& drive : bench.segment.drives) {
      EXPECT_EQ(drive.control, kQuickStop);
      EXPECT_EQ(drive.target, 0);
    }
    EXPECT_FALSE(bench.segment.opens_brakes);
  }
  for (const FakeDrive& drive : bench.segment.drives) {
    EXPECT_EQ(drive.state(), DriveState::kSwitchOnDisabled);
  }
  // for good
  bench.segment.answers = true;
  bench.cycle(5, true);
  bench.cycle(false, true);
  bench.cycle(20, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDeviceSilent);
  EXPECT_FALSE(bench.any_moves());
}

TEST(EthercatDevice, WithoutAnswersGivesDrivesTimeToStopAtItsEnd) {
  Bench bench;
  bench.connect_and_enable();
  bench.segment.answers = false;
  bench.cycle(kSilence, true);
  int quick_stops = 0;
  bench.segment.on_exchange = [&] {
    quick_stops += bench.segment.drives[0].control == kQuickStop ? 1 : 0;
  };
  bench.device().close(FaultCode::kDeviceSilent);
  EXPECT_GE(quick_stops, 100);
  EXPECT_EQ(bench.segment.drives[0].control, kDisableVoltage);
}

TEST(EthercatDevice, AFewLostFramesAreNoSilence) {
  Bench bench;
  bench.connect_and_enable();
  bench.segment.answers = false;
  bench.cycle(kSilence - 1, true);
  bench.segment.answers = true;
  bench.cycle(kSilence, true);
  EXPECT_EQ(bench.fault(), FaultCode::kNone);
  EXPECT_TRUE(bench.any_moves());
}

TEST(EthercatDevice, StopsDrivesBeforeItSwitchesThemOff) {
  Bench bench;
  bench.connect_and_enable();
  std::vector<std::uint16_t> controls;
  bench.segment.on_exchange = [&] { controls.push_back(bench.segment.drives[0].control); };
  bench.device().close(FaultCode::kNone);
  ASSERT_GE(controls.size(), 3u);
  EXPECT_EQ(controls.front(), kQuickStop);
  EXPECT_EQ(controls.back(), kDisableVoltage);
  EXPECT_EQ(bench.segment.states[0], kPreOp);
}

// ---- reset ----

// Both drives on, the first one fails for good or not, and the reset button is pressed.
void fail_and_reset(Bench& bench, bool stays_broken) {
  bench.connect_and_enable();
  bench.segment.drives[0].stays_broken = stays_broken;
  bench.segment.drives[0].fail();
  bench.cycle(2, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
  bench.cycle(5, false);
  bench.cycle(false, true);
}

TEST(EthercatDevice, RecoversByAResetAndMovesAgain) {
  Bench bench;
  fail_and_reset(bench, false);
  bench.cycle(5, false);
  EXPECT_EQ(bench.fault(), FaultCode::kNone);
  EXPECT_EQ(bench.device().farewell(), "");
  bench.cycle(10, true);
  EXPECT_TRUE(bench.any_moves());
}

TEST(EthercatDevice, DoesNotMoveWhileItRecovers) {
  Bench bench;
  bench.connect_and_enable();
  bench.segment.missing = 1;
  bench.cycle(3, true);
  EXPECT_EQ(bench.sensors.bus_errors, 1u);
  expect_words(bench.device().farewell(), "working counter 8 of 9");
  bench.cycle(5, false);
  EXPECT_FALSE(bench.any_moves());
  bench.cycle(false, true);
  for (int i = 0; i < 100; ++i) {
    bench.cycle(true);
    ASSERT_FALSE(bench.any_moves());
    ASSERT_EQ(bench.segment.drives[0].target, 0);
  }
  bench.segment.missing = 0;
  bench.cycle(10, true);
  EXPECT_TRUE(bench.any_moves());
  EXPECT_EQ(bench.device().farewell(), "");
}

TEST(EthercatDevice, ADriveThatFailsWhileItRecoversEndsThat) {
  Bench bench;
  fail_and_reset(bench, true);
  bench.cycle(5, false);
  expect_words(bench.device().farewell(), "slave 1 (m1), address 0x1000: the drive has failed");
  bench.segment.drives[1].fail();
  bench.cycle(false);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
  expect_words(bench.device().farewell(), "slave 2 (m2), address 0x1001: the drive has failed");
  for (int i = 0; i < 20; ++i) {
    bench.cycle(true);
    EXPECT_EQ(bench.segment.drives[0].control, kDisableVoltage);  // no more resets
  }
}

TEST(EthercatDevice, ADriveThatFailsAgainAfterItsResetEndsTheRecovery) {
  Bench bench;
  bench.segment.missing = 0;
  fail_and_reset(bench, false);
  bench.segment.missing = 1;  // the recovery is not at its end
  bench.cycle(4, false);
  EXPECT_EQ(bench.segment.drives[0].state(), DriveState::kSwitchedOn);
  bench.segment.drives[0].fail();
  bench.cycle(2, false);
  bench.segment.missing = 0;
  bench.cycle(20, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
  EXPECT_EQ(bench.segment.drives[0].state(), DriveState::kFault);
}

TEST(EthercatDevice, ASlaveThatIsLostWhileItRecoversEndsThat) {
  Bench bench;
  fail_and_reset(bench, true);
  bench.cycle(5, false);
  bench.segment.states[1] = kSafeOp;
  bench.cycle(false);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
  expect_words(bench.device().farewell(), "slave 2 (m2), address 0x1001: has left OP: SAFE-OP");
}

TEST(EthercatDevice, SilenceWhileItRecoversEndsThat) {
  Bench bench;
  fail_and_reset(bench, true);
  bench.segment.answers = false;
  bench.cycle(kSilence, false);
  EXPECT_EQ(bench.fault(), FaultCode::kDeviceSilent);
  bench.cycle(false);
  EXPECT_EQ(bench.segment.drives[1].control, kQuickStop);
}

TEST(EthercatDevice, RecoversForHalfASecondAlsoWhereFramesAreLost) {
  Bench bench;
  fail_and_reset(bench, true);
  for (int i = 0; i < 500; ++i) {
    bench.segment.answers = i % 2 == 0;
    bench.cycle(false);
  }
  for (int i = 0; i < 10; ++i) {
    bench.cycle(false);
    EXPECT_EQ(bench.segment.drives[0].control, kDisableVoltage);
  }
  bench.cycle(20, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
}

TEST(EthercatDevice, AResetWhileDrivesAreOnIsIgnored) {
  Bench bench;
  bench.connect_and_enable();
  bench.segment.missing = 1;
  bench.cycle(3, true);
  bench.cycle(true, true);
  bench.cycle(5, true);
  EXPECT_TRUE(bench.any_moves());
  bench.segment.drives[1].fail();
  bench.cycle(2, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
}

// ---- what drives do ----

TEST(EthercatDevice, NoticesADriveThatNoLongerFollows) {
  Bench bench;
  bench.connect_and_enable();
  bench.segment.drives[1].ignores = true;
  bench.cycle(2, true);
  bench.segment.drives[1].ignores = false;
  bench.cycle(2, true);
  EXPECT_EQ(bench.fault(), FaultCode::kNone);
  bench.segment.drives[1].ignores = true;
  bench.cycle(4, true);
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
  EXPECT_EQ(bench.device().farewell(),
            "slave 2 (m2), address 0x1001: the drive no longer follows its commands: 'operation "
            "enabled' (mode 0, status word 0x0237, error 0x0000)");
}

TEST(EthercatDevice, HoldsTorquesUntilItsBrakesAreClosed) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.connect_and_enable();
  for (int i = 0; i < 5; ++i) {
    bench.cycle(false);
    EXPECT_FALSE(bench.segment.opens_brakes);
    EXPECT_EQ(bench.segment.drives[0].target, kTorque);
    EXPECT_EQ(bench.segment.drives[0].control, kEnableOperation);
  }
  bench.cycle(false);
  EXPECT_EQ(bench.segment.drives[0].target, 0);
  EXPECT_EQ(bench.segment.drives[0].control, kSwitchOn);
}

TEST(EthercatDevice, HoldsTorquesAfterAFaultOfAnotherDrive) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.connect_and_enable();
  bench.segment.drives[0].fail();
  bench.cycle(true);  // is noticed
  EXPECT_EQ(bench.fault(), FaultCode::kDriveFault);
  for (int i = 0; i < 5; ++i) {
    bench.cycle(false);
    EXPECT_FALSE(bench.segment.opens_brakes);
    EXPECT_EQ(bench.segment.drives[1].target, kTorque);
    EXPECT_EQ(bench.segment.drives[1].control, kEnableOperation);
  }
  bench.cycle(false);
  EXPECT_EQ(bench.segment.drives[1].control, kSwitchOn);
}

TEST(EthercatDevice, DrivesWithBrakesOfTheirOwnAreCommandedAtOnce) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.segment.machine.slaves[kPanel].outputs[0].meaning = Output::kNothing;
  bench.connect();
  bench.cycle(10, true);
  for (int i = 0; i < 5; ++i) {
    bench.cycle(false);
    EXPECT_EQ(bench.segment.drives[0].target, kTorque);
    EXPECT_EQ(bench.segment.drives[0].control, kSwitchOn);
  }
  bench.cycle(false);
  EXPECT_EQ(bench.segment.drives[0].target, 0);
}

TEST(EthercatDevice, HoldsNoSpeeds) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.segment.machine.slaves[0].mode = DriveMode::kCsv;
  bench.segment.machine.slaves[0].outputs[1].meaning = Output::kTargetVelocity;
  bench.speed = 3.0;
  bench.connect();
  bench.cycle(10, true);
  EXPECT_EQ(bench.segment.drives[0].target, 3);
  bench.cycle(false);
  EXPECT_EQ(bench.segment.drives[0].target, 0);
  EXPECT_EQ(bench.segment.drives[0].control, kEnableOperation);
}

TEST(EthercatDevice, WhileItHoldsNoDriveIsSwitchedOn) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.connect();
  while (bench.segment.drives[0].state() != DriveState::kSwitchedOn) bench.cycle(true);
  for (int i = 0; i < 10; ++i) {
    bench.cycle(false);
    EXPECT_FALSE(bench.any_moves());
  }
}

TEST(EthercatDevice, WhileItHoldsTheResetButtonActs) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.connect_and_enable();
  bench.cycle(false, true);
  EXPECT_TRUE(bench.segment.has_reset);
  EXPECT_EQ(bench.segment.drives[0].target, kTorque);
}

TEST(EthercatDevice, ACommandThatIsNotFiniteIsNeverHeld) {
  Bench bench;
  bench.segment.machine.brake_closing_s = 0.005;
  bench.connect_and_enable();
  bench.cycle(true, false, std::nan(""));
  EXPECT_EQ(bench.fault(), FaultCode::kCommandNotFinite);
  EXPECT_EQ(bench.segment.drives[0].target, kTorque);
}

// ---- set-up ----

TEST(EthercatDevice, RefusesASlaveWithoutItsWatchdog) {
  Bench bench;
  bench.segment.registers[0x0814] = 0x0001'0024;
  expect_words(bench.refusal(),
               "slave 1 (m1): its watchdog is switched off (bit 6 of the control byte 0x24 of sync "
               "manager 2): without frames it would go on with its last outputs\nslave 2 (m2): ");
}

TEST(EthercatDevice, RefusesASlaveWhoseOutputsHaveNoSyncManager) {
  Bench bench;
  bench.segment.registers[0x0814] = 0x0000'0064;  // not active
  expect_words(bench.refusal(), "slave 1 (m1): none of its sync managers has its outputs");
}

TEST(EthercatDevice, RefusesDrivesThatMayNotStop) {
  Bench bench;
  bench.segment.options = {{0x605A, 2}, {0x605C, -1}, {0x6007, 0}};
  const std::string refusal = bench.refusal();
  expect_words(refusal,
               "slave 1 (m1): object 0x605c:0, what the drive does at 'disable operation', is -1, "
               "expected is 0 to 1: with another one it may not stop");
  expect_words(refusal, "slave 2 (m2): object 0x6007:0, what the drive does at 'connection lost'");
  EXPECT_EQ(refusal.find("0x605a"), std::string::npos) << refusal;
}

TEST(BusCheck, SaysHowDrivesStop) {
  FakeSegment segment;
  FakeBus bus(segment);
  EXPECT_EQ(stop_words(bus, segment.machine),
            (std::vector<std::string>{"slave 1 (m1): does not say how it stops",
                                      "slave 2 (m2): does not say how it stops"}));
  segment.options = {{0x605A, 6}, {0x605E, 0}};
  EXPECT_EQ(stop_words(bus, segment.machine)[0],
            "slave 1 (m1): quick stop (0x605a): slows down on its quick stop ramp, keeps its "
            "power; fault (0x605e): power off at once");
}

// ---- sync pulses ----

void make_synchronous(FakeSegment& segment) {
  for (std::size_t i = 0; i < kDrives; ++i) segment.machine.slaves[i].is_synchronous = true;
}

TEST(EthercatDevice, WithSyncPulsesRuns) {
  Bench bench;
  make_synchronous(bench.segment);
  bench.connect_and_enable();
}

TEST(EthercatDevice, RefusesASlaveWithoutItsSyncPulses) {
  Bench bench;
  make_synchronous(bench.segment);
  bench.segment.has_pulses = false;
  expect_words(
      bench.refusal(),
      "slave 1 (m1): its sync pulses do not come (register 0x0990 stands)\nslave 2 (m2): ");
}

TEST(EthercatDevice, NoticesFramesThatComeOutOfStep) {
  Bench bench;
  make_synchronous(bench.segment);
  bench.connect_and_enable();
  bench.segment.phase_ns = kPeriod_ns / 20;  // just after a pulse
  bench.cycle(2, true);
  bench.segment.phase_ns = kPeriod_ns / 2;
  bench.cycle(true);
  EXPECT_EQ(bench.sensors.bus_errors, 0u);
  EXPECT_EQ(bench.device().farewell(), "");
  bench.segment.phase_ns = kPeriod_ns / 20;
  bench.cycle(3, true);
  EXPECT_EQ(bench.sensors.bus_errors, 1u);
  expect_words(bench.device().farewell(),
               "3 frames in a row were out of step with the sync pulses, the last one by -450 us");
}

TEST(PulseCheck, NamesWhatIsWrongWithASlave) {
  FakeSegment segment;
  make_synchronous(segment);
  segment.machine.slaves[1].is_synchronous = false;
  FakeBus bus(segment);
  PulseCheck check(bus, segment.machine, 50'000);
  const auto fault = [&] {
    ++segment.exchanges;
    const std::vector<std::string> faults = check.faults();
    return faults.empty() ? std::string() : faults.front();
  };
  expect_words(fault(), "slave 1 (m1): its sync pulses do not come");  // nothing to compare with
  EXPECT_EQ(fault(), "");
  segment.registers[0x0981] = 1;
  expect_words(fault(), "its sync pulses are off (register 0x0981 is 0x01)");
  segment.registers[0x0981] = 3;
  segment.registers[0x0984] = 1;
  expect_words(fault(), "its first sync pulse does not come");
  segment.registers[0x0984] = 0;
  segment.registers[0x092C] = 0x8000'0000 + 50'000;  // behind the first one
  EXPECT_EQ(fault(), "");
  segment.registers[0x092C] = 50'001;
  expect_words(fault(),
               "its clock is 50001 ns from the first one (register 0x092C), at most are "
               "50000 ns");
}

}  // namespace
}  // namespace hg::ethercat
