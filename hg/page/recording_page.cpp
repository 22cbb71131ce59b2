#include "hg/page/recording_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/page/page_scene.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"
#include "hg/scenario/recorded/robot_models.h"

namespace hg::page {
namespace {

using viewer_server::Command;
using viewer_server::CommandName;

constexpr double kFrame_s = 1.0 / 60.0;  // of the page
constexpr char kRefusal[] = "this is a recording";

config::Scenario scenario_of(const recording::RecordedRun& run) {
  try {
    return scenario::recorded_scenario(run.configuration());
  } catch (const SetupError& error) {
    throw SetupError(recording::to_text(run.losses()) + error.what());
  }
}

// Whether the coordinates of one chain put the links of the other where its own are.
bool moves_alike(const model::ChainModel& one, const model::ChainModel& other) {
  const bool has_same_joints = std::ranges::equal(
      one.joints(), other.joints(),
      [](const auto& a, const auto& b) { return a.name == b.name && a.type == b.type; });
  if (!has_same_joints || one.frame_names() != other.frame_names()) return false;
  model::ChainData first(one);
  model::ChainData second(other);
  for (const double step : {0.0, 0.3}) {  // every joint moved, or none
    const ConfigurationA q =
        one.integrate(one.neutral(), Eigen::VectorXd::Constant(one.nv(), step));
    first.update_poses(q);
    second.update_poses(q);
    for (int i = 0; i < std::ssize(one.frame_names()); ++i) {
      constexpr double kNear = 1e-6;  // m, and of directions
      if ((first.pose(i).p - second.pose(i).p).norm() > kNear) return false;
      if ((first.pose(i).R - second.pose(i).R).norm() > kNear) return false;
    }
  }
  return true;
}

// the second recording is drawn with the links of the first
void require_alike(const config::Scenario& first, const config::Scenario& second) {
  const auto refuse = [](const std::string& what, const config::SourceText& file,
                         const config::SourceText& other) {
    throw SetupError(fmt::format("--compare: both recordings need the same {}, got {} and {}", what,
                                 file.name, other.name));
  };
  if (!moves_alike(first.device.model.chain, second.device.model.chain)) {
    refuse("device", first.device.sources.front(), second.device.sources.front());
  }
  if (!moves_alike(first.twin.model.chain, second.twin.model.chain)) {
    refuse("twin at the same place", first.twin.sources.front(), second.twin.sources.front());
  }
}

std::string speed_rule() {
  return fmt::format("speed: must be {} .. {}", recording::Playback::kSlowest,
                     recording::Playback::kFastest);
}

}  // namespace

RecordingPage::RecordingPage(const std::filesystem::path& file,
                             const std::filesystem::path& compare, double speed)
    : name_(file.filename().string()),
      run_(file, kFrame_s),
      scenario_(scenario_of(run_)),
      names_(scenario::part_names(scenario_)),
      playback_(run_.duration_s()),
      live_(scenario::run_names(scenario_), scenario::link_tree(scenario_),
            scenario_.device.model.rate_Hz, run_.start()) {
  if (!compare.empty()) {
    other_.emplace(compare, kFrame_s);
    require_alike(scenario_, scenario_of(*other_));
  }
  if (!playback_.set_speed(speed)) throw SetupError(speed_rule());
}

viewer_server::Scene RecordingPage::scene() const {
  viewer_server::Scene scene = page_scene(scenario_);
  scene.source = viewer_server::Source::kRecording;
  scene.begin_s = run_.begin_s();
  scene.duration_s = run_.duration_s();
  scene.commands = {CommandName::kPause, CommandName::kResume,  CommandName::kStep,
                    CommandName::kSpeed, CommandName::kRestart, CommandName::kSeek};
  scene.refusal = kRefusal;
  scene.device.urdf_text = text_of(scene.device.urdf);
  if (scene.twin.urdf_text.empty()) scene.twin.urdf_text = text_of(scene.twin.urdf);
  return scene;
}

viewer_server::View RecordingPage::view() {
  if (!analysis_) analysis_.emplace(scenario_);
  viewer_server::View view;
  if (other_) {
    other_->read(other_->at(now_s() - other_->begin_s()), *sample_);
    view.ghost = viewer_server::Ghost{.time_s = sample_->record.time_s,
                                      .record = sample_->record,
                                      .twin_base = sample_->operator_input.twin_base};
  }
  run_.read(run_.at(playback_.position_s()), *sample_);
  view.record = sample_->record;
  view.twin_base = sample_->operator_input.twin_base;
  view.safety = safety_view(*sample_, names_);
  view.teleoperation = teleoperation_view(scenario_, *sample_);
  view.hand = sample_->operator_input.hand_target;
  view.cycle_time_us = view.cycle_time_max_us = sample_->cycle_time_us;
  view.status_text = scenario_.description;
  view.budget = analysis_->budget(view.record);
  view.singularity = analysis_->singularity(view.record);
  view.run_state = {playback_.is_paused(), playback_.speed(), playback_.is_over(), now_s(), name_};
  return view;
}

live::Batch RecordingPage::live_batch(const live::Wanted& wanted) {
  const std::size_t index = run_.at(playback_.position_s());
  const bool is_new = live_sample_ != index || wanted_ != wanted;
  wanted_ = wanted;
  live_sample_ = index;
  if (!is_new) return {};
  run_.read(index, *sample_);
  live_.observe(*sample_);
  live::Batch batch = live_.batch(*sample_, wanted);
  for (const recording::Event& event : run_.events()) {
    if (event.time_s > live_s_ && event.time_s <= now_s()) {
      batch.messages.push_back(live_.event(event.time_s, event.name, event.text));
    }
  }
  live_s_ = now_s();
  return batch;
}

std::vector<live::Message> RecordingPage::live_descriptions() {
  return {
      live_.description(live::Topic::kDeviceDescription, scenario::device_description(scenario_)),
      live_.description(live::Topic::kTwinDescription, scenario::twin_description(scenario_))};
}

std::string RecordingPage::obey(const Command& command) {
  switch (command.name) {
    case CommandName::kPause:
      playback_.pause();
      return {};
    case CommandName::kResume:
      playback_.resume();
      return {};
    case CommandName::kStep:
      playback_.pause();
      playback_.move(command.value * kFrame_s);
      return {};
    case CommandName::kSpeed:
      return playback_.set_speed(command.value) ? "" : speed_rule();
    case CommandName::kRestart:
      return playback_.seek(0.0) ? "" : "there is nothing to play";
    case CommandName::kSeek:
      return seek(command.value);
    default:
      return kRefusal;
  }
}

// ends are met up to rounding
std::string RecordingPage::seek(double time_s) {
  const double offset = time_s - run_.begin_s();
  const double nearest = std::clamp(offset, 0.0, playback_.duration_s());
  if (std::abs(offset - nearest) < 1e-6 && playback_.seek(nearest)) {
    live_s_ = now_s();
    return {};
  }
  return fmt::format("the recording has {:.3f} .. {:.3f} s", run_.begin_s(),
                     run_.begin_s() + playback_.duration_s());
}

// a file of the configuration; empty if it is not there
std::string RecordingPage::text_of(const std::filesystem::path& file) const {
  for (const config::SourceText& source : scenario_.sources) {
    if (!file.empty() && source.name == file.string()) return source.content;
  }
  return {};
}

}  // namespace hg::page
