/// The simulated world: a machine, its sensors, and a person holding the handle.
///
/// One call of step() is one period of the loop. The same seeds and commands give the same bits.
/// No allocation, noexcept after set-up.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "hg/core/types.h"
#include "hg/model/chain_model.h"
#include "hg/signals/frames.h"
#include "hg/signals/truth.h"
#include "hg/simulator/person/person.h"
#include "hg/simulator/plant/ideal_plant.h"
#include "hg/simulator/plant/plant.h"
#include "hg/simulator/safety_plc.h"
#include "hg/simulator/sensors/sensors.h"

namespace hg::simulator {

/// Set-up data of a simulation.
struct SimulatorConfig {
  /// Joints with motors, or drives that follow positions perfectly.
  std::variant<IdealPlantConfig, PlantConfig> plant;
  int steps = 1;  ///< steps of the plant per period; 1 for an ideal one
  double latency =
      0.0;  ///< delay of commands to joints with motors, s; rounded to steps of the plant
  SensorsConfig sensors = ideal_sensors();
  SensedDevice sensed;          ///< its step and period are those of plant and loop
  std::vector<int> link_units;  ///< frames of the plant's chain that carry an inertial unit
  bool has_dead_man = true;
  /// The person lets go of the handle once the operator's override key is on, until a hand target
  /// is active
  bool leaves_handle_for_key = false;
  SafetyPlcConfig safety;  ///< its period is that of the loop
  /// Time without a new command after which the drives switch themselves off and report
  /// kCommandsLost, until they are commanded off, s; [HANDBOOK] 6.6. A command is new when its
  /// number is; commands without a number (0) are always new.
  double drive_watchdog = 0.01;
};

class Simulation {
 public:
  static constexpr int kMaxLatency = 64;  ///< maximum latency, periods

  /// `chain` is that of the plant, `handle` its frame H. Throws SetupError when the latency is
  /// longer than kMaxLatency periods.
  Simulation(const SimulatorConfig& config, const model::ChainModel& chain, int handle,
             person::Person person);

  /// Present sensor readings.
  const SensorFrame& sensors() const noexcept { return frame_; }
  /// Present true state.
  const Truth& truth() const noexcept { return truth_; }
  const person::Person& person() const noexcept { return person_; }
  const SafetyPlc& safety_plc() const noexcept { return safety_plc_; }
  /// Advances by one period under `command`, the answer to sensors().
  void step(const CommandFrame& command, const HardwareFaults& faults = {}) noexcept;

 private:
  /// Command on its way to the drives; the queue has the oldest first.
  struct Waiting {
    CommandFrame command;
    std::uint64_t due = 0;  // step of the plant at which it arrives
  };

  void take_due_command() noexcept;
  void move(const CommandFrame& command) noexcept;
  void look(const HandTarget& target) noexcept;
  Truth felt() const noexcept;
  void watch_over(const SafetyPanel& panel) noexcept;
  double time_s() const noexcept;
  bool is_held() const noexcept;
  void sample() noexcept;

  SimulatorConfig config_;
  std::variant<IdealPlant, Plant> plant_;
  std::uint64_t latency_steps_;
  Sensors sensors_;
  TorqueEstimate torque_estimate_;
  SafetyPlc safety_plc_;
  HardwareFaults faults_;  ///< faults in this period
  person::Person person_;
  std::uint64_t steps_ = 0;  ///< steps of the plant so far
  std::array<Waiting, kMaxLatency + 1> waiting_;
  std::size_t first_waiting_ = 0, waiting_count_ = 0;
  std::uint64_t last_number_ = 0;   ///< number of the last command
  double silent_s_ = 0.0;           ///< time since the last new command, s
  bool has_left_handle_ = false;    ///< the person keeps off for the override key
  bool is_cut_off_ = false;         ///< the drives have switched themselves off
  CommandFrame at_work_;            ///< the newest command that has reached the drives
  DriveInterpolator interpolator_;  ///< of drives that follow positions
  Vector6 w_H_ = Vector6::Zero();
  Truth truth_;
  SensorFrame frame_;
};

}  // namespace hg::simulator
