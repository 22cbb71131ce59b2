/// --move-to-start: the way of a remote device to where the twin starts, by the law.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "hg/page/run_page.h"
#include "hg/scenario/run/prepared_run.h"
#include "hg/scenario/run/run_observer.h"
#include "hg/scenario/run/run_plan.h"
#include "hg/scenario/start_posture.h"

namespace hg::scenario {

constexpr int kNotThere = 3;  ///< exit code of a run whose device has not come to the start

/// Why pages change nothing about the way.
inline constexpr char kMovesItself[] = "the device moves to the start on its own";

/// A run along the way, prepared.
struct PreparedWay {
  std::unique_ptr<PreparedRun> run;
  Start goal;  ///< where it ends
};

/// Prepares the way of the run from where its device stands. Throws SetupError, also when the
/// device cannot be at the start of the twin.
PreparedWay prepare_way(const ScenarioOptions& world, const MachineAddress& machine,
                        const RunTiming& timing, const RunRecords& records);

/// Plays a way to its end, and releases the device; `page`: nullptr = none. The data of a machine
/// are stored in `memory`. Returns why the device is not at the start; empty = it is.
std::string move_to_start(PreparedWay& way, const RunTiming& timing,
                          const start_test::MachineMemory& memory, page::RunPage* page,
                          RunObserver& observer, const std::atomic<bool>& stop);

}  // namespace hg::scenario
