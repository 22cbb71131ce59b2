/// Lightest twins of a device: in a hand, lighter ones swing ever wider.
///
/// From the loop of hand, twin, sensor and drives without friction, for a free body at the start of
/// the twin; DriveLoop where drives follow positions, handle_loop where we control torques and the
/// handle's own inertia is felt for want of an accelerometer. With one, friction decides, and
/// bodies of 0.4 to 0.6 kg shook in simulation. Simulated with steps of 0.25 ms, which damp stiff
/// joints, arms show bodies that are lighter by a quarter.
#pragma once

#include <span>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/simulation/scenario.h"
#include "hg/simulator/person/hand.h"

namespace hg::check {

/// Lightest body for each hand, kg; `damping` of the body in Ns/m. Empty for other devices, and
/// where the device does not get to its start.
std::vector<double> lightest_bodies(const config::SimulatedDeviceConfig& device,
                                    const config::Twin& twin, double damping,
                                    std::span<const person::HandImpedance> hands);

/// A note with the lightest twin in a relaxed, a normal and a stiff hand, and a warning where that
/// of the scenario is lighter in the hand of its script.
Findings inspect_light_twin(const config::Scenario& scenario);

}  // namespace hg::check
