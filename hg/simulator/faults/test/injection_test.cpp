/// Every kind of fault does what its words say, from its begin to its end and to nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/simulator/faults/faulty_device.h"
#include "hg/simulator/faults/injector.h"

namespace hg::faults {
namespace {

constexpr double kDt = 1e-3;
constexpr double kFrom_s = 0.010, kFor_s = 0.005;

SensorFrame sensors_at(int cycle) {
  SensorFrame sensors;
  sensors.sequence = static_cast<std::uint64_t>(cycle);
  sensors.answered_sequence = static_cast<std::uint64_t>(cycle);
  sensors.time_s = 100.0 + kDt * cycle;
  for (VectorM* v :
       {&sensors.q_m, &sensors.dq_m, &sensors.theta_m, &sensors.tau_m, &sensors.temperature_m}) {
    *v = VectorM::Constant(6, 1.0 + cycle);
  }
  sensors.q_p = VectorP::Constant(2, 1.0 + cycle);
  sensors.w_S.setConstant(1.0 + cycle);
  sensors.a_S.setConstant(1.0 + cycle);
  sensors.omega_S.setConstant(1.0 + cycle);
  sensors.dead_man = true;
  return sensors;
}

CommandFrame command_at(int cycle) {
  CommandFrame command;
  command.sequence = static_cast<std::uint64_t>(cycle);
  command.enable = true;
  command.tau_m = VectorM::Constant(6, 1.0 + cycle);
  command.dq_p = VectorP::Constant(2, 1.0 + cycle);
  return command;
}

Injection injection_of(const Kind& kind, int index) {
  const bool has_magnitude = !kind.unit.empty();
  return {.kind = &kind,
          .index = index,
          .magnitude = has_magnitude ? kind.magnitude.ub : 0.0,
          .from_s = kFrom_s,
          .for_s = kFor_s};
}

// What differs from a good sample, as words.
std::set<std::string> changed_parts(const SensorFrame& a, const SensorFrame& b, int index) {
  std::set<std::string> parts;
  const auto compare = [&](const char* name, const auto& x, const auto& y) {
    for (int i = 0; i < x.size(); ++i) {
      const bool is_same = x[i] == y[i];
      if (!is_same) parts.insert(i == index ? name : "another component");
    }
  };
  compare("q_m", a.q_m, b.q_m);
  compare("dq_m", a.dq_m, b.dq_m);
  compare("theta_m", a.theta_m, b.theta_m);
  compare("tau_m", a.tau_m, b.tau_m);
  compare("temperature_m", a.temperature_m, b.temperature_m);
  compare("q_p", a.q_p, b.q_p);
  compare("w_S", a.w_S, b.w_S);
  compare("a_S", a.a_S, b.a_S);
  compare("omega_S", a.omega_S, b.omega_S);
  if (a.sequence != b.sequence) parts.insert("sequence");
  if (a.answered_sequence != b.answered_sequence) parts.insert("answer");
  if (a.time_s != b.time_s) parts.insert("time");
  if (a.dead_man != b.dead_man) parts.insert("dead_man");
  if (a.bus_errors != b.bus_errors) parts.insert("bus");
  if (a.driver_fault != b.driver_fault) parts.insert("drive");
  if (a.safety.emergency_stop != b.safety.emergency_stop) parts.insert("emergency_stop");
  if (a.safety.operator_enable != b.safety.operator_enable) parts.insert("operator_enable");
  if (a.safety.has_disagreement != b.safety.has_disagreement) parts.insert("disagreement");
  return parts;
}

std::string part_name(Part part) {
  switch (part) {
    case Part::kLinkEncoder:
      return "q_m";
    case Part::kLinkSpeed:
      return "dq_m";
    case Part::kMotorEncoder:
      return "theta_m";
    case Part::kTorqueSensor:
      return "tau_m";
    case Part::kGantryEncoder:
      return "q_p";
    case Part::kForceSensor:
      return "w_S";
    case Part::kAccelerometer:
      return "a_S";
    case Part::kGyroscope:
      return "omega_S";
    case Part::kTemperature:
      return "temperature_m";
    case Part::kDeadMan:
      return "dead_man";
    case Part::kEmergencyStop:
      return "emergency_stop";
    case Part::kOperatorEnable:
      return "operator_enable";
    case Part::kSafetyChannels:
      return "disagreement";
    case Part::kClock:
      return "time";
    case Part::kBus:
      return "bus";
    case Part::kDrive:
      return "drive";
    case Part::kAnswers:
      return "answer";
    default:
      return "";
  }
}

TEST(Injector, EverySensorFaultChangesItsPartAloneAndOnlyWhileItLasts) {
  for (const Kind& kind : kinds()) {
    const std::string part = part_name(kind.part);
    if (part.empty()) continue;
    SCOPED_TRACE(kind.name);
    const int index = std::max(0, parts_of(kind.part, 6, 2) - 1);
    Injector injector({injection_of(kind, index)});
    bool was_changed = false;
    for (int cycle = 0; cycle < 30; ++cycle) {
      const SensorFrame good = sensors_at(cycle);
      SensorFrame sensors = good;
      injector.inject(sensors);
      const bool is_during = cycle >= 10 && cycle < 15;
      const std::set<std::string> changed = changed_parts(good, sensors, index);
      if (!is_during) {
        EXPECT_TRUE(changed.empty()) << "cycle " << cycle;
      }
      for (const std::string& name : changed) EXPECT_EQ(name, part) << "cycle " << cycle;
      was_changed = was_changed || !changed.empty();
    }
    EXPECT_TRUE(was_changed);
  }
}

// The value of the first joint of one kind of fault, cycle by cycle from its begin.
std::vector<double> link_values(const char* name, double magnitude) {
  const Kind* kind = find_kind(name);
  Injector injector({{.kind = kind, .index = 0, .magnitude = magnitude, .from_s = kFrom_s}});
  std::vector<double> values;
  for (int cycle = 0; cycle < 13; ++cycle) {
    SensorFrame sensors = sensors_at(cycle);
    injector.inject(sensors);
    if (cycle >= 10) values.push_back(sensors.q_m[0]);
  }
  return values;
}

TEST(Injector, EffectsHaveTheirValues) {
  EXPECT_EQ(link_values("link_encoder_frozen", 0.0), (std::vector{11.0, 11.0, 11.0}));
  EXPECT_EQ(link_values("link_encoder_zero", 0.0), (std::vector{0.0, 0.0, 0.0}));
  EXPECT_EQ(link_values("link_encoder_jump", 0.5), (std::vector{11.5, 12.5, 13.5}));
  const std::vector<double> drift = link_values("link_encoder_drift", 100.0);
  EXPECT_NEAR(drift[0], 11.0, 1e-9);
  EXPECT_NEAR(drift[2], 13.2, 1e-9);
  EXPECT_TRUE(std::isnan(link_values("link_encoder_nan", 0.0)[0]));
}

// What arrives of commands 10, 11, 12.
std::vector<CommandFrame> arrivals(const char* name, double magnitude) {
  Injector injector(
      {{.kind = find_kind(name), .index = 0, .magnitude = magnitude, .from_s = kFrom_s}});
  std::vector<CommandFrame> arrived;
  for (int cycle = 0; cycle < 13; ++cycle) {
    SensorFrame sensors = sensors_at(cycle);
    injector.inject(sensors);
    CommandFrame command = command_at(cycle);
    injector.inject(command);
    if (cycle >= 10) arrived.push_back(command);
  }
  return arrived;
}

TEST(Injector, FaultsChangeCommandsOnTheirWay) {
  EXPECT_EQ(arrivals("motor_dead", 0.0)[1].tau_m[0], 0.0);
  EXPECT_EQ(arrivals("motor_dead", 0.0)[1].tau_m[1], 12.0);
  EXPECT_EQ(arrivals("motor_weak", 0.5)[1].tau_m[0], 6.0);
  EXPECT_EQ(arrivals("motor_offset", 7.0)[1].tau_m[0], 19.0);
  EXPECT_EQ(arrivals("motor_frozen", 0.0)[2].tau_m[0], 11.0);
  EXPECT_EQ(arrivals("gantry_dead", 0.0)[1].dq_p[0], 0.0);
  EXPECT_EQ(arrivals("gantry_runaway", 0.5)[1].dq_p[0], 12.5);
  EXPECT_FALSE(arrivals("power_lost", 0.0)[0].enable);
  EXPECT_EQ(arrivals("commands_lost", 0.0)[2].sequence, 10U);
  EXPECT_EQ(arrivals("commands_late", 3.0)[2].sequence, 9U);
}

TEST(Injector, SamplesAreLostAndRepeated) {
  Injector lost({{.kind = find_kind("samples_lost"), .magnitude = 4.0, .from_s = kFrom_s}});
  Injector repeated({{.kind = find_kind("samples_repeated"), .from_s = kFrom_s}});
  for (int cycle = 0; cycle < 20; ++cycle) {
    SensorFrame one = sensors_at(cycle), two = one;
    lost.inject(one);
    repeated.inject(two);
    const auto sequence = static_cast<std::uint64_t>(cycle);
    EXPECT_EQ(one.sequence, sequence + (cycle < 10 ? 0U : 4U));
    EXPECT_EQ(two.sequence, cycle < 10 ? sequence : 10U);
  }
}

TEST(Loads, CyclesAreLateAndTheSolverIsCappedWhileTheFaultLasts) {
  const std::vector<Injection> injections = {
      {.kind = find_kind("link_encoder_nan"), .from_s = kFrom_s},
      {.kind = find_kind("cycles_late"), .magnitude = 2.0, .from_s = kFrom_s},
      {.kind = find_kind("solver_hurried"), .magnitude = 2.0, .from_s = kFrom_s, .for_s = kFor_s}};
  TimedLoads loads(loads_of(injections));
  const std::vector<SolverCap> caps = solver_caps_of(injections);
  for (int cycle = 0; cycle < 20; ++cycle) {
    const double time_s = kDt * cycle;
    EXPECT_EQ(loads.late_cycles(time_s), cycle == 10 || cycle == 11 ? 1U : 0U) << cycle;
    EXPECT_EQ(most_active_sets(caps, time_s), cycle >= 10 && cycle < 15 ? 2U : 0U) << cycle;
  }
}

// Shows always the same sample, and keeps the last command.
class StillDevice final : public device::Device {
 public:
  void read(SensorFrame& sensors) noexcept override { sensors = sensors_at(3); }
  void write(const CommandFrame& command) noexcept override { arrived = command; }
  bool is_clock() const noexcept override { return true; }

  CommandFrame arrived;
};

TEST(FaultyDevice, InjectsIntoSamplesAndCommandsOfAnyDevice) {
  auto inner = std::make_unique<StillDevice>();
  StillDevice& still = *inner;
  FaultyDevice device(std::unique_ptr<device::Device>(std::move(inner)),
                      {{.kind = find_kind("link_encoder_zero"), .index = 2},
                       {.kind = find_kind("motor_dead"), .index = 1}});
  SensorFrame sensors;
  device.read(sensors);
  EXPECT_EQ(sensors.q_m[2], 0.0);
  EXPECT_EQ(sensors.q_m[3], 4.0);
  device.write(command_at(3));
  EXPECT_EQ(still.arrived.tau_m[1], 0.0);
  EXPECT_EQ(still.arrived.tau_m[2], 4.0);
  EXPECT_TRUE(device.is_clock());
  EXPECT_EQ(device.truth(), nullptr);
}

TEST(FaultyDevice, RefusesAFaultOfTheHardwareWhereTheMachineIsNotSimulated) {
  EXPECT_THROW(FaultyDevice(std::unique_ptr<device::Device>(std::make_unique<StillDevice>()),
                            {{.kind = find_kind("brake_weak"), .index = 1}}),
               SetupError);
}

TEST(Injector, BrakesAndChannelsHaveABitEachWhileItLasts) {
  const auto injection = [](const char* name, int index) -> Injection {
    return {.kind = find_kind(name), .index = index, .from_s = kFrom_s, .for_s = kFor_s};
  };
  Injector injector({injection("brake_closes", 0), injection("brake_closes", 5),
                     injection("brake_weak", 1), injection("safety_channel_opens", 2),
                     injection("safety_channel_stuck", 3)});
  for (int cycle = 0; cycle < 20; ++cycle) {
    SensorFrame sensors = sensors_at(cycle);
    CommandFrame command = command_at(cycle);
    injector.inject(sensors);
    injector.inject(command);
    const bool is_during = cycle >= 10 && cycle < 15;
    EXPECT_EQ(injector.hardware().closed_brakes, is_during ? 0b100001U : 0U) << cycle;
    EXPECT_EQ(injector.hardware().weak_brakes, is_during ? 0b10U : 0U) << cycle;
    EXPECT_EQ(injector.hardware().open_channels, is_during ? 0b100U : 0U) << cycle;
    EXPECT_EQ(injector.hardware().stuck_channels, is_during ? 0b1000U : 0U) << cycle;
  }
}

TEST(Injector, RefusesCommandsThatAreTooLateAndAllocatesNothing) {
  EXPECT_THROW(Injector({{.kind = find_kind("commands_late"), .magnitude = 17.0}}), SetupError);
  EXPECT_EQ(find_kind("no_such_fault"), nullptr);

  std::vector<Injection> all;
  for (const Kind& kind : kinds()) all.push_back(injection_of(kind, 0));
  Injector injector(all);
  AllocationCounter allocations;
  for (int cycle = 0; cycle < 30; ++cycle) {
    SensorFrame sensors = sensors_at(cycle);
    CommandFrame command = command_at(cycle);
    injector.inject(sensors);
    injector.inject(command);
  }
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace hg::faults
