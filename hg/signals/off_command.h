/// The command that moves nothing.
#pragma once

#include "hg/signals/frames.h"

namespace hg {

/// A command with drives off and brakes closed, for a device with `n_p` gantry axes and `n_m`
/// joints. `takes_torques`: it is commanded by torques of its motors.
inline CommandFrame off_command(int n_p, int n_m, bool takes_torques) {
  CommandFrame command;
  command.q_m = command.dq_m = command.ddq_m = VectorM::Zero(n_m);
  if (takes_torques) command.tau_m = VectorM::Zero(n_m);
  command.dq_p = VectorP::Zero(n_p);
  return command;
}

}  // namespace hg
