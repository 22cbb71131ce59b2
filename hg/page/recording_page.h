/// Recording as pages and live clients see it: played at a chosen speed, forward and back, alone or
/// with another recording as its ghost, which only pages see.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hg/analysis/fault_figures.h"
#include "hg/config/simulation/scenario.h"
#include "hg/live/publisher.h"
#include "hg/page/hand_analysis.h"
#include "hg/recording/playback.h"
#include "hg/recording/recording_reader.h"
#include "hg/viewer_server/scene.h"
#include "hg/viewer_server/view.h"

namespace hg::page {

class RecordingPage {
 public:
  /// Opens a recording, and the one to `compare` it with, which is empty for none. Throws
  /// SetupError.
  RecordingPage(const std::filesystem::path& file, const std::filesystem::path& compare,
                double speed);

  const recording::RecordedRun& run() const { return run_; }
  const config::Scenario& scenario() const { return scenario_; }

  viewer_server::Scene scene() const;
  /// Plays on by `elapsed_s` of the wall clock.
  void advance(double elapsed_s) { playback_.advance(elapsed_s); }
  /// The present view.
  viewer_server::View view();
  /// Messages of the present sample, and of the events that were passed since the last call, unless
  /// by a jump; none while both sample and `wanted` are those of the last call. Their times are
  /// those of the recording: they go back where the playback does.
  live::Batch live_batch(const live::Wanted& wanted);
  /// The next live_batch() has the present sample in any case: all clients have gone.
  void forget_live() { wanted_.reset(); }
  /// The URDFs, for each client that comes.
  std::vector<live::Message> live_descriptions();
  /// Executes a command; returns the reason for a refusal, empty = executed.
  std::string obey(const viewer_server::Command& command);

 private:
  double now_s() const { return run_.begin_s() + playback_.position_s(); }  // in time of the run
  std::string seek(double time_s);
  std::string text_of(const std::filesystem::path& file) const;

  std::string name_;
  recording::RecordedRun run_;
  std::optional<recording::RecordedRun> other_;
  config::Scenario scenario_;
  analysis::Names names_;
  std::optional<HandAnalysis> analysis_;  ///< made with the first view
  recording::Playback playback_;
  live::Publisher live_;
  live::Wanted wanted_;                     ///< of the last batch
  std::optional<std::size_t> live_sample_;  ///< of the last batch
  double live_s_ = -1.0;                    ///< run time up to which live clients have the events
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
};

}  // namespace hg::page
