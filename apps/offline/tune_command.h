/// `hapticgiant tune DEVICE`: filters and poles of a device with torque control, with their proof.
#pragma once

#include <cstdint>
#include <string>

namespace hg::apps {

class Command;

struct TuneArguments {
  std::string device = "models/haptic_giant/device.yaml";
  std::string out = "tune";  ///< folder of the report
  double vibration = 0.0;    ///< largest vibration, m/s^2; 0 = the device's present one
  double mass = 6.0;         ///< mass of the rendered body, kg
  int postures = 40;         ///< number of postures of the proof
  std::uint32_t seed = 1;    ///< seed of the postures
  bool has_front = false;    ///< also tunes for less and more vibration
  /// Checks the device's present values only; no search, no output files
  bool only_checks = false;
};

/// Exit code: 0 proven values found (or already present), 1 no proven values. Throws SetupError for
/// bad input.
int run_tune(const TuneArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_tune(Command app, int& exit_code);

}  // namespace hg::apps
