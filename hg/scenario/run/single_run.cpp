#include "hg/scenario/run/single_run.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/page/page_scene.h"
#include "hg/recording/recording_folder.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"
#include "hg/scenario/recorded/run_recording.h"
#include "hg/scenario/run.h"
#include "hg/scenario/run/run_streams.h"
#include "hg/scenario/run/run_watch.h"
#include "hg/scenario/run/version.h"
#include "hg/viewer_server/meshes.h"

namespace hg::scenario {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kIdle(20);
constexpr double kSlowCycle = 0.5;  // of the period

// Whether the run continues after its script.
bool continues(const RunSetting& setting) {
  return setting.plan.timing.continues && setting.page != nullptr && !setting.plan.page.is_trial();
}

runtime::RuntimeOptions runtime_options(const PreparedRun& run, const RunTiming& timing,
                                        bool is_endless) {
  runtime::RuntimeOptions options = run_options(run.scenario);
  options.twin_force = run.twin_force.get();
  options.twin_base = run.twin_base.get();
  options.is_fast = timing.is_fast;
  if (!timing.is_fast) {
    options.slow_cycle_us = kSlowCycle * 1e6 / run.scenario.device.model.rate_Hz;
  }
  options.thread = {.priority = timing.priority, .cpu = timing.cpu};
  // a simulated device waits for its controller: late cycles do no harm
  options.reports_late_cycles = run.remote() != nullptr;
  options.duration_s = timing.duration_s.value_or(is_endless ? 0.0 : options.duration_s);
  if (timing.is_fast && options.duration_s == 0.0) {
    throw SetupError("run: --fast without a script needs --duration S");
  }
  return options;
}

RecordingPlan recording_plan(const PreparedRun& run, const RunRecords& records, bool is_fast) {
  RecordingPlan plan{.info = recording_info(run.scenario, run.world),
                     .has_recording = records.has_recording,
                     .has_last_seconds = records.flight_recorder != "off",
                     .is_always = records.flight_recorder == "always",
                     .is_waiting = is_fast};
  plan.info.folder = records.folder;
  plan.info.version = version();
  plan.info.is_reproducible = records.is_reproducible;
  return plan;
}

// problem dumps beside the recording, under its name; `stem` is empty without one
recording::ProblemDumps problem_dumps(const config::Scenario& scenario, const RunRecords& records,
                                      const recording::RecordingInfo& info, const std::string& stem,
                                      const std::string& program) {
  const analysis::RunFacts facts = facts_of_scenario(scenario);
  return recording::ProblemDumps(
      {.folder = records.has_recording ? records.folder : "",
       .stem =
           stem.empty() ? recording::stamped(info.name, std::chrono::system_clock::now()) : stem,
       .origin = fmt::format("{}, law {}, bounds {}, gantry {}, braking {}", facts.scenario,
                             facts.law, facts.bounds, facts.gantry, facts.braking),
       .program = program});
}

// what became of the files of a run
void report_files(const RunRecording::Result& result, const std::string& program,
                  RunObserver& observer) {
  const recording::RecordingSummary& recorded = result.recording;
  if (!recorded.error.empty()) observer.problem("recording ended early: " + recorded.error);
  if (!recorded.not_renamed.empty()) {
    observer.problem(fmt::format("the recording is complete, but keeps its name {}: {}",
                                 recorded.file.string(), recorded.not_renamed));
  }
  if (!recorded.not_linked.empty()) observer.note("recording", recorded.not_linked);
  for (const auto& name : recorded.deleted) {
    observer.note("", fmt::format("recording {} deleted to keep within the disk budget", name));
  }
  for (const auto& written : result.last_seconds.files) {
    observer.note("", fmt::format("the last seconds are kept; what happened:\n  {} explain {}",
                                  program, written.string()));
  }
  if (!result.last_seconds.error.empty()) {
    observer.problem("the last seconds could not be written: " + result.last_seconds.error);
  }
}

// what a page cannot draw of device and twin
void report_missing_meshes(const config::Scenario& scenario, RunObserver& observer) {
  const viewer_server::Scene scene = page::page_scene(scenario);
  for (const viewer_server::SceneChain* chain : {&scene.device, &scene.twin}) {
    if (chain->urdf.empty()) continue;
    const auto missing = viewer_server::missing_meshes(
        chain->urdf, chain->urdf_text.empty() ? read_file(chain->urdf) : chain->urdf_text);
    if (missing.empty()) continue;
    observer.note("note",
                  fmt::format("{}: {} of its meshes are not there, the first is {}: the page draws "
                              "bars. Set ROS_PACKAGE_PATH to the folder that holds the package",
                              chain->urdf.filename().string(), missing.size(), missing.front()));
  }
}

// what is known before the clock starts
void introduce(const PreparedRun& run, const RunSetting& setting, bool is_endless,
               RunWatch& watch) {
  const config::Scenario& scenario = run.scenario;
  RunObserver& observer = setting.observer;
  const std::string ideal = run.remote() == nullptr ? idealisation(scenario.device) : "";
  observer.note("", fmt::format("HapticGiant {}  {}{}", version(), scenario.title,
                                ideal.empty() ? "" : fmt::format("  ({})", ideal)));
  if (run.remote() != nullptr && !notices_frozen_sensors(scenario.device)) {
    observer.note("note",
                  "frozen sensors are not noticed (rule 105): simulation.yaml says that they have "
                  "no noise, or monitor.frozen_samples is 0");
  }
  if (setting.page != nullptr) report_missing_meshes(scenario, observer);
  if (is_endless) observer.note("stop", "Ctrl-C");
  if (!run.connection) return;
  if (!run.connection->computer.empty()) watch.notify(0.0, "computer", run.connection->computer);
  if (run.machine() != nullptr) {
    watch.notify(0.0, "start test", run.connection->start_test);
    watch.notify(0.0, "posture", run.connection->posture);
  } else {
    observer.note("note", run.connection->note);
  }
}

// Stores what is to be known of a machine, and ends the session. Returns lines for the summary.
std::string leave(const PreparedRun& run, const RunSetting& setting, FaultCode fault) {
  if (!run.connection) return {};
  std::string lines;
  if (run.machine() != nullptr) {
    lines += fmt::format("  start test   {}\n", run.connection->start_test);
  }
  if (!run.connection->computer.empty()) {
    lines += fmt::format("  computer     {}\n", run.connection->computer);
  }
  if (run.machine() != nullptr) {
    for (const std::string& line : start_test::leave_machine(
             machine_memory(setting.plan.machine, setting.plan.records.folder), run.scenario.device,
             *run.machine(), fault)) {
      lines += fmt::format("  {}\n", line);
    }
  }
  const std::string said = close_device(*run.remote(), fault);
  if (!said.empty()) setting.observer.note("", "message of the remote device: " + said);
  return lines;
}

analysis::RunFacts facts_of(const PreparedRun& run, const runtime::RuntimeOptions& options,
                            const runtime::RuntimeReport& report,
                            const recording::RecordingSummary& recorded) {
  analysis::RunFacts facts = facts_of_run(run.scenario, options, report);
  facts.version = version();
  if (run.remote() != nullptr) {
    facts.link = run.remote()->counts();
    facts.plant.clear();
    facts.sensors.clear();
  }
  facts.recording = recorded.file.string();
  facts.unrecorded = recorded.dropped;
  facts.recording_error = recorded.error;
  return facts;
}

int exit_code(const analysis::Summary& summary, const std::vector<std::string>& missing,
              bool was_ended, bool is_whole) {
  if (summary.fault().code != FaultCode::kNone) return 3;
  if (!was_ended && !(missing.empty() && summary.limits_held() && !summary.has_shaken())) return 1;
  return is_whole ? 0 : kRecordingIncomplete;
}

// the page of a run that a fault or the page itself has ended offers to start again
void wait_for_next(RunWatch& watch, const RunSetting& setting) {
  page::RunPage* page = setting.page;
  if (page == nullptr || setting.plan.page.is_trial() || page->has_next()) return;
  const bool has_fault = watch.summary().fault().code != FaultCode::kNone;
  const bool is_endless = continues(setting);
  if (!page->stop_was_asked() && !page->is_preparing() && !(is_endless && has_fault)) return;
  setting.observer.note("", "the run is over; start it again in the page, or end with Ctrl-C");
  while (!setting.stop.load() && !page->has_next() &&
         (is_endless || page->counters().clients > 0)) {
    watch.follow_page();
    std::this_thread::sleep_for(kIdle);
  }
}

/// The parts of a run between its preparation and its clock.
struct Begun {
  runtime::RuntimeOptions options;
  std::unique_ptr<RunWatch> watch;
};

// Opens all files and streams, after all that may refuse the run, which then leaves no file.
Begun begin(PreparedRun& run, const RunSetting& setting) {
  const RunRecords& records = setting.plan.records;
  const bool is_fast = setting.plan.timing.is_fast;
  page::RunPage* page = setting.page;
  runtime::RuntimeOptions options = runtime_options(run, setting.plan.timing, continues(setting));
  options.stop = &setting.stop;
  if (page != nullptr) options.desk = &page->desk();
  options.stays_in_fault = options.stays_in_fault || page != nullptr;
  runtime::check_runtime_options(options);
  auto streams =
      setting.liblsl == nullptr ? nullptr : open_lab_streams(*setting.liblsl, run.scenario);
  if (streams) {
    setting.observer.note("lab streams",
                          "HapticGiant and HapticGiantEvents, by " + setting.liblsl->file());
  }
  if (records.has_recording && !recording::recording_available()) {
    setting.observer.note("recording", kNoRecording);
  }
  const RecordingPlan plan = recording_plan(run, records, is_fast);
  RunRecording recording(plan);
  const std::string stem = recording.stem();
  if (page != nullptr) {
    page->begin(run.shown(setting.fixed_by), stem.empty() ? "" : stem + ".mcap", plan.info.start);
  }
  WatchParts parts{
      .observer = setting.observer,
      .scenario = run.scenario,
      .page = page,
      .remote = run.remote(),
      .recording = std::move(recording),
      .dumps = problem_dumps(run.scenario, records, plan.info, stem, setting.host.program),
      .streams = std::move(streams),
      .script_end_s = options.duration_s == 0.0 ? planned_duration_s(run.scenario) : 0.0};
  return {.options = options, .watch = std::make_unique<RunWatch>(std::move(parts))};
}

}  // namespace

RunOutcome play_single(PreparedRun& run, const RunSetting& setting) {
  const auto [options, watch] = begin(run, setting);
  introduce(run, setting, options.duration_s == 0.0, *watch);

  runtime::Runtime runtime(options, run.cycle, run.device());
  const auto started = Clock::now();
  runtime.start();
  watch->watch(runtime);
  const runtime::RuntimeReport report = runtime.join();
  const FaultCode fault = watch->summary().fault().code;
  const std::string about_machine = leave(run, setting, fault);

  const RunRecording::Result recorded = watch->recording().close();
  report_files(recorded, setting.host.program, setting.observer);
  const auto streamed = watch->close_streams();
  analysis::RunFacts facts = facts_of(run, options, report, recorded.recording);
  facts.fault_figures = watch->fault_figures();
  facts.latency = watch->latency();
  facts.latency.sensor += 1e-6 * report.wake_up_us.distribution().median;
  facts.wall_time_s = std::chrono::duration<double>(Clock::now() - started).count();
  const std::vector<std::string> missing = watch->missing();
  nlohmann::ordered_json json = watch->summary().to_json(facts, missing);
  json["configuration"] = hash_of(run.scenario.sources);
  json["interrupted"] = setting.stop.load();
  const page::RunPage* page = setting.page;
  const bool was_ended =
      setting.stop.load() || (page != nullptr && (page->has_next() || page->stop_was_asked()));
  RunOutcome outcome{
      .exit_code = exit_code(watch->summary(), missing, was_ended, recorded.is_whole()),
      .fault = fault,
      .summary = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace),
      .recording = recorded.recording.file};
  setting.observer.phase(RunPhase::kOver, 0.0, "");
  setting.observer.summary(
      {.json = json,
       .text = fmt::format("\n{}{}{}{}", watch->summary().to_text(facts, missing),
                           watch->dumps().summary(runtime.kept_problems()),
                           streamed ? to_text(*streamed) : "", about_machine),
       .exit_code = outcome.exit_code,
       .recording = outcome.recording});
  wait_for_next(*watch, setting);
  return outcome;
}

}  // namespace hg::scenario
