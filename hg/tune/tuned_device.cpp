#include "hg/tune/tuned_device.h"

#include <fmt/format.h>

#include <cmath>

#include "hg/core/error.h"
#include "hg/scenario/assembly.h"

namespace hg::tune {
namespace {

// standard deviation of what a step of that size rounds away
double rounding(double step) { return step / std::sqrt(12.0); }

}  // namespace

LoopDevice device_of(const config::SimulatedDeviceConfig& device) {
  const auto refuse = [&](const std::string& why) {
    throw SetupError(fmt::format(
        "{}: {}", device.sources.empty() ? device.name : device.sources.front().name, why));
  };
  if (device.control.method == tracking::Method::kDrives) {
    refuse(
        "tune is for joints whose torque we control: it has no control of torques, its drives "
        "follow "
        "positions on their own");
  }
  if (device.control.method != tracking::Method::kModal) {
    refuse("tune is for control.method: modal, got motor_pd");
  }
  if (device.model.n_m < 6) {
    refuse(
        fmt::format("tune needs six joints, with which the handle moves in every direction, got "
                    "{}",
                    device.model.n_m));
  }
  if (!device.estimation.wrench.has_imu) {
    refuse("tune needs estimation.has_imu: true, it takes the inertia of the payload as known");
  }
  const simulator::WrenchSensorConfig& sensor = device.simulation.sensors.wrench;
  if (!(sensor.force_noise > 0.0)) {
    refuse(
        "tune weighs what is felt against the noise of the force/torque sensor, and there is "
        "none: give 'simulation:' a file with sensors.wrench_sensor.noise_N_per_sqrt_Hz");
  }
  return handle_loop::device_of(device);
}

Noise noise_of(const config::SimulatedDeviceConfig& device) {
  const simulator::SensorsConfig& sensors = device.simulation.sensors;
  const Payload& payload = device.estimation.wrench.payload;
  const double accelerometer = sensors.accelerometer.noise * payload.mass;
  Noise noise = {.force = std::hypot(sensors.wrench.force_noise, accelerometer),
                 .torque = sensors.wrench.torque_noise,
                 .joint = Eigen::VectorXd(device.model.n_m),
                 .link_encoder = rounding(sensors.link_encoder.resolution)};
  double least_ratio = 1.0;
  if (device.simulation.gear_ratio.size() > 0)
    least_ratio = device.simulation.gear_ratio.minCoeff();
  noise.motor_encoder = rounding(sensors.motor_encoder.resolution) / least_ratio;
  for (int i = 0; i < device.model.n_m; ++i) {
    noise.joint[i] = sensors.torque.noise * device.model.actuators[i].torque_max;
  }
  return noise;
}

Eigen::VectorXd unexpected_friction(const config::SimulatedDeviceConfig& device) {
  constexpr double kShare = 0.3;
  Eigen::VectorXd friction(device.model.n_m);
  for (int i = 0; i < device.model.n_m; ++i) {
    friction[i] = kShare * device.model.actuators[i].coulomb_friction;
  }
  return friction;
}

}  // namespace hg::tune
