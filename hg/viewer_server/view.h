/// View of one moment for a page: the record of a cycle and additions of the program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hg/core/fields.h"
#include "hg/signals/frames.h"
#include "hg/signals/state.h"

namespace hg::viewer_server {

/// Decomposition of the user's wrench, each part as a wrench on the hand, at H, resolved in B. The
/// sum of all but `user` is `user`.
struct HandBudget {
  Vector6 user = Vector6::Zero();
  Vector6 inertia = Vector6::Zero(), damping = Vector6::Zero(), spring = Vector6::Zero();
  Vector6 friction = Vector6::Zero(), surface = Vector6::Zero(), limits = Vector6::Zero();
  Vector6 conflict = Vector6::Zero(), structure = Vector6::Zero(), rest = Vector6::Zero();
};

template <typename Archive, Is<HandBudget> T>
void fields(Archive& a, T& budget) {
  a("user", budget.user, "wrench of the user, the sum of all other parts");
  a("inertia", budget.inertia, "motion and weight of the twin");
  a("damping", budget.damping, "dampers");
  a("spring", budget.spring, "springs and closers");
  a("friction", budget.friction, "friction while slipping; held joints are limits");
  a("surface", budget.surface, "virtual surfaces and the reference wrench of the twin");
  a("limits", budget.limits, "active limits");
  a("conflict", budget.conflict, "limits that could not be met");
  a("structure", budget.structure, "bearings of the twin");
  a("rest", budget.rest, "unexplained remainder; 0 while running");
}

struct Singularity {
  double measure = 0.0;
  int limit = -1;
};

template <typename Archive, Is<Singularity> T>
void fields(Archive& a, T& singularity) {
  a("measure", singularity.measure, "0 = singular, 1 = largest distance from it for this device",
    unit::kNone);
  a("limit", singularity.limit, "index in Scene.limits of the limit that keeps it away; -1 = none");
}

/// State of the run as set by commands.
struct RunState {
  bool is_paused = false;
  double speed = 1.0;
  bool is_over = false;
  double position_s = 0.0;
  std::string recording;

  bool operator==(const RunState&) const = default;
};

template <typename Archive, Is<RunState> T>
void fields(Archive& a, T& state) {
  a("is_paused", state.is_paused);
  a("speed", state.speed, "simulated or recorded time over real time", unit::kNone);
  a("is_over", state.is_over, "stopped, a fault, or the end of a recording");
  a("position_s", state.position_s, "time of the run, also of a recorded one");
  a("recording", state.recording, "name of the file that is written or played; empty = none");
}

/// Second run, overlaid on the first.
struct Ghost {
  double time_s = 0.0;
  CycleRecord record;
  TwinBase twin_base;
};

/// The other side of a teleoperation.
struct TeleoperationView {
  TeleoperationReport report;
  bool is_clutch_open = false;  ///< A page has opened the clutch
};

/// Cause of a stop as text, and the panel of the simulated operator.
struct SafetyView {
  std::string cause;    ///< cause of the stop or fault, one sentence; empty = none
  std::string release;  ///< conditions for a reset
  std::string warning;  ///< rule nearest to its threshold; empty = all are far from it
  SafetyPanel panel;
  std::vector<std::uint64_t> stop_pressed_by;  ///< pages as in OperatorDesk; filled by the server
};

struct View {
  std::uint64_t run = 1;  ///< Scene::run
  CycleRecord record;
  TwinBase twin_base;  ///< of the same cycle
  HandTarget hand;
  /// Cycle time, and its maximum since the last view
  double cycle_time_us = 0.0, cycle_time_max_us = 0.0;
  std::string status_text;  ///< one line of status text
  std::string latency;      ///< delays of the run in words; empty = not known
  HandBudget budget;
  std::optional<Singularity> singularity;
  RunState run_state;
  SafetyView safety;
  std::optional<Ghost> ghost;
  std::optional<TeleoperationView> teleoperation;
};

}  // namespace hg::viewer_server
