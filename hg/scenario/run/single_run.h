/// Plays one prepared run, from its clock's start to its summary.
#pragma once

#include <atomic>

#include "hg/lab_streaming/liblsl.h"
#include "hg/page/run_page.h"
#include "hg/scenario/run/prepared_run.h"
#include "hg/scenario/run/run_observer.h"
#include "hg/scenario/run/run_plan.h"
#include "hg/scenario/run/run_player.h"

namespace hg::scenario {

/// What a run is played with.
struct RunSetting {
  const RunPlan& plan;
  const RunHost& host;
  RunObserver& observer;
  const std::atomic<bool>& stop;
  page::RunPage* page = nullptr;                  ///< nullptr = none
  const lab_streaming::Liblsl* liblsl = nullptr;  ///< nullptr = no streams
  std::string fixed_by;  ///< why pages change nothing about the run; empty = they may
};

/// Plays it, and then waits for what its page chooses next. Throws SetupError before the device
/// moves.
RunOutcome play_single(PreparedRun& run, const RunSetting& setting);

}  // namespace hg::scenario
