#include "apps/hapticgiant/run_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/prepared_run.h"
#include "apps/hapticgiant/run_page.h"
#include "apps/hapticgiant/run_recording.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/status_line.h"
#include "apps/hapticgiant/version.h"
#include "hg/analysis/fault_figures.h"
#include "hg/analysis/summary.h"
#include "hg/controller/safety/rules.h"
#include "hg/core/error.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"

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
  RunPage* page;  ///< page; nullptr = none
  RunRecording recording;
  recording::ProblemDumps dumps;
  bool is_fast = false;
  Clock::time_point last_status = {};
  /// End of the script, to report if the run continues after it; 0 = it does not
  double script_end_s = 0.0;
  TareStatus told_tare = TareStatus::kNone;
  FaultCode told_fault = FaultCode::kNone;
  bool told_touch = false;
  analysis::Names names;
  std::string fault_figures = {};  ///< figures of the summary's fault
};

// reports and records an intervention in the run
void tell(Observers& observers, double time_s, std::string_view name, std::string_view what) {
  observers.status_line.print(fmt::format("{:8.3f} s  {:<18} {}", time_s, name, what));
  observers.recording.event(time_s, name, what);
  if (observers.page != nullptr) observers.page->announce(time_s, name, what);
}

// reports the result of a tare, once per answer regardless of retries, and refused requests
void tell_requests(Observers& observers, const CycleRecord& record) {
  const bool has_ended = record.tare != TareStatus::kNone && record.tare != TareStatus::kUnderWay;
  if (has_ended && record.tare != observers.told_tare) {
    observers.told_tare = record.tare;
    tell(observers, record.time_s, "tare", to_string(record.tare));
  }
  if (record.refusal != Refusal::kNone) {
    tell(observers, record.time_s, "request", to_string(record.refusal));
  }
}

void tell_fault(Observers& observers, const Sample& sample) {
  const FaultCode code = sample.record.fault.code;
  if (std::exchange(observers.told_fault, code) == code || code == FaultCode::kNone) return;
  tell(observers, sample.record.time_s, safety::is_fault(code) ? "fault" : "stopped",
       fmt::format("{} {}", static_cast<int>(code), to_string(code)));
}

// reports the begin of a contact with the arm
void tell_touch(Observers& observers, const CycleRecord& record) {
  const TouchReport& touch = record.touch;
  if (std::exchange(observers.told_touch, touch.is_told) || !touch.is_told) return;
  const auto joint = static_cast<std::size_t>(touch.joint);  // -1: very large
  const std::vector<std::string>& joints = observers.names.joints;
  const std::string where = joint < joints.size() ? " beyond joint " + joints[joint] : "";
  tell(observers, record.time_s, "contact", "something touches the arm" + where + ": it gives way");
}

// callback for changes by pages, at the time of `sample`
RunPage::Note note(Observers& observers, const Sample& sample) {
  return [&observers, &sample](std::string_view name, const std::string& text) {
    tell(observers, sample.record.time_s, name, text);
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
  tell_requests(observers, sample.record);
  tell_touch(observers, sample.record);
  tell_fault(observers, sample);
  observers.recording.push(sample);
  if (const auto event = observers.detector.observe(sample.record)) {
    observers.summary.add(*event);
    tell(observers, event->time_s, event->name, event->what);
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

void look_at_recording(Observers& observers, double time_s) {
  const std::string why = observers.recording.news();
  if (!why.empty()) {
    tell(observers, time_s, "recording", "has ended early, the run goes on: " + why);
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
    look_at_recording(observers, sample->record.time_s);
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

void close_device(udp::RemoteDevice& device, const Fault& fault) {
  device.close(fault.code);
  if (!device.farewell().empty()) {
    print_out(fmt::format("the remote device says: {}\n", device.farewell()));
  }
}

// `goes_on`: after the script, until Ctrl-C
runtime::Options runtime_options(const config::Scenario& scenario, const RunArguments& arguments,
                                 bool goes_on, const std::atomic<bool>& interrupted) {
  runtime::Options options;
  options.stop = &interrupted;
  options.is_fast = arguments.is_fast;
  options.changes = scenario.changes;
  options.panel = scenario.panel;
  options.load = faults::loads_of(scenario.faults);
  options.longest_stop_s = scenario::longest_stop_s(scenario);
  if (!arguments.is_fast) options.slow_cycle_us = kSlowCycle * 1e6 / scenario.device.model.rate_Hz;
  options.thread = {.priority = arguments.priority, .cpu = arguments.cpu};
  // a simulated device waits for its controller: late cycles do no harm
  options.tells_late_cycles = !arguments.device_address.empty();
  options.duration_s =
      arguments.duration_s.value_or(goes_on ? 0.0 : scenario::planned_duration_s(scenario));
  if (arguments.is_fast && options.duration_s == 0.0) {
    throw SetupError("run: --fast without a script needs --duration S");
  }
  runtime::check(options);
  return options;
}

int exit_code(const analysis::Summary& summary, const std::vector<std::string>& missing,
              bool was_interrupted) {
  if (summary.fault().code != FaultCode::kNone) return 3;
  if (was_interrupted) return 0;
  return missing.empty() && summary.limits_held() && !summary.has_shaken() ? 0 : 1;
}

analysis::Timing timing_of(const runtime::Options& options, const runtime::Report& report) {
  const runtime::ThreadReport& thread = report.thread;
  const auto text_of = [](int error) { return error == 0 ? "" : std::strerror(error); };
  analysis::Timing timing = {.is_fast = options.is_fast,
                             .priority = thread.priority,
                             .priority_refusal = text_of(thread.priority_error),
                             .cpu = thread.cpu,
                             .cpu_refusal = text_of(thread.cpu_error),
                             .is_memory_locked = thread.is_memory_locked,
                             .page_faults = report.page_faults,
                             .overruns = report.overruns,
                             .most_overruns_in_a_row = report.most_overruns_in_a_row,
                             .overruns_stop = report.told_late_cycles,
                             .wake_up_us = report.wake_up_us};
  for (int i = 0; i < kStageCount; ++i) {
    const Histogram& times = report.stage_us[static_cast<std::size_t>(i)];
    if (times.count() == 0) continue;
    timing.stages.push_back({to_string(static_cast<Stage>(i)), times.distribution()});
  }
  return timing;
}

// facts of the summary besides the observed ones
analysis::RunFacts facts_of(const PreparedRun& run, const runtime::Options& options,
                            const runtime::Report& report) {
  analysis::RunFacts facts = scenario::facts_of_scenario(run.scenario);
  facts.version = kVersion;
  facts.rate_Hz = run.scenario.device.model.rate_Hz;
  facts.timing = timing_of(options, report);
  facts.dropped = report.dropped;
  facts.allocations_in_loop = report.allocations;
  facts.stop_timed_out = report.stop_timed_out;
  if (run.remote != nullptr) facts.link = run.remote->counts();
  return facts;
}

// the page of a run that a fault or the page itself has ended offers to start again
void wait_for_next(Observers& observers, bool goes_on) {
  RunPage* page = observers.page;
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

// to its end and its summary; the exit code
int play(PreparedRun& run, const std::atomic<bool>& interrupted, const BackgroundOutput& output,
         RunPage* page) {
  const RunArguments& arguments = run.arguments;
  const config::Scenario& scenario = run.scenario;
  const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  const bool goes_on = is_terminal && page != nullptr;
  runtime::Options options = runtime_options(scenario, arguments, goes_on, interrupted);
  const auto is_reset = [](const TimedPanel& p) { return p.request == ModeRequest::kReset; };
  if (page != nullptr) options.desk = &page->desk();
  options.stays_in_fault = page != nullptr || std::ranges::any_of(scenario.panel, is_reset);
  RunRecording recording(scenario, arguments);  // last: a refused run leaves no file
  const recording::Recorder* recorder = recording.recorder();
  auto dumps = problem_dumps(scenario, arguments, recorder);
  if (page != nullptr) page->begin(run, recorder != nullptr ? recorder->stem() + ".mcap" : "");
  Observers observers{
      .interrupted = interrupted,
      .scenario = scenario,
      .detector = {scenario.events, scenario.limits},
      .summary = scenario::make_summary(scenario),
      .status_line = StatusLine(is_terminal, output),
      .page = page,
      .recording = std::move(recording),
      .dumps = std::move(dumps),
      .is_fast = arguments.is_fast,
      .script_end_s = options.duration_s == 0.0 ? scenario::planned_duration_s(scenario) : 0.0,
      .names = scenario::part_names(scenario)};
  print_out(fmt::format("HapticGiant {}  {}\n", kVersion, scenario.title));
  if (run.remote != nullptr && !scenario::notices_frozen_sensors(scenario.device)) {
    print_out(
        "note        frozen sensors are not noticed (rule 105): simulation.yaml says that they "
        "have no noise, or monitor.frozen_samples is 0\n");
  }
  if (options.duration_s == 0.0) print_out("stop        Ctrl-C\n");
  if (run.is_machine) {
    tell(observers, 0.0, "start test", run.start_test);
    tell(observers, 0.0, "posture", run.posture);
  } else if (run.remote != nullptr) {
    print_out("note        the device says that it is a simulation: no start test is asked for\n");
  }

  runtime::Runtime runtime(options, run.cycle, *run.device);
  const auto begin = Clock::now();
  runtime.start();
  watch(runtime, observers);
  const runtime::Report report = runtime.join();
  std::vector<std::string> about_machine;
  if (run.is_machine) {
    about_machine = start_test::leave_machine(machine_memory(arguments), scenario.device,
                                              *run.remote, observers.summary.fault().code);
  }
  if (run.remote != nullptr) close_device(*run.remote, observers.summary.fault());

  analysis::RunFacts facts = facts_of(run, options, report);
  const RunRecording::Result recorded = observers.recording.close();
  facts.recording = recorded.file;
  facts.unrecorded = recorded.unrecorded;
  facts.recording_error = recorded.error;
  facts.fault_figures = observers.fault_figures;
  facts.wall_time_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const std::vector<std::string> missing = observers.detector.missing();
  print_out(fmt::format("\n{}{}", observers.summary.to_text(facts, missing),
                        observers.dumps.summary(runtime.kept_problems())));
  if (run.is_machine) print_out(fmt::format("  start test   {}\n", run.start_test));
  for (const std::string& line : about_machine) print_out(fmt::format("  {}\n", line));
  bool is_written = recorded.is_whole;
  try {
    if (!arguments.summary.empty()) {
      write_output(arguments.summary, observers.summary.to_json(facts, missing));
    }
  } catch (const SetupError& error) {
    print_error("{}\n", error.what());
    is_written = false;
  }
  const bool was_ended = page != nullptr && (page->has_next() || page->stop_was_asked());
  const int code = exit_code(observers.summary, missing, interrupted.load() || was_ended);
  wait_for_next(observers, goes_on);
  return code == 0 && !is_written ? kNotWritten : code;
}

}  // namespace

int run(const RunArguments& arguments) {
  check_writable(arguments.summary, kJson);
  auto present = std::make_unique<PreparedRun>(arguments);
  const std::atomic<bool>& interrupted = watch_interruption();
  const BackgroundOutput output(interrupted);
  const auto page = open_page(*present);
  if (page) present_page(page->url(), arguments.address, arguments.opens_browser);

  std::unique_ptr<PreparedRun> last;  // until the page shows the next one
  while (true) {
    const int code = play(*present, interrupted, output, page.get());
    auto next = page && !interrupted.load() ? page->take_next() : nullptr;
    if (!next) return code;
    last = std::move(present);
    present = std::move(next);
  }
}

}  // namespace hg::apps
