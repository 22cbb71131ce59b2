#include "apps/hapticgiant/replay_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/hapticgiant/experiments/rerun.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/option_checks.h"
#include "apps/hapticgiant/run_page.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/status_line.h"
#include "hg/core/error.h"
#include "hg/page/hand_analysis.h"
#include "hg/page/page_scene.h"
#include "hg/recording/playback.h"
#include "hg/recording/recording_reader.h"

namespace hg::apps {
namespace {

using viewer_server::Command;
using viewer_server::CommandName;

constexpr double kFrame_s = 1.0 / 60.0;  // of the page
constexpr std::chrono::milliseconds kIdle(4);

config::Scenario scenario_of(const recording::RecordedRun& run) {
  try {
    return recorded_scenario(run.configuration());
  } catch (const SetupError& error) {
    throw SetupError(recording::to_text(run.losses()) + error.what());
  }
}

/// One recording and, if it is compared, the other.
class Show {
 public:
  explicit Show(const ReplayArguments& arguments)
      : run_(arguments.file, kFrame_s),
        scenario_(scenario_of(run_)),
        names_(scenario::part_names(scenario_)),
        playback_(run_.duration_s()),
        sample_(std::make_unique<Sample>()) {
    if (!arguments.compare.empty()) other_.emplace(arguments.compare, kFrame_s);
    if (!playback_.set_speed(arguments.speed)) throw SetupError(speed_rule());
    name_ = std::filesystem::path(arguments.file).filename().string();
  }

  const recording::RecordedRun& run() const { return run_; }
  const config::Scenario& scenario() const { return scenario_; }
  void advance(double elapsed_s) { playback_.advance(elapsed_s); }

  viewer_server::Scene scene() const {
    viewer_server::Scene scene = page::page_scene(scenario_);
    scene.source = viewer_server::Source::kRecording;
    scene.begin_s = run_.begin_s();
    scene.duration_s = run_.duration_s();
    scene.commands = {CommandName::kPause, CommandName::kResume,  CommandName::kStep,
                      CommandName::kSpeed, CommandName::kRestart, CommandName::kSeek};
    scene.refusal = kRefusal;
    scene.device.urdf_text = text_of(scene.device.urdf);
    scene.twin.urdf_text = text_of(scene.twin.urdf);
    return scene;
  }

  // Current view of the page.
  viewer_server::View view(page::HandAnalysis& analysis) {
    const std::size_t index = run_.at(playback_.position_s());
    viewer_server::View view;
    if (other_) {
      const std::size_t shown = other_->at(now_s() - other_->begin_s());
      other_->read(shown, *sample_);
      view.ghost = viewer_server::Ghost{sample_->record.time_s, sample_->record};
    }
    run_.read(index, *sample_);
    view.record = sample_->record;
    view.safety = page::safety_view(*sample_, names_);
    view.hand = sample_->operator_input.hand_target;
    view.cycle_time_us = view.cycle_time_max_us = sample_->cycle_time_us;
    view.status_text = scenario_.description;
    view.budget = analysis.budget(view.record);
    view.singularity = analysis.singularity(view.record);
    view.run_state = {playback_.is_paused(), playback_.speed(), playback_.is_over(), now_s(),
                      name_};
    return view;
  }

  // Executes a command; returns the reason for a refusal, empty = executed.
  std::string obey(const Command& command) {
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

 private:
  // in the time of the run
  double now_s() const { return run_.begin_s() + playback_.position_s(); }

  // ends are met up to rounding
  std::string seek(double time_s) {
    const double offset = time_s - run_.begin_s();
    const double nearest = std::clamp(offset, 0.0, playback_.duration_s());
    if (std::abs(offset - nearest) < 1e-6 && playback_.seek(nearest)) return {};
    return fmt::format("the recording has {:.3f} .. {:.3f} s", run_.begin_s(),
                       run_.begin_s() + playback_.duration_s());
  }

  static constexpr char kRefusal[] = "this is a recording";

  // a file of the configuration; empty if it is not there
  std::string text_of(const std::filesystem::path& file) const {
    for (const config::SourceText& source : scenario_.sources) {
      if (!file.empty() && source.name == file.string()) return source.content;
    }
    return {};
  }

  static std::string speed_rule() {
    return fmt::format("speed: must be {} .. {}", recording::Playback::kSlowest,
                       recording::Playback::kFastest);
  }

  recording::RecordedRun run_;
  std::optional<recording::RecordedRun> other_;
  config::Scenario scenario_;
  analysis::Names names_;
  recording::Playback playback_;
  std::string name_;
  std::unique_ptr<Sample> sample_;
};

void print_content(const Show& show) {
  print_out(fmt::format("{}\n{}\n", show.scenario().title, show.scenario().description));
  print_out("duration    {:.3f} s\n{}", show.run().duration_s(),
            recording::to_text(show.run().losses()));
  for (const recording::Event& event : show.run().events()) {
    print_out(fmt::format("{:8.3f} s  {:<18} {}\n", event.time_s, event.name, event.text));
  }
}

void play(Show& show, viewer_server::ViewerServer& server, const std::atomic<bool>& interrupted) {
  using Clock = std::chrono::steady_clock;
  page::HandAnalysis analysis(show.scenario());
  for (const recording::Event& event : show.run().events()) {
    server.announce_event(event.time_s, event.name, event.text);
  }
  for (auto last = Clock::now(); !interrupted.load(); std::this_thread::sleep_for(kIdle)) {
    for (const Command& command : server.take_commands()) {
      server.answer(command, show.obey(command));
    }
    const auto now = Clock::now();
    show.advance(std::chrono::duration<double>(now - std::exchange(last, now)).count());
    if (server.is_due()) server.publish(show.view(analysis));
  }
}

// whether the cycle still gives what it gave
int run_again(const std::string& file) {
  const Rerun result = rerun(file);
  print_out(result.is_same
                ? fmt::format("run again   {} cycles, the same bit for bit\n", result.cycles)
                : fmt::format("run again   {}\n            {} cycles are the same\n", result.text,
                              result.cycles));
  return result.is_same ? 0 : 1;
}

}  // namespace

int replay(const ReplayArguments& arguments) {
  Show show(arguments);
  if (!arguments.has_view) {
    print_content(show);
    return run_again(arguments.file);
  }
  const std::atomic<bool>& interrupted = watch_interruption();
  const BackgroundOutput output(interrupted);
  print_content(show);
  viewer_server::ServerOptions options;
  options.page = find_page();
  if (options.page.empty()) return 0;
  options.address = arguments.address;
  options.port = arguments.port;
  viewer_server::ViewerServer server(options, show.scene());
  present_page(server.url(), arguments.address, arguments.opens_browser);
  print_out("stop        Ctrl-C\n");
  play(show, server, interrupted);
  return 0;
}

void add_replay(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command = app.add_subcommand(
      "replay", "Runs the cycle of a recording again, bit for bit; or look at it again.");
  command->footer(
      "Examples:\n"
      "  hapticgiant replay recordings/latest.mcap        does the cycle still give the same?\n"
      "  hapticgiant replay recordings/latest.mcap --view\n"
      "  hapticgiant replay one.mcap --compare two.mcap --view --speed 0.5");
  command->add_option("file", arguments->file, "recording of hapticgiant run")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::Option* view = command->add_flag("--view", arguments->has_view,
                                        "in the page, with play, pause and scrubbing");
  command
      ->add_option("--compare", arguments->compare, "a second recording, shown through the first")
      ->needs(view)
      ->check(CLI::ExistingFile);
  command->add_option("--speed", arguments->speed, "recorded seconds per second, 0.1..8")
      ->needs(view)
      ->check(number_that("from 0.1 to 8", [](double v) { return v >= 0.1 && v <= 8.0; }));
  command->add_option("--bind", arguments->address, "as in run")
      ->needs(view)
      ->transform(without_brackets)
      ->capture_default_str();
  command->add_option("--port", arguments->port, "as in run")
      ->needs(view)
      ->check(whole_number(0.0, 65535.0));
  command->add_flag("!--no-browser", arguments->opens_browser, "as in run");
  command->callback([arguments, &exit_code] { exit_code = replay(*arguments); });
}

}  // namespace hg::apps
