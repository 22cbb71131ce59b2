/// Files written by a run: its recording and, after a fault, its last seconds.
///
/// Used by the observer thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/simulation/scenario.h"
#include "hg/recording/flight_recorder.h"
#include "hg/recording/recorder.h"

namespace hg::apps {

/// Message when a recording is wanted but not available.
inline constexpr char kNoRecording[] = "recording   off (the program was built without Rust)\n";

class RunRecording {
 public:
  /// Starts the recording; prints on stdout why there is none. Throws SetupError.
  RunRecording(const config::Scenario& scenario, const RunArguments& arguments);

  /// Recorder of the run; nullptr = not recorded.
  const recording::Recorder* recorder() const { return recorder_.get(); }
  /// Records every sample, in order.
  void push(const Sample& sample);
  void event(double time_s, std::string_view name, std::string_view text);
  /// Reason, returned once, why the recording has ended during the run; empty = no news.
  std::string news();
  struct Result {
    std::string file;              ///< recording file; empty = none
    std::uint64_t unrecorded = 0;  ///< number of samples missing in the recording
    std::string error;     ///< reason why the recording ended before the run; empty = it did not
    bool is_whole = true;  ///< all files were written completely
  };
  /// Completes all files, prints messages about them and returns the result.
  Result close();

 private:
  void keep_last_seconds(const Sample& sample);
  void close_recorder(Result& result);
  void close_flight(Result& result);

  const bool is_fast_, writes_always_;
  const std::string program_;
  std::unique_ptr<recording::Recorder> recorder_;
  std::unique_ptr<recording::FlightRecorder> flight_;
  bool has_told_ = false;
  FaultCode fault_ = FaultCode::kNone;  ///< fault of the last sample
  std::string cause_;                   ///< cause of a stop that is not written yet; empty = none
  double write_at_s_ = 0.0;
};

}  // namespace hg::apps
