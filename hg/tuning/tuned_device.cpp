#include "hg/tuning/tuned_device.h"

#include <fmt/format.h>

#include <cmath>

#include "hg/assembly/assembly.h"
#include "hg/core/error.h"

namespace hg::tuning {
namespace {

// standard deviation of what a step of that size rounds away
double rounding(double step) { return step / std::sqrt(12.0); }

}  // namespace

Device device_of(const config::Device& device) {
  if (device.control.method != control::Method::kModal) {
    throw SetupError(fmt::format(
        "{}: {}", device.sources.empty() ? device.name : device.sources.front().name,
        device.control.method == control::Method::kDrives
            ? "tune is for joints whose torque we control: the device has no 'actuators', its "
              "drives follow positions by themselves"
            : "tune is for control.method: modal, got motor_pd"));
  }
  const simulation::SensorFilterConfig& filter = device.simulation.sensors.wrench.filter;
  return {.loop = assembly::torque_loop(device),
          .wrench = {.average_s = filter.average,
                     .delay_s = filter.delay,
                     .low_pass_Hz = device.estimation.wrench.low_pass_Hz}};
}

void apply(const Device& tuned, config::Device& device) {
  device.control = tuned.loop.config;
  device.estimation.link_pole_Hz = tuned.loop.filters.link_pole_Hz;
  device.estimation.motor_low_pass_Hz = tuned.loop.filters.motor_low_pass_Hz;
  device.estimation.wrench.low_pass_Hz = tuned.wrench.low_pass_Hz;
}

Noise noise_of(const config::Device& device) {
  const simulation::SensorsConfig& sensors = device.simulation.sensors;
  const Payload& payload = device.estimation.wrench.payload;
  const double accelerometer =
      device.estimation.wrench.has_imu ? sensors.accelerometer.noise * payload.mass : 0.0;
  Noise noise = {.force = std::hypot(sensors.wrench.force_noise, accelerometer),
                 .torque = sensors.wrench.torque_noise,
                 .joint = Eigen::VectorXd(device.model.n_m),
                 .link_encoder = rounding(sensors.link_encoder.resolution)};
  double least_ratio = 1.0;
  if (device.simulation.gear_ratio.size() > 0)
    least_ratio = device.simulation.gear_ratio.minCoeff();
  noise.motor_encoder = rounding(sensors.motor_encoder.resolution) / least_ratio;
  for (int i = 0; i < device.model.n_m; ++i) {
    noise.joint[i] =
        sensors.torque.noise * device.control.actuators[static_cast<std::size_t>(i)].torque_max;
  }
  return noise;
}

Eigen::VectorXd unexpected_friction(const config::Device& device) {
  constexpr double kShare = 0.3;
  Eigen::VectorXd friction(device.model.n_m);
  for (int i = 0; i < device.model.n_m; ++i) {
    friction[i] = kShare * device.control.actuators[static_cast<std::size_t>(i)].coulomb_friction;
  }
  return friction;
}

control::Reality simulated(const config::Device& device) {
  const config::RealityFactors& factors = device.simulation.factors;
  control::Reality reality = {device.control.actuators,
                              config::actual(device.control.loop, factors), factors.mass};
  for (ActuatorModel& actuator : reality.actuators) actuator = config::actual(actuator, factors);
  return reality;
}

}  // namespace hg::tuning
