/// Whether a device can lead a hand through all that a twin can do, tried by a run.
///
/// A simulated hand moves each joint of the twin from its start to both ends and back, at the
/// speeds that the twin allows, while the control cycle runs on the simulated device: gantry,
/// posture level and all limits act as they do in use.
#pragma once

#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/config/simulation/simulation.h"
#include "hg/config/twin.h"

namespace hg::workspace {

/// Device and twin somewhere on the way.
struct Place {
  Eigen::VectorXd q;   ///< Posture of the device, gantry first
  ConfigurationA q_a;  ///< Coordinates of the twin
};

/// Result of a trial.
struct Way {
  double share = 1.0;       ///< Least share of a joint's range through which it was led, 0..1
  std::string twin_joint;   ///< That joint
  std::string fault;        ///< Fault that ended the trial; empty: none
  double at_limit_s = 0.0;  ///< Longest time at which one limit of the device stood at its end, s
  std::string limit;        ///< That limit; empty: none stood there for long
  double rushed_s = 0.0;  ///< Longest time in which a joint of the device was at its largest speed
  std::string rushed;     ///< That joint; empty: none was for long
  double excess = 0.0;    ///< Largest true excess over a limit of the device, rad or m
  double shaken_s = 0.0;  ///< Time in which hand and device oscillated against each other, s
  std::string exceeded;   ///< That limit; empty: none by more than kExcessAllowed
  std::vector<int> led;   ///< Joints of the twin that were led
  std::vector<Place> places;  ///< At their ends, and between them in steps of 5 % of their ranges
};

/// Lever below which a joint of the twin turns the handle on the spot, m.
inline constexpr double kNearLever = 0.02;
/// Share from which a way counts as whole.
inline constexpr double kWholeWay = 0.95;
/// Largest excess of a limit that counts as none, rad or m.
inline constexpr double kExcessAllowed = 1e-3;

/// Gives the scenario a script that leads each joint of its twin that has a range from its start to
/// both ends and back, one after the other, at speeds that twin and hand allow. False, without a
/// change, for a twin with a floating joint, with more joints than a script can move, or without a
/// range.
bool take_script_through_ranges(config::Scenario& scenario);

/// What a user should know of a trial, in one line; empty where nothing was in the way.
std::string problem_of(const Way& way);

/// What helps.
inline constexpr const char* kCuresOfWay =
    "move or turn the placement, start elsewhere (start of the twin's joints, posture of the "
    "device), or narrow the limits of the twin's joints; against oscillation more mass "
    "(mass_scale)";

/// Leads `twin` on `device`. Locks, conditional limits, springs, weight, damping and friction of
/// the twin are left out, since they are no matter of the device. Joints without limits and those
/// that take longer than a minute are not led; nor is a twin with a floating joint, or with more
/// joints than the eight that a script can move. Deterministic. Throws SetupError where the device
/// cannot hold the twin at its start, or the two do not make a control cycle.
Way lead(const config::SimulatedDeviceConfig& device, const config::Twin& twin);

}  // namespace hg::workspace
