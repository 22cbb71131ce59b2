/// Builds the parts of a run from a loaded scenario.
#pragma once

#include <memory>

#include "hg/analysis/summary.h"
#include "hg/config/simulation/scenario.h"
#include "hg/controller/cycle.h"
#include "hg/device/device.h"
#include "hg/scenario/start_posture.h"
#include "hg/signals/twin_force_source.h"
#include "hg/simulator/person/person.h"
#include "hg/simulator/simulation.h"

namespace hg::teleoperation {
class RemoteSide;
}  // namespace hg::teleoperation

namespace hg::scenario {

/// The control cycle of the scenario's device and twin, with a solver capped where the faults of
/// the scenario say so. Throws SetupError.
controller::Cycle make_cycle(const config::Scenario& scenario);

/// Whether rule 105 is on: sensors without noise in simulation.yaml give constant values at rest.
bool notices_frozen_sensors(const config::SimulatedDeviceConfig& device);

/// The scenario's person, who grasps the handle of a device at `start`.
person::Person make_person(const config::Scenario& scenario, const Start& start);

/// A simulated world that starts where the twin starts, held by the scenario's person. Throws
/// SetupError when the device cannot reach that pose.
simulator::Simulation make_simulation(const config::Scenario& scenario);
/// The same with the device at `start`, whose person lets go of the handle once the operator's
/// override key is on: one session of several with a device that stays where it is left.
simulator::Simulation make_simulation(const config::Scenario& scenario, const Start& start);
/// The device alone at `start` (the pose of the handle does not matter), with a free handle.
simulator::Simulation make_unheld_simulation(const config::SimulatedDeviceConfig& device,
                                             const Start& start);
/// The world of make_simulation() behind the interface of a device, with the faults of the
/// scenario. Late cycles act in a session or runtime, faults::loads_of(); a hurried solver in the
/// cycle.
std::unique_ptr<device::Device> make_simulated_device(const config::Scenario& scenario);
/// The same with a given world, to start several devices from one.
std::unique_ptr<device::Device> make_simulated_device(const config::Scenario& scenario,
                                                      simulator::Simulation world);

/// What pushes the twin of the scenario from outside: its teleoperation. Null: nothing does. Throws
/// SetupError where the remote machine is behind a network.
std::unique_ptr<TwinForceSource> make_twin_force(const config::Scenario& scenario);
/// The same with a remote machine; null: simulated here.
std::unique_ptr<TwinForceSource> make_twin_force(const config::Scenario& scenario,
                                                 std::unique_ptr<teleoperation::RemoteSide> remote);
/// What moves the twin's root link; nullptr = it rests.
std::unique_ptr<TwinBaseSource> make_twin_base(const config::Scenario& scenario);

/// Evaluation of a run of the scenario.
analysis::Summary make_summary(const config::Scenario& scenario);

/// Seconds until everything planned has happened; 0 = nothing is planned.
double planned_duration_s(const config::Scenario& scenario);

/// Time in s after which a stopping device is left to its brakes: rule 310 has acted by then.
double longest_stop_s(const config::Scenario& scenario);

}  // namespace hg::scenario
