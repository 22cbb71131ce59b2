/// Files written by a run: its recording and, after a fault, its last seconds.
///
/// Used by the observer thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "hg/recording/flight_recorder.h"
#include "hg/recording/recorder.h"
#include "hg/signals/state.h"

namespace hg::scenario {

/// Message where a recording is wanted and not available.
inline constexpr char kNoRecording[] = "off (the program was built without Rust)";

/// What is written of a run; set-up data.
struct RecordingPlan {
  recording::RecordingInfo info;
  bool has_recording = true;     ///< the whole run
  bool has_last_seconds = true;  ///< the last seconds, after a fault or an error of the recording
  bool is_always = false;        ///< the last seconds, however the run ends
  bool is_waiting = false;       ///< the run waits for its recording; not in real time
};

class RunRecording {
 public:
  /// Starts the recording; without Rust nothing is written. Throws SetupError.
  explicit RunRecording(const RecordingPlan& plan);

  /// File name of the recording without extensions; empty = not recorded.
  std::string stem() const { return recorder_ ? recorder_->stem() : ""; }
  /// Records every sample, in order.
  void push(const Sample& sample);
  void event(double time_s, std::string_view name, std::string_view text);
  void lab_clock(const recording::LabClock& clock);
  /// Reason, returned once, why the recording has ended during the run; empty = no news.
  std::string news();

  struct Result {
    recording::RecordingSummary recording;  ///< empty without a recording
    recording::FlightRecorder::Result last_seconds;
    bool is_whole() const;  ///< all files were written completely, with their names
  };
  /// Completes all files.
  Result close();

 private:
  void keep_last_seconds(const Sample& sample);

  bool is_always_, is_waiting_;
  std::unique_ptr<recording::Recorder> recorder_;
  std::unique_ptr<recording::FlightRecorder> flight_;
  bool has_reported_ = false;
  FaultCode fault_ = FaultCode::kNone;  ///< fault of the last sample
  std::string cause_;                   ///< cause of a stop that is not written yet; empty = none
  double write_at_s_ = 0.0;
};

}  // namespace hg::scenario
