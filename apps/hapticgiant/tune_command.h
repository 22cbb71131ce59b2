/// `hapticgiant tune DEVICE`: filters and poles of a device with torque control, with their proof.
#pragma once

#include <cstdint>
#include <string>

namespace hg::apps {

struct TuneArguments {
  std::string device = "models/haptic_giant/device.yaml";
  std::string out = "tune";  ///< folder of the report
  double vibration = 0.0;    ///< largest, m/s^2; 0 = what the device has now
  double mass = 6.0;         ///< of the body that is rendered, kg
  double damping = 4.0;      ///< likewise, Ns/m
  int postures = 40;         ///< of the proof
  std::uint32_t seed = 1;    ///< of the postures
  bool has_front = false;    ///< also for less and more vibration
  bool only_checks = false;  ///< what the device has now, nothing is searched or written
};

/// Exit code: 0 found (or there already) and proven, 1 nothing that is proven. Throws SetupError
/// for bad input.
int run_tune(const TuneArguments& arguments);

}  // namespace hg::apps
