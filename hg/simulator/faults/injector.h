/// Applies injected faults to the frames between a device and its controller. No allocation after
/// construction.
#pragma once

#include <array>
#include <vector>

#include "hg/signals/frames.h"
#include "hg/simulator/faults/injection.h"
#include "hg/simulator/hardware_faults.h"

namespace hg::faults {

class Injector {
 public:
  Injector() = default;
  /// Faults of the computer are ignored: see loads_of() and solver_caps_of(). Throws SetupError for
  /// a command delay above kMostLate.
  explicit Injector(const std::vector<Injection>& injections);

  /// Applies the faults to a sample. Once per period, before the inject() for the command.
  void inject(SensorFrame& sensors) noexcept;
  /// Applies the faults to a command.
  void inject(CommandFrame& command) noexcept;
  /// Faults of the hardware in the period of the last command passed to inject().
  const simulator::HardwareFaults& hardware() const noexcept { return hardware_; }

 private:
  /// Fault with its state.
  struct Fault {
    Injection injection;
    bool has_begun = false;
    double held = 0.0;     ///< value of its component at its begin
    SensorFrame sensors;   ///< sample at its begin
    CommandFrame command;  ///< command at its begin
  };

  /// Present motion of an axis beyond that of its drive: m/s and m, or rad/s and rad.
  struct Slip {
    double speed, way;
  };

  bool is_active(const Fault& fault) const noexcept;
  double faulty_value(const Fault& fault, double value) const noexcept;
  template <typename Vector>
  void inject_component(Fault& fault, Vector& v) const noexcept;
  void inject_sensors(Fault& fault, SensorFrame& sensors) noexcept;
  void inject_inputs(const Fault& fault, SensorFrame& sensors) const noexcept;
  void inject_samples(const Fault& fault, SensorFrame& sensors) const noexcept;
  void inject_command(Fault& fault, CommandFrame& command) const noexcept;
  Slip slip_of(const Injection& injection) const noexcept;
  void inject_hardware(const Injection& injection) noexcept;

  std::vector<Fault> faults_;
  std::array<CommandFrame, kMostLate + 1> past_;  ///< ring of commands, the newest at newest_
  std::size_t newest_ = 0;
  double start_s_ = 0.0, now_s_ = 0.0;
  bool has_started_ = false, has_commanded_ = false;
  simulator::HardwareFaults hardware_;
};

}  // namespace hg::faults
