/// Lightest twins of a device: in a hand, lighter ones swing ever wider.
///
/// From the loop of hand, twin, sensor and drives without friction, for a free body at the start of
/// the twin, whose mass and inertia shrink together: DriveLoop where drives follow positions,
/// handle_loop where control.method is modal and the handle's own inertia is felt for want of an
/// accelerometer. With one, friction decides: bodies of 0.4 to 0.6 kg shook in simulation. Kicked
/// bodies of six simulated arms shook below 0.7 to 1.5 times what is stated here, of an xArm7,
/// whose gears have play, below 2.3 times.
#pragma once

#include <span>
#include <vector>

#include "hg/check/findings.h"
#include "hg/config/simulation/scenario.h"
#include "hg/simulator/person/hand.h"

namespace hg::check {

/// Lightest body for each hand, kg: 0 = any, infinite = none. Empty for other devices and twins
/// that are no free bodies, and where the device does not get to its start. Throws SetupError where
/// the loop has too many states.
std::vector<double> lightest_bodies(const config::SimulatedDeviceConfig& device,
                                    const config::Twin& twin,
                                    std::span<const person::HandImpedance> hands);

/// A note with the lightest twin in a relaxed, a normal and a stiff hand, and a warning where that
/// of the scenario is lighter in the hand of its script.
Findings inspect_light_twin(const config::Scenario& scenario);

}  // namespace hg::check
