/// What a run leaves on the disk: its recording and, after a fault, its last seconds.
///
/// For the observer thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "apps/hapticgiant/run_command.h"
#include "hg/config/scenario.h"
#include "hg/recording/flight_recorder.h"
#include "hg/recording/recorder.h"

namespace hg::apps {

/// What is said where a recording is wanted and cannot be made.
inline constexpr char kNoRecording[] = "recording   off (the program was built without Rust)\n";

class RunRecording {
 public:
  /// Says on stdout why there is no recording. Throws SetupError.
  RunRecording(const config::Scenario& scenario, const RunArguments& arguments);

  /// nullptr: the run is not recorded.
  const recording::Recorder* recorder() const { return recorder_.get(); }
  /// Every sample, in their order.
  void push(const Sample& sample);
  void event(double time_s, std::string_view name, std::string_view text);
  /// Told once: why the recording has ended while the run goes on; empty = nothing new.
  std::string news();
  struct Result {
    std::string file;              ///< the recording; empty = there is none
    std::uint64_t unrecorded = 0;  ///< samples that are not in it
    std::string error;             ///< why it ended before the run; empty = it did not
    bool is_whole = true;          ///< of everything that was to be written
  };
  /// Completes all files and says what there is to say about them.
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
  FaultCode fault_ = FaultCode::kNone;  ///< of the last sample
  std::string cause_;                   ///< of a stop that is not written yet; empty = none
  double write_at_s_ = 0.0;
};

}  // namespace hg::apps
