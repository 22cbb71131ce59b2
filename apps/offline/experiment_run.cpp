#include "apps/offline/experiment_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/run_data.h"
#include "hg/analysis/summary.h"
#include "hg/recording/recorder.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/recorded/run_recording.h"
#include "hg/scenario/run.h"
#include "hg/simulator/simulated_device.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds kIdle(2);

// The recorder of an experiment, whose file says nothing of the wall clock.
std::unique_ptr<recording::Recorder> make_recorder(const config::Scenario& scenario,
                                                   const ExperimentRun& arguments) {
  if (!recording::recording_available()) {
    print_out("recording   {}\n", scenario::kNoRecording);
    return nullptr;
  }
  recording::RecordingInfo info = recording_info(scenario, arguments.world, arguments.folder);
  info.start = {};
  info.is_reproducible = true;
  return std::make_unique<recording::Recorder>(info);
}

// Renames the recording to the usual name in its own folder; returns what went wrong.
std::vector<std::string> settle(recording::Recorder& recorder, const fs::path& folder) {
  const recording::RecordingSummary recorded = recorder.close();
  std::error_code error, ignored;
  const fs::path link = folder / "latest.mcap";
  if (fs::is_symlink(link, ignored)) fs::remove(link, ignored);
  fs::rename(recorded.file, folder / "recording.mcap", error);
  std::vector<std::string> failures;
  for (const std::string& why : {recorded.error, error ? error.message() : std::string()}) {
    if (!why.empty()) failures.push_back("recording.mcap: " + why);
  }
  return failures;
}

/// The simulated machine of an experiment, and where the body of its person went.
class FilmedDevice final : public device::Device {
 public:
  explicit FilmedDevice(const config::Scenario& scenario)
      : device_(scenario::make_simulation(scenario)),
        period_(scenario.device.model.dt()),
        doorway_(scenario.script.script.walk.doorway),
        joint_(scenario.twin.model.chain.joints()[doorway_.joint].name),
        walks_through_(scenario.person == person::PersonKind::kScript &&
                       scenario.script.script.walk.kind == person::WalkKind::kDoorway) {
    if (walks_through_) film_.reserve(kFramesMax);
  }

  void read(SensorFrame& sensors) noexcept override { device_.read(sensors); }
  void write(const CommandFrame& command) noexcept override {
    device_.write(command);
    time_s_ += period_;
    if (!walks_through_ || film_.size() == kFramesMax || time_s_ < due_s_) return;
    due_s_ += kFrame_s;
    const person::Person& person = device_.simulation().person();
    if (!person.is_holding(time_s_)) return;
    const person::Walker& walker = person.walker();
    film_.push_back(
        {time_s_, walker.body().x(), walker.body().y(), walker.heading(), walker.hold()});
  }
  const Truth* truth() const noexcept override { return device_.truth(); }

  /// The doorway and the body that went through it; null: none.
  Json person() const {
    if (!walks_through_) return nullptr;
    const auto pair = [](const Eigen::Vector2d& p) { return Json{p.x(), p.y()}; };
    return {{"half_breadth_m", person::kHalfBreadth},
            {"joint", joint_},
            {"hinge_m", pair(doorway_.hinge)},
            {"along", pair(doorway_.along)},
            {"away", pair(doorway_.away)},
            {"leaf_width_m", doorway_.leaf_width},
            {"clear_width_m", doorway_.clear_width},
            {"columns", {"time_s", "x_m", "y_m", "heading_rad", "hold"}},
            {"film", film_}};
  }

 private:
  static constexpr double kFrame_s = 0.01;
  static constexpr std::size_t kFramesMax = 100'000;

  simulator::SimulatedDevice device_;
  double period_;
  person::Doorway doorway_;
  std::string joint_;  ///< hinge of the doorway
  bool walks_through_;
  double time_s_ = 0.0, due_s_ = 0.0;  ///< now, and of the next picture
  std::vector<std::array<double, 5>> film_;
};

/// All observers of the samples of one experiment.
struct Watcher {
  const config::Scenario& scenario;
  Json events;
  analysis::EventDetector detector;
  analysis::Summary summary;
  recording::Columns columns;
  std::unique_ptr<recording::Recorder> recorder;

  void look_at(Sample& sample) {
    summary.add(sample);
    columns.append(sample);
    if (const auto event = detector.observe(sample.record)) {
      summary.add(*event);
      const auto found = std::ranges::find(
          events, event->name, [](const Json& each) { return each["name"].get<std::string>(); });
      if (found != events.end()) {
        (*found)["time_s"] = event->time_s;
        (*found)["points"] = twin_points(scenario, sample.record);
      }
      if (recorder) recorder->event(event->time_s, event->name, event->what);
    }
    sample.cycle_time_us = 0.0;  // differs from run to run
    if (recorder) recorder->push_waiting(sample);
  }
};

Json expected_events(const config::Scenario& scenario) {
  Json events = Json::array();
  for (const EventRule& rule : scenario.events) {
    events.push_back(describe(rule, scenario));
    events.back()["time_s"] = nullptr;
  }
  return events;
}

void show_progress(std::string_view name, double done_s, double total_s) {
  if (isatty(STDERR_FILENO) == 0) return;
  draw_error(done_s >= total_s
                 ? ""
                 : fmt::format("{}: {:.0f} of {:.0f} s simulated", name, done_s, total_s));
}

runtime::RuntimeOptions runtime_options(const config::Scenario& scenario,
                                        const ExperimentRun& arguments) {
  runtime::RuntimeOptions options = scenario::run_options(scenario);
  options.is_fast = true;
  options.duration_s = arguments.duration_s.value_or(options.duration_s);
  runtime::check_runtime_options(options);
  return options;
}

}  // namespace

void play_experiment(const PaperExperiment& experiment, const ExperimentRun& arguments,
                     const std::string& command) {
  const fs::path folder = arguments.folder;
  const config::Scenario scenario = scenario::load(arguments.world);
  const runtime::RuntimeOptions options = runtime_options(scenario, arguments);
  controller::Cycle cycle = scenario::make_cycle(scenario);
  FilmedDevice device(scenario);
  runtime::Runtime runtime(options, cycle, device);
  Watcher watcher{scenario,
                  expected_events(scenario),
                  {scenario.events, scenario.limits},
                  scenario::make_summary(scenario),
                  recording::Columns(signal_names()),
                  make_recorder(scenario, arguments)};

  const auto begin = Clock::now();
  const auto sample = std::make_unique<Sample>();
  runtime.start();
  for (bool is_finished = false; !is_finished;) {
    is_finished = runtime.is_finished();
    while (runtime.pop(*sample)) watcher.look_at(*sample);
    show_progress(experiment.name, sample->record.time_s, options.duration_s);
    if (!is_finished) std::this_thread::sleep_for(kIdle);
  }
  const runtime::RuntimeReport report = runtime.join();
  show_progress(experiment.name, 1.0, 1.0);

  Json run = describe(scenario);
  run["kind"] = experiment.name;
  run["title"] = experiment.title;
  run["source"] = experiment.source;
  run["command"] = command;
  run["version"] = kVersion;
  run["seed"] = scenario.device.simulation.seed;
  run["events"] = watcher.events;
  if (Json person = device.person(); !person.is_null()) run["person"] = std::move(person);
  run["failures"] =
      watcher.recorder ? settle(*watcher.recorder, folder) : std::vector<std::string>();
  write_run(folder, run, watcher.columns);

  analysis::RunFacts facts = scenario::facts_of_run(scenario, options, report);
  facts.version = kVersion;
  facts.wall_time_s = std::chrono::duration<double>(Clock::now() - begin).count();
  write_output((folder / "timing.json").string(),
               watcher.summary.to_json(facts, watcher.detector.missing())
                       .dump(2, ' ', false, nlohmann::json::error_handler_t::replace) +
                   "\n");
}

}  // namespace hg::apps
