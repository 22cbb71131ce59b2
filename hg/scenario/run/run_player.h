/// Plays a run from its plan: device, recording, page, streams, summary, exit code.
///
///     scenario::RunPlayer player({.world = {.scenario = "door"}, .timing = {.is_fast = true}});
///     const scenario::RunOutcome outcome = player.play(observer, stop);
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hg/lab_streaming/liblsl.h"
#include "hg/live/link_file.h"
#include "hg/page/run_page.h"
#include "hg/scenario/run/move_to_start.h"
#include "hg/scenario/run/prepared_run.h"
#include "hg/scenario/run/run_observer.h"
#include "hg/scenario/run/run_plan.h"
#include "hg/signals/fault.h"

namespace hg::scenario {

/// Who plays a run.
struct RunHost {
  std::string program = "hapticgiant";          ///< as called, for commands in messages
  std::vector<std::string> lab_libraries = {};  ///< files of liblsl, see run_streams.h
};

/// How the last run of a plan has ended.
struct RunOutcome {
  /// 0 fine, 1 an expected event is missing or a limit was exceeded, 3 a fault stopped the device
  /// or it has not come to the start, 4 the recording is incomplete
  int exit_code = 0;
  FaultCode fault = FaultCode::kNone;
  std::string summary;              ///< JSON of --summary; empty = no run was played
  std::filesystem::path recording;  ///< empty = none
};

inline constexpr int kRecordingIncomplete = 4;  ///< exit code instead of 0

class RunPlayer {
 public:
  /// Checks the plan, loads the scenario and connects to the device. Throws SetupError.
  explicit RunPlayer(const RunPlan& plan, const RunHost& host = {});

  /// Plays, once, until the end of the run, or until `stop` is true: then the device is stopped and
  /// all files are completed. Runs that a page starts follow. Throws SetupError for what can be
  /// found out only now, for example a port in use.
  RunOutcome play(RunObserver& observer, const std::atomic<bool>& stop);

 private:
  void open_page(RunObserver& observer);
  std::string come_to_start(RunObserver& observer, const std::atomic<bool>& stop);
  std::string fixed_by() const;

  const RunPlan plan_;
  const RunHost host_;
  std::unique_ptr<lab_streaming::Liblsl> liblsl_;  ///< nullptr = no streams
  PreparedWay way_;                                ///< without a run: none is needed
  /// `last_` until the page shows `present_`; `next_` is chosen by a page
  std::unique_ptr<PreparedRun> last_, present_, next_;
  std::unique_ptr<page::RunPage> page_;   ///< nullptr = none
  std::unique_ptr<live::LinkFile> link_;  ///< by which bridges find this run
};

/// RunPlayer in one call.
RunOutcome play(const RunPlan& plan, RunObserver& observer, const std::atomic<bool>& stop);

}  // namespace hg::scenario
