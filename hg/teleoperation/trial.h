/// One trial of a method: a hand presses a body against a wall that stands at the remote machine.
///
/// Without a device: the body is a point mass with a damper, as the twin is, and the wrench of the
/// hand reaches it late, as that of the handle reaches the twin. The hand approaches, presses,
/// holds, leaves, and does all that two times more. While it presses for the third time, the wall
/// moves: the hand does nothing about it, so that the force stays as it is only as far as what is
/// felt moves the hand. Deterministic; thousands of times as fast as with the device.
#pragma once

#include <functional>
#include <memory>

#include "hg/simulator/person/hand.h"
#include "hg/teleoperation/channel.h"
#include "hg/teleoperation/leader_half.h"
#include "hg/teleoperation/limiter.h"
#include "hg/teleoperation/machine.h"

namespace hg::teleoperation {

struct TrialConfig {
  MethodConfig method;
  /// Make the halves of a method that `method` does not know; empty: those of `method`.
  std::function<std::unique_ptr<LeaderMethod>(const TrialConfig&)> make_leader;
  std::function<std::unique_ptr<RemoteMethod>(const TrialConfig&)> make_remote;
  /// A method that gives energy without end is to be seen, not to be ended.
  LeaderConfig leader = {.surplus = kInfinity};
  ChannelConfig link;
  MachineImpedance machine;
  double wall_stiffness = 5e3;  ///< N/m
  double wall_damping = 20.0;   ///< Ns/m
  person::HandImpedance hand;
  double body_mass = 6.0;       ///< kg
  double body_damping = 4.0;    ///< Ns/m
  double late = 4e-3;           ///< Delay of the hand's wrench, s
  double approach_speed = 0.1;  ///< Of the hand's goal, m/s
  double distance = 0.1;        ///< From the start to the wall, m
  double press = 10.0;          ///< What the hand presses with at rest, N
  double hold = 4.0;            ///< Time of a press after the goal has come to rest, s
  double regulation = 8.0;      ///< The same of the third press, s
  double wall_motion = 5e-3;    ///< Amplitude of the wall then, m
  double wall_period = 4.0;     ///< Of its motion, s
  bool is_felt = true;          ///< False: no force on the leader
  double dt = 1e-3;
};

/// A moment of a trial, along the normal of the wall; positive into the wall, from the start.
struct TrialMoment {
  double time_s = 0.0;
  double goal = 0.0, wall = 0.0;
  double x_leader = 0.0, x_remote = 0.0, x_target = 0.0;
  double v_leader = 0.0;
  double f_hand = 0.0, f_leader = 0.0, f_wall = 0.0;
  double energy_leader = 0.0, energy_remote = 0.0;  ///< Taken at each port, net, J
};

struct TrialResult {
  bool is_stable = false;       ///< Moves slower than 2 mm/s rms in the last second of both presses
  double vibration = 0.0;       ///< Velocity of the leader in those seconds, rms, m/s
  double created = 0.0;         ///< Energy that both ports together gave beyond what they took, J
  double created_leader = 0.0;  ///< The same of the leader's port alone, J
  double duration_s = 0.0;
  double peak_hand = 0.0;         ///< Largest force of the hand, N
  double peak_wall = 0.0;         ///< Largest force of the wall, N
  double rest_offset = 0.0;       ///< Between both sides at the end of the second press, m
  double first_offset = 0.0;      ///< The same of the first press, m
  double rest_force_error = 0.0;  ///< Between felt and measured force there, N
  double position_rms = 0.0;      ///< Remote machine behind the leader of one delay ago, m
  double force_rms = 0.0;         ///< Felt force against the wall's force, N
  double regulation_rms = 0.0;    ///< Wall's force against `press` while the wall moves, N
};

/// Called in every period.
using TrialObserver = std::function<void(const TrialMoment&)>;

/// Plays a trial. Throws SetupError.
TrialResult play_trial(const TrialConfig& config, const TrialObserver& observer = {});

}  // namespace hg::teleoperation
