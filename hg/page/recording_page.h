/// Recording as a page sees it: played at a chosen speed, forward and back, alone or with another
/// recording as its ghost.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "hg/analysis/fault_figures.h"
#include "hg/config/simulation/scenario.h"
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
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
};

}  // namespace hg::page
