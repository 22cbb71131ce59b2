#include "apps/hapticgiant/run_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/paths.h"
#include "apps/hapticgiant/problem_dumps.h"
#include "apps/hapticgiant/remote_setup.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/status_line.h"
#include "apps/hapticgiant/version.h"
#include "hg/assembly/assembly.h"
#include "hg/core/error.h"
#include "hg/evaluation/summary.h"
#include "hg/runtime/runtime.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kIdle(2);
constexpr std::chrono::milliseconds kStatusPeriod(100);
constexpr double kSlowCycle = 0.5;  // of the period

/// Everything that watches a run from outside the control thread.
struct Observers {
  const std::atomic<bool>& interrupted;  ///< ends the run; its recording is completed
  const config::Scenario& scenario;
  evaluation::EventDetector detector;
  evaluation::Summary summary;
  StatusLine status_line;
  std::unique_ptr<viewer_server::ViewerServer> viewer;
  std::unique_ptr<recording::Recorder> recorder;
  ProblemDumps dumps;
  bool is_fast = false;
  Clock::time_point last_status = {};
  double script_end_s = 0.0;  ///< > 0: the run goes on after the script, tell so
  TareStatus told_tare = TareStatus::kNone;
};

// how a tare went, once per answer however often it is tried, and what was refused
void tell_requests(Observers& observers, const CycleRecord& record) {
  const auto tell = [&](const char* name, std::string_view what) {
    observers.status_line.print(fmt::format("{:8.3f} s  {:<18} {}", record.time_s, name, what));
    if (observers.recorder) observers.recorder->event(record.time_s, name, what);
  };
  const bool has_ended = record.tare != TareStatus::kNone && record.tare != TareStatus::kUnderWay;
  if (has_ended && record.tare != observers.told_tare) {
    observers.told_tare = record.tare;
    tell("tare", to_string(record.tare));
  }
  if (record.refusal != Refusal::kNone) tell("arm", to_string(record.refusal));
}

void announce(Observers& observers, const evaluation::Event& event) {
  observers.summary.add(event);
  observers.status_line.print(
      fmt::format("{:8.3f} s  {:<18} {}", event.time_s, event.name, event.what));
  if (observers.recorder) observers.recorder->event(event.time_s, event.name, event.what);
  if (observers.viewer) observers.viewer->announce_event(event.time_s, event.name, event.what);
}

void observe(Observers& observers, const Sample& sample) {
  if (observers.script_end_s > 0.0 && sample.record.time_s > observers.script_end_s) {
    observers.script_end_s = 0.0;
    observers.status_line.print("the script has played; drag the handle in the page");
  }
  observers.summary.add(sample);
  tell_requests(observers, sample.record);
  if (observers.recorder && observers.is_fast) observers.recorder->push_waiting(sample);
  if (observers.recorder && !observers.is_fast) observers.recorder->push(sample);
  if (const auto event = observers.detector.observe(sample.record)) announce(observers, *event);
}

// as often as people look
void show(Observers& observers, const Sample& sample) {
  if (observers.viewer) observers.viewer->publish(sample, observers.scenario.description);
  const auto now = Clock::now();
  if (now - observers.last_status < kStatusPeriod) return;
  observers.last_status = now;
  observers.status_line.show(
      status_text(sample, observers.scenario.limits, observers.scenario.twin.model));
}

void look_at_problems(Observers& observers, const hqp::KeptProblems& problems) {
  for (std::size_t i = 0; i < hqp::KeptProblems::kMost; ++i) {
    const std::string text = observers.dumps.look_at(problems);
    if (!text.empty()) observers.status_line.print(text);
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
    look_at_problems(observers, runtime.kept_problems());
    if (is_finished) break;
    if (observers.interrupted.load()) runtime.request_stop();
    HandTarget target;
    if (observers.viewer && observers.viewer->take_hand_target(target)) {
      runtime.set_hand_target(target);
    }
    if (!any) std::this_thread::sleep_for(kIdle);
  }
  observers.status_line.clear();
}

std::unique_ptr<viewer_server::ViewerServer> make_viewer(const config::Scenario& scenario,
                                                         const RunArguments& arguments) {
  if (!arguments.has_viewer || arguments.is_fast) return nullptr;
  const auto page = data_root() / "viewer" / "dist";
  std::error_code error;
  if (!fs::is_regular_file(page / "index.html", error)) {
    print_out("page        not built (it needs node 18 or newer), running without it\n");
    return nullptr;
  }
  viewer_server::Options options;
  options.port = arguments.port;
  options.page = page;
  return std::make_unique<viewer_server::ViewerServer>(options, viewer_scene(scenario));
}

std::unique_ptr<recording::Recorder> make_recorder(const config::Scenario& scenario,
                                                   const RunArguments& arguments) {
  if (!arguments.has_recording) return nullptr;
  if (!recording::recording_available()) {
    print_out("recording   off (the program was built without Rust)\n");
    return nullptr;
  }
  return std::make_unique<recording::Recorder>(recording_info(scenario, arguments));
}

struct AnyDevice {
  std::unique_ptr<device::Device> device;
  remote::RemoteDevice* remote = nullptr;  ///< the same; nullptr: it is simulated here
};

AnyDevice make_device(const config::Scenario& scenario, const RunArguments& arguments) {
  if (arguments.device_address.empty()) {
    return {std::make_unique<device::SimulatedDevice>(assembly::make_simulated_device(scenario))};
  }
  auto device = connect_device(arguments.device_address, scenario, arguments.is_fast);
  remote::RemoteDevice* remote = device.get();
  return {std::move(device), remote};
}

void close_device(remote::RemoteDevice& device, const Fault& fault) {
  device.close(fault.code);
  if (!device.farewell().empty()) {
    print_out(fmt::format("the remote device says: {}\n", device.farewell()));
  }
}

// `goes_on`: after the script, until Ctrl-C
runtime::Options runtime_options(const config::Scenario& scenario, const RunArguments& arguments,
                                 bool goes_on) {
  runtime::Options options;
  options.rate_Hz = scenario.device.rate_Hz;
  options.is_fast = arguments.is_fast;
  options.changes = scenario.changes;
  if (!arguments.is_fast) options.slow_cycle_us = kSlowCycle * 1e6 / options.rate_Hz;
  options.duration_s =
      arguments.duration_s.value_or(goes_on ? 0.0 : assembly::planned_duration_s(scenario));
  if (arguments.is_fast && options.duration_s == 0.0) {
    throw SetupError("run: --fast without a script needs --duration S");
  }
  runtime::check(options);
  return options;
}

// completes the recording; its file name, or empty
std::string close_recording(recording::Recorder* recorder) {
  if (recorder == nullptr) return {};
  const recording::RecordingSummary recorded = recorder->close();
  if (!recorded.error.empty())
    std::fputs(fmt::format("recording ended early: {}\n", recorded.error).c_str(), stderr);
  for (const auto& name : recorded.deleted) {
    print_out(fmt::format("recording {} deleted to keep within the disk budget\n", name));
  }
  return recorded.file.string();
}

int exit_code(const evaluation::Summary& summary, const std::vector<std::string>& missing,
              bool was_interrupted) {
  if (summary.fault().code != FaultCode::kNone) return 3;
  if (was_interrupted) return 0;
  return missing.empty() && summary.limits_held() ? 0 : 1;
}

}  // namespace

int run(const RunArguments& arguments) {
  check_writable(arguments.summary);
  const config::Scenario scenario = make_scenario(arguments);
  cycle::Cycle cycle = assembly::make_cycle(scenario);
  auto [device, remote] = make_device(scenario, arguments);
  const std::atomic<bool>& interrupted = watch_interruption();
  auto viewer = make_viewer(scenario, arguments);
  const bool is_terminal = isatty(STDOUT_FILENO) == 1;
  const bool goes_on = is_terminal && viewer != nullptr;
  const runtime::Options options = runtime_options(scenario, arguments, goes_on);
  auto recorder = make_recorder(scenario, arguments);  // last: a refused run leaves no file
  auto dumps = problem_dumps(scenario, arguments, recorder.get());
  Observers observers{
      .interrupted = interrupted,
      .scenario = scenario,
      .detector = {scenario.events, scenario.limits},
      .summary = assembly::make_summary(scenario),
      .status_line = StatusLine(is_terminal),
      .viewer = std::move(viewer),
      .recorder = std::move(recorder),
      .dumps = std::move(dumps),
      .is_fast = arguments.is_fast,
      .script_end_s = options.duration_s == 0.0 ? assembly::planned_duration_s(scenario) : 0.0};

  print_out(fmt::format("HapticGiant {}  {}\n", kVersion, scenario.title));
  if (observers.viewer) print_out(fmt::format("page        {}\n", observers.viewer->url()));
  if (options.duration_s == 0.0) print_out("stop        Ctrl-C\n");

  runtime::Runtime runtime(options, cycle, *device);
  const auto begin = Clock::now();
  runtime.start();
  watch(runtime, observers);
  const runtime::Report report = runtime.join();
  if (remote != nullptr) close_device(*remote, observers.summary.fault());

  const std::chrono::duration<double> wall_time = Clock::now() - begin;
  const rendering::Options& law = scenario.device.rendering;
  const evaluation::RunFacts facts{.scenario = scenario.title,
                                   .version = kVersion,
                                   .law = std::string(rendering::to_string(law.law)),
                                   .bounds = std::string(rendering::to_string(law.bounds)),
                                   .rate_Hz = options.rate_Hz,
                                   .is_fast = options.is_fast,
                                   .overruns = report.overruns,
                                   .dropped = report.dropped,
                                   .allocations_in_loop = report.allocations,
                                   .is_real_time = report.is_real_time,
                                   .is_memory_locked = report.is_memory_locked,
                                   .stop_timed_out = report.stop_timed_out,
                                   .link = remote != nullptr ? remote->counts() : LinkCounts{},
                                   .recording = close_recording(observers.recorder.get()),
                                   .wall_time_s = wall_time.count()};
  const std::vector<std::string> missing = observers.detector.missing();
  print_out(fmt::format("\n{}{}", observers.summary.to_text(facts, missing),
                        observers.dumps.summary(runtime.kept_problems())));
  if (!arguments.summary.empty()) {
    write_output(arguments.summary, observers.summary.to_json(facts, missing));
  }
  return exit_code(observers.summary, missing, interrupted.load());
}

}  // namespace hg::apps
