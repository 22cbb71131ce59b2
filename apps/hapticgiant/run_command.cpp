#include "apps/hapticgiant/run_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/lab_streams.h"
#include "apps/hapticgiant/move_to_start.h"
#include "apps/hapticgiant/open_page.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/prepared_run.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/status_line.h"
#include "apps/hapticgiant/version.h"
#include "hg/analysis/fault_figures.h"
#include "hg/analysis/run_news.h"
#include "hg/analysis/summary.h"
#include "hg/controller/safety/rules.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/live/link_file.h"
#include "hg/page/page_scene.h"
#include "hg/page/run_page.h"
#include "hg/recording/problem_dumps.h"
#include "hg/recording/recording_folder.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"
#include "hg/scenario/options.h"
#include "hg/scenario/recorded/run_recording.h"
#include "hg/scenario/run.h"
#include "hg/viewer_server/meshes.h"

namespace hg::apps {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kIdle(2);
constexpr std::chrono::milliseconds kStatusPeriod(100);
constexpr double kSlowCycle = 0.5;  // of the period

/// All observers of a run outside the control thread.
struct Observers {
  const std::atomic<bool>& interrupted;  ///< ends the run; its recording is completed
  const config::Scenario& scenario;
  analysis::EventDetector detector;
  analysis::Summary summary;
  StatusLine status_line;
  page::RunPage* page;  ///< page; nullptr = none
  scenario::RunRecording recording;
  recording::ProblemDumps dumps;
  std::unique_ptr<lab_streaming::LabStreams> streams;  ///< nullptr = none
  bool is_fast = false;
  /// End of the script, to report if the run continues after it; 0 = it does not
  double script_end_s = 0.0;
  analysis::Names names;
  analysis::RunNews news;
  Clock::time_point last_status = {};
  std::string fault_figures = {};  ///< figures of the summary's fault
};

// reports and records an intervention in the run
void notify(Observers& observers, double time_s, std::string_view name, std::string_view what) {
  observers.status_line.print(fmt::format("{:8.3f} s  {:<18} {}", time_s, name, what));
  observers.recording.event(time_s, name, what);
  if (observers.streams) observers.streams->mark(time_s, name, what);
  if (observers.page != nullptr) observers.page->announce(time_s, name, what);
}

// callback for changes by pages, at the time of `sample`
page::RunPage::Note note(Observers& observers, const Sample& sample) {
  return [&observers, &sample](std::string_view name, const std::string& text) {
    notify(observers, sample.record.time_s, name, text);
  };
}

void observe(Observers& observers, const Sample& sample) {
  if (observers.script_end_s > 0.0 && sample.record.time_s > observers.script_end_s) {
    observers.script_end_s = 0.0;
    observers.status_line.print("the script has played; drag the handle in the page");
  }
  const FaultCode before = observers.summary.fault().code;
  observers.summary.add(sample);
  if (const Fault& fault = observers.summary.fault();
      fault.code != before && safety::is_fault(fault.code)) {
    observers.fault_figures = analysis::figures_of(fault, observers.names, sample.sensors);
  }
  for (const analysis::News& news : observers.news.observe(sample)) {
    notify(observers, sample.record.time_s, news.name, news.text);
  }
  observers.recording.push(sample);
  if (observers.streams) observers.streams->push(sample);
  if (const auto event = observers.detector.observe(sample.record)) {
    observers.summary.add(*event);
    notify(observers, event->time_s, event->name, event->what);
  }
  if (observers.page != nullptr) observers.page->observe(sample, note(observers, sample));
}

// shows the sample at display rate
void show(Observers& observers, const Sample& sample) {
  if (observers.page != nullptr) observers.page->show(sample);
  const auto now = Clock::now();
  if (now - observers.last_status < kStatusPeriod) return;
  observers.last_status = now;
  observers.status_line.show(
      status_text(sample, observers.scenario.limits, observers.scenario.twin.model));
}

void tell_problems(Observers& observers, const std::string& text) {
  if (!text.empty()) observers.status_line.print(text);
}

void check_streams(Observers& observers, double time_s) {
  if (!observers.streams) return;
  const std::string news = observers.streams->news();
  if (!news.empty()) notify(observers, time_s, "lab clock", news);
}

void check_recording(Observers& observers, double time_s) {
  const std::string why = observers.recording.news();
  if (!why.empty()) {
    notify(observers, time_s, "recording", "has ended early, the run continues: " + why);
  }
}

// drains the runtime until it has finished and everything has been seen
void watch(runtime::Runtime& runtime, Observers& observers) {
  auto sample = std::make_unique<Sample>();
  while (true) {
    const bool is_finished = runtime.is_finished();
    bool any = false;
    while (runtime.pop(*sample)) {
      observe(observers, *sample);
      any = true;
    }
    if (any && !observers.is_fast) show(observers, *sample);
    tell_problems(observers, observers.dumps.look_at(runtime.kept_problems()));
    check_recording(observers, sample->record.time_s);
    check_streams(observers, sample->record.time_s);
    if (is_finished) break;
    if (observers.page != nullptr) {
      observers.page->follow(&runtime, note(observers, *sample));
      if (observers.page->has_next()) runtime.request_stop();
    }
    if (!any) std::this_thread::sleep_for(kIdle);
  }
  tell_problems(observers, observers.dumps.finish(runtime.kept_problems()));
  observers.status_line.clear();
}

// `goes_on`: continues after the script, until Ctrl-C
runtime::RuntimeOptions runtime_options(const PreparedRun& run, bool goes_on,
                                        const std::atomic<bool>& interrupted, page::RunPage* page) {
  const RunArguments& arguments = run.arguments;
  runtime::RuntimeOptions options = scenario::run_options(run.scenario);
  options.stop = &interrupted;
  options.is_fast = arguments.is_fast;
  if (!arguments.is_fast)
    options.slow_cycle_us = kSlowCycle * 1e6 / run.scenario.device.model.rate_Hz;
  options.thread = {.priority = arguments.priority, .cpu = arguments.cpu};
  // a simulated device waits for its controller: late cycles do no harm
  options.reports_late_cycles = !arguments.device_address.empty();
  options.duration_s = arguments.duration_s.value_or(goes_on ? 0.0 : options.duration_s);
  if (page != nullptr) options.desk = &page->desk();
  options.stays_in_fault = options.stays_in_fault || page != nullptr;
  if (arguments.is_fast && options.duration_s == 0.0) {
    throw SetupError("run: --fast without a script needs --duration S");
  }
  runtime::check_runtime_options(options);
  return options;
}

scenario::RecordingPlan recording_plan(const PreparedRun& run) {
  const RunArguments& arguments = run.arguments;
  if (arguments.has_recording && !recording::recording_available()) print_out(kNoRecording);
  return {.info = recording_info(run.scenario, arguments),
          .has_recording = arguments.has_recording,
          .has_last_seconds = arguments.flight_recorder != "off",
          .is_always = arguments.flight_recorder == "always",
          .is_waiting = arguments.is_fast};
}

// problem dumps beside the recording, under its name; `stem` is empty without one
recording::ProblemDumps problem_dumps(const PreparedRun& run, const std::string& stem) {
  const RunArguments& arguments = run.arguments;
  const analysis::RunFacts facts = scenario::facts_of_scenario(run.scenario);
  const std::string name = recording_info(run.scenario, arguments).name;
  return recording::ProblemDumps(
      {.folder = arguments.has_recording ? arguments.recordings : "",
       .stem = stem.empty() ? recording::stamped(name, std::chrono::system_clock::now()) : stem,
       .origin = fmt::format("{}, law {}, bounds {}, gantry {}, braking {}", facts.scenario,
                             facts.law, facts.bounds, facts.gantry, facts.braking),
       .program = arguments.program});
}

// prints what became of the files of a run
void print_recorded(const scenario::RunRecording::Result& result, const std::string& program) {
  const recording::RecordingSummary& recorded = result.recording;
  if (!recorded.error.empty()) print_error("recording ended early: {}\n", recorded.error);
  if (!recorded.not_renamed.empty()) {
    print_error("the recording is complete, but keeps its name {}: {}\n", recorded.file.string(),
                recorded.not_renamed);
  }
  if (!recorded.not_linked.empty()) print_out("recording   {}\n", recorded.not_linked);
  for (const auto& name : recorded.deleted) {
    print_out("recording {} deleted to keep within the disk budget\n", name);
  }
  for (const auto& written : result.last_seconds.files) {
    print_out("the last seconds are kept; what happened:\n  {} explain {}\n", program,
              written.string());
  }
  if (!result.last_seconds.error.empty()) {
    print_error("the last seconds could not be written: {}\n", result.last_seconds.error);
  }
}

int exit_code(const analysis::Summary& summary, const std::vector<std::string>& missing,
              bool was_interrupted) {
  if (summary.fault().code != FaultCode::kNone) return 3;
  if (was_interrupted) return 0;
  return missing.empty() && summary.limits_held() && !summary.has_shaken() ? 0 : 1;
}

// the page of a run that a fault or the page itself has ended offers to start again
void wait_for_next(Observers& observers, bool goes_on) {
  page::RunPage* page = observers.page;
  if (page == nullptr || page->has_next()) return;
  const bool has_fault = observers.summary.fault().code != FaultCode::kNone;
  if (!page->stop_was_asked() && !page->is_preparing() && !(goes_on && has_fault)) return;
  print_out("the run is over; start it again in the page, or end with Ctrl-C\n");
  const Sample none;
  while (!observers.interrupted.load() && !page->has_next() && (goes_on || page->clients() > 0)) {
    page->follow(nullptr, note(observers, none));
    std::this_thread::sleep_for(10 * kIdle);
  }
}

std::unique_ptr<page::RunPage> open_page(const PreparedRun& run, page::RunPage::Prepare prepare) {
  const RunArguments& arguments = run.arguments;
  if (!arguments.has_viewer || arguments.is_fast) return nullptr;
  viewer_server::ServerOptions options;
  options.page = find_page();
  if (options.page.empty()) return nullptr;
  options.address = arguments.address;
  options.port = arguments.port;
  options.embedders = arguments.embedders;
  return std::make_unique<page::RunPage>(options, run.shown(), std::move(prepare));
}

// what a page cannot draw of device and twin
void tell_missing_meshes(const config::Scenario& scenario) {
  const viewer_server::Scene scene = page::page_scene(scenario);
  for (const viewer_server::SceneChain* chain : {&scene.device, &scene.twin}) {
    if (chain->urdf.empty()) continue;
    const auto missing = viewer_server::missing_meshes(
        chain->urdf, chain->urdf_text.empty() ? read_file(chain->urdf) : chain->urdf_text);
    if (missing.empty()) continue;
    print_out(
        "note        {}: {} of its meshes are not there, the first is {}: the page draws bars. Set "
        "ROS_PACKAGE_PATH to the folder that holds the package\n",
        chain->urdf.filename().string(), missing.size(), missing.front());
  }
}

// to its end and its summary; the exit code
int play(PreparedRun& run, const std::atomic<bool>& interrupted, const BackgroundOutput& output,
         page::RunPage* page, const lab_streaming::Liblsl* liblsl) {
  const RunArguments& arguments = run.arguments;
  const config::Scenario& scenario = run.scenario;
  const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  const bool goes_on = is_terminal && page != nullptr && !arguments.is_trial();
  const runtime::RuntimeOptions options = runtime_options(run, goes_on, interrupted, page);
  auto streams = liblsl == nullptr ? nullptr : open_lab_streams(*liblsl, scenario);
  // after all that may refuse the run, which then leaves no file
  const scenario::RecordingPlan plan = recording_plan(run);
  scenario::RunRecording recording(plan);
  const std::string stem = recording.stem();
  if (page != nullptr) {
    page->begin(run.shown(), stem.empty() ? "" : stem + ".mcap", plan.info.start);
  }
  Observers observers{
      .interrupted = interrupted,
      .scenario = scenario,
      .detector = {scenario.events, scenario.limits},
      .summary = scenario::make_summary(scenario),
      .status_line = StatusLine(is_terminal, output),
      .page = page,
      .recording = std::move(recording),
      .dumps = problem_dumps(run, stem),
      .streams = std::move(streams),
      .is_fast = arguments.is_fast,
      .script_end_s = options.duration_s == 0.0 ? scenario::planned_duration_s(scenario) : 0.0,
      .names = scenario::part_names(scenario),
      .news = analysis::RunNews(scenario::part_names(scenario))};
  const std::string ideal =
      run.remote == nullptr ? scenario::idealisation(scenario.device) : std::string();
  print_out(fmt::format("HapticGiant {}  {}{}\n", kVersion, scenario.title,
                        ideal.empty() ? "" : fmt::format("  ({})", ideal)));
  if (run.remote != nullptr && !scenario::notices_frozen_sensors(scenario.device)) {
    print_out(
        "note        frozen sensors are not noticed (rule 105): simulation.yaml says that they "
        "have no noise, or monitor.frozen_samples is 0\n");
  }
  if (page != nullptr) tell_missing_meshes(scenario);
  if (options.duration_s == 0.0) print_out("stop        Ctrl-C\n");
  if (!run.computer.empty()) notify(observers, 0.0, "computer", run.computer);
  if (run.machine != nullptr) {
    notify(observers, 0.0, "start test", run.start_test);
    notify(observers, 0.0, "posture", run.posture);
  } else if (run.remote != nullptr) {
    print_out(fmt::format("note        {}\n", run.note));
  }

  runtime::Runtime runtime(options, run.cycle, *run.device);
  const auto begin = Clock::now();
  runtime.start();
  watch(runtime, observers);
  const runtime::RuntimeReport report = runtime.join();
  std::vector<std::string> about_machine;
  if (run.machine != nullptr) {
    about_machine = start_test::leave_machine(machine_memory(arguments), scenario.device,
                                              *run.machine, observers.summary.fault().code);
  }
  if (run.remote != nullptr) close_device(*run.remote, observers.summary.fault());

  const scenario::RunRecording::Result recorded = observers.recording.close();
  print_recorded(recorded, arguments.program);
  std::optional<lab_streaming::StreamCounts> streamed;
  if (observers.streams) streamed = observers.streams->close();
  analysis::RunFacts facts = scenario::facts_of_run(scenario, options, report);
  facts.version = kVersion;
  if (run.remote != nullptr) {
    facts.link = run.remote->counts();
    facts.plant.clear();
    facts.sensors.clear();
  }
  facts.recording = recorded.recording.file.string();
  facts.unrecorded = recorded.recording.dropped;
  facts.recording_error = recorded.recording.error;
  facts.fault_figures = observers.fault_figures;
  facts.wall_time_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::vector<std::string> missing = observers.detector.missing();
  print_out(fmt::format("\n{}{}", observers.summary.to_text(facts, missing),
                        observers.dumps.summary(runtime.kept_problems())));
  if (streamed) print_streamed(*streamed);
  if (run.machine != nullptr) print_out(fmt::format("  start test   {}\n", run.start_test));
  if (!run.computer.empty()) print_out(fmt::format("  computer     {}\n", run.computer));
  for (const std::string& line : about_machine) print_out(fmt::format("  {}\n", line));
  bool is_written = recorded.is_whole();
  try {
    if (!arguments.summary.empty()) {
      nlohmann::ordered_json json = observers.summary.to_json(facts, missing);
      json["configuration"] = scenario::hash_of(scenario.sources);
      json["interrupted"] = interrupted.load();
      write_output(arguments.summary, json.dump(2) + "\n");
    }
  } catch (const SetupError& error) {
    print_error("{}\n", error.what());
    is_written = false;
  }
  const bool was_ended = page != nullptr && (page->has_next() || page->stop_was_asked());
  const int code = exit_code(observers.summary, missing, interrupted.load() || was_ended);
  if (!arguments.is_trial()) wait_for_next(observers, goes_on);
  return code == 0 && !is_written ? kNotWritten : code;
}

}  // namespace

int run(const RunArguments& arguments) {
  check_writable(arguments.summary, kJson);
  const std::unique_ptr<lab_streaming::Liblsl> liblsl =
      arguments.has_lab_streams ? load_liblsl() : nullptr;
  auto present =
      moves_by_law(arguments) ? prepare_way(arguments) : std::make_unique<PreparedRun>(arguments);
  const std::atomic<bool>& interrupted = watch_interruption();
  const BackgroundOutput output(interrupted);
  std::unique_ptr<PreparedRun> last, next;  // `last` until the page shows the next one
  const auto page = open_page(*present, [&](const scenario::ScenarioOptions& world) {
    RunArguments changed = arguments;
    changed.world = world;
    next = std::make_unique<PreparedRun>(changed);
  });
  std::unique_ptr<live::LinkFile> link;  // by which bridges find this run
  if (page) {
    present_page(page->url(), arguments.address, arguments.opens_browser);
    link = std::make_unique<live::LinkFile>(live::live_address(page->url()));
    if (!link->problem().empty())
      print_out("note        bridges need --live: {}\n", link->problem());
  }
  if (moves_by_law(arguments)) {
    const std::uint32_t stops = page ? page->desk().stops() : 0;
    std::string problem = move_to_start(*present, interrupted, output, page.get());
    last = std::exchange(present, nullptr);
    if (problem.empty()) present = std::make_unique<PreparedRun>(arguments);
    // a stop that came while it was prepared is one for it, too
    if (problem.empty() && page && page->desk().stops() != stops) problem = "it was stopped";
    if (!problem.empty()) {
      print_error("--move-to-start: {}; the run does not begin\n", problem);
      return kNotThere;
    }
  }
  while (true) {
    const int code = play(*present, interrupted, output, page.get(), liblsl.get());
    if (!page || interrupted.load() || !page->take_next()) return code;
    last = std::move(present);
    present = std::move(next);
  }
}

}  // namespace hg::apps
