#include "hg/handle_loop/loop_device.h"

#include "hg/config/torque_loop.h"
#include "hg/scenario/assembly.h"

namespace hg::handle_loop {

LoopDevice device_of(const config::SimulatedDeviceConfig& device) {
  const simulator::WrenchSensorConfig& sensor = device.simulation.sensors.wrench;
  const estimation::WrenchConfig& wrench = device.estimation.wrench;
  return {.loop = config::torque_loop(device),
          .wrench = {.average_s = sensor.filter.average,
                     .delay_s = sensor.filter.delay,
                     .low_pass_Hz = wrench.low_pass_Hz,
                     .felt = wrench.has_imu ? Payload{} : wrench.payload}};
}

tracking::TruePlant simulated(const config::SimulatedDeviceConfig& device) {
  const config::RealityFactors& factors = device.simulation.factors;
  tracking::TruePlant plant = {device.model.actuators, config::actual(device.control.loop, factors),
                               factors.mass};
  for (ActuatorModel& actuator : plant.actuators) actuator = config::actual(actuator, factors);
  return plant;
}

}  // namespace hg::handle_loop
