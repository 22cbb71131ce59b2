/// What a page is shown of one moment: the record of a cycle and what the program adds to it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::viewer_server {

/// Where the user's wrench goes, each part as a wrench on the hand, at H, resolved in B. The sum of
/// all but `user` is `user`.
struct HandBudget {
  Vector6 user = Vector6::Zero();
  Vector6 inertia = Vector6::Zero(), damping = Vector6::Zero(), spring = Vector6::Zero();
  Vector6 friction = Vector6::Zero(), surface = Vector6::Zero(), limits = Vector6::Zero();
  Vector6 conflict = Vector6::Zero(), structure = Vector6::Zero(), rest = Vector6::Zero();
};

struct Singularity {
  double measure = 0.0;  ///< 0 = singular, 1 = as far from it as this device gets
  int limit = -1;        ///< in the catalogue, what keeps it away; -1 = none
};

/// What commands have made of the run.
struct RunState {
  bool is_paused = false;
  double speed = 1.0;       ///< simulated or recorded seconds per second
  bool is_over = false;     ///< stopped, a fault, or the end of a recording
  double position_s = 0.0;  ///< time of the run, also of a recorded one
  std::string recording;    ///< name of the file that is written or played; empty = none
};

/// A second run, shown through the first.
struct Ghost {
  double time_s = 0.0;  ///< of its run
  CycleRecord record;
};

/// What stops the device, in words, and the panel of its simulated operator.
struct SafetyView {
  std::string cause;    ///< of the stop or fault, one sentence; empty = there is none
  std::string release;  ///< what has to happen before a reset
  std::string warning;  ///< the rule nearest to its threshold; empty = all is far from it
  SafetyPanel panel;
  std::vector<std::uint64_t> stop_pressed_by;  ///< of OperatorDesk; filled by the server
};

struct View {
  std::uint64_t run = 1;  ///< Scene::run
  CycleRecord record;
  HandTarget hand;
  double cycle_time_us = 0.0, cycle_time_max_us = 0.0;  ///< of the cycle, and since the last view
  std::string status_text;                              ///< one line for people
  HandBudget budget;
  std::optional<Singularity> singularity;
  RunState run_state;
  SafetyView safety;
  std::optional<Ghost> ghost;
};

}  // namespace hg::viewer_server
