/// Everything outside the control thread that follows one run: events, summary, recording, streams,
/// page and observer.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/analysis/events.h"
#include "hg/analysis/fault_figures.h"
#include "hg/analysis/latency.h"
#include "hg/analysis/run_news.h"
#include "hg/analysis/summary.h"
#include "hg/device/connected_device.h"
#include "hg/lab_streaming/lab_streams.h"
#include "hg/page/run_page.h"
#include "hg/recording/problem_dumps.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/recorded/run_recording.h"
#include "hg/scenario/run/run_observer.h"

namespace hg::scenario {

/// What a watch passes samples on to.
struct WatchParts {
  RunObserver& observer;  ///< must outlive the watch, as `scenario` and `page`
  const config::Scenario& scenario;
  page::RunPage* page = nullptr;                    ///< nullptr = none
  const device::ConnectedDevice* remote = nullptr;  ///< nullptr = simulated here
  RunRecording recording;
  recording::ProblemDumps dumps;
  std::unique_ptr<lab_streaming::LabStreams> streams;  ///< nullptr = none
  /// End of the script, to report if the run continues after it; 0 = it does not
  double script_end_s = 0.0;
};

class RunWatch {
 public:
  explicit RunWatch(WatchParts parts);

  /// Reports and records an intervention in the run.
  void notify(double time_s, std::string_view name, std::string_view what);
  /// Drains the runtime until it has finished and everything has been seen.
  void watch(runtime::Runtime& runtime);
  /// Follows the commands of the page after the run.
  void follow_page();

  const analysis::Summary& summary() const { return summary_; }
  /// Figures of the summary's fault; empty = none.
  const std::string& fault_figures() const { return fault_figures_; }
  analysis::Latency latency() const { return latency_.latency(); }
  std::vector<std::string> missing() const { return detector_.missing(); }
  RunRecording& recording() { return parts_.recording; }
  const recording::ProblemDumps& dumps() const { return parts_.dumps; }
  /// Sends the rest of the streams; empty without any.
  std::optional<lab_streaming::StreamCounts> close_streams();

 private:
  void observe(const Sample& sample);
  void observe_fault(const Sample& sample);
  void show(const Sample& sample);
  void look_at_latency();
  void report_latency(double time_s);
  void check_parts(const runtime::Runtime& runtime, double time_s);
  page::RunPage::Note note_at(const Sample& sample);

  WatchParts parts_;
  analysis::Names names_;
  analysis::EventDetector detector_;
  analysis::Summary summary_;
  analysis::RunNews news_;
  analysis::LatencyWatch latency_;
  std::optional<Mode> mode_;
  std::chrono::steady_clock::time_point last_status_ = {}, last_latency_ = {};
  std::string fault_figures_;
};

}  // namespace hg::scenario
