#include "apps/hapticgiant/move_to_start.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <utility>

#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/status_line.h"
#include "hg/core/error.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/remote/franka_setup.h"
#include "hg/scenario/run.h"
#include "hg/scenario/way_to_start.h"
#include "hg/signals/off_command.h"

namespace hg::apps {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongest = 120.0;  // s, of the way with all that it waits for
constexpr double kSettled = 1.0;    // s, after which what is missing is asked for
constexpr std::chrono::milliseconds kIdle(2);
constexpr std::chrono::milliseconds kStatusPeriod(100);
constexpr int kSamples = 20;  // until the values of a posture are those of sensors

// Where the device of the run stands, with its drives off.
SensorFrame posture_of(PreparedRun& run) {
  const config::DeviceConfig& device = run.scenario.device;
  SensorFrame sensors;
  CommandFrame off = off_command(device.model.n_p, device.model.n_m,
                                 device.control.method != tracking::Method::kDrives);
  for (int i = 0; i < kSamples; ++i) {
    run.remote->read(sensors);
    if (sensors.driver_fault != FaultCode::kNone) {
      throw SetupError(fmt::format("{}: the device has gone before it was armed {}",
                                   run.arguments.device_address, run.remote->farewell()));
    }
    off.sequence = sensors.sequence;
    off.q_m = sensors.q_m;
    run.remote->write(off);
  }
  return sensors;
}

runtime::RuntimeOptions options_of(const PreparedRun& way, const std::atomic<bool>& interrupted,
                                   page::RunPage* page) {
  runtime::RuntimeOptions options = scenario::run_options(way.scenario);
  options.stop = &interrupted;
  options.is_fast = way.arguments.is_fast;
  options.thread = {.priority = way.arguments.priority, .cpu = way.arguments.cpu};
  options.reports_late_cycles = true;
  options.duration_s = kLongest;
  if (page != nullptr) options.desk = &page->desk();
  // a request that changes nothing, after which none is made without being asked for; and the key
  // of a simulated operator, which a machine does not look at
  options.panel = {{.at_s = 0.0, .panel = {.override_key = true}, .request = ModeRequest::kStop}};
  return options;
}

// Asks for what is due; the pause before makes it an edge.
void ask(runtime::Runtime& runtime, scenario::WayGuide& guide, std::uint32_t stops) {
  const ModeRequest request = guide.request();
  if (request == ModeRequest::kNone) return;
  if (runtime.request(ModeRequest::kNone, stops)) {
    (void)runtime.request(request, stops);  // repeated if there is no place
  }
}

}  // namespace

bool moves_by_law(const RunArguments& arguments) {
  return arguments.moves_to_start && !scenario::is_franka(arguments.device_address);
}

std::unique_ptr<PreparedRun> prepare_way(const RunArguments& arguments) {
  RunArguments own = arguments;
  own.has_recording = false;
  auto probe = std::make_unique<PreparedRun>(own);
  const config::Scenario scenario = probe->scenario;
  if (!scenario.device.monitor.has_dead_man) {
    throw SetupError(fmt::format(
        "--move-to-start: {} has no dead-man switch: it cannot know that nobody holds its handle, "
        "and does not move by itself",
        scenario.device.name));
  }
  const scenario::Start start = scenario::find_start(scenario.device, scenario.twin);
  const SensorFrame now = posture_of(*probe);
  probe->remote->close(FaultCode::kNone);
  probe.reset();
  auto way =
      std::make_unique<PreparedRun>(own, scenario::way_to_start(scenario, start, now.q_p, now.q_m));
  way->goal = start;
  way->fixed_by = "the device moves to the start by itself";
  return way;
}

std::string move_to_start(PreparedRun& way, const std::atomic<bool>& interrupted,
                          const BackgroundOutput& output, page::RunPage* page) {
  scenario::WayGuide guide(way.scenario, way.goal);
  StatusLine status_line(isatty(STDOUT_FILENO) == 1, output);
  auto sample = std::make_unique<Sample>();
  const page::RunPage::Note note = [&](std::string_view name, const std::string& text) {
    status_line.print(fmt::format("{:8.3f} s  {:<18} {}", sample->record.time_s, name, text));
    if (page != nullptr) page->announce(sample->record.time_s, name, text);
  };
  if (page != nullptr) page->begin(way.shown(), "", std::chrono::system_clock::now());
  const std::uint32_t stops = page == nullptr ? 0 : page->desk().stops();
  print_out(fmt::format("start       {}\n", way.scenario.description));
  std::string told;
  Clock::time_point last_status = {};

  runtime::Runtime runtime(options_of(way, interrupted, page), way.cycle, *way.device);
  runtime.start();
  while (true) {
    const bool is_finished = runtime.is_finished();
    bool any = false;
    while (runtime.pop(*sample)) {
      guide.observe(*sample);
      if (page != nullptr) page->observe(*sample, note);
      any = true;
    }
    if (is_finished) break;
    if (guide.is_over()) runtime.request_stop();
    ask(runtime, guide, stops);
    const bool is_settled = sample->record.time_s > kSettled;
    if (const std::string wanted = is_settled ? guide.wanted() : ""; wanted != told) {
      told = wanted;
      if (!told.empty()) note("start", told);
    }
    if (page != nullptr) {
      if (any) page->show(*sample);
      page->follow(&runtime, note);
    }
    if (any && !way.arguments.is_fast && Clock::now() - last_status > kStatusPeriod) {
      last_status = Clock::now();
      status_line.show(status_text(*sample, way.scenario.limits, way.scenario.twin.model));
    }
    if (!any) std::this_thread::sleep_for(kIdle);
  }
  status_line.clear();
  const runtime::RuntimeReport report = runtime.join();
  if (way.machine != nullptr) {
    for (const std::string& line : start_test::leave_machine(
             machine_memory(way.arguments), way.scenario.device, *way.machine, report.fault.code)) {
      print_out(fmt::format("  {}\n", line));
    }
  }
  close_device(*way.remote, report.fault);
  if (!guide.is_there() && interrupted.load()) return "interrupted";
  if (guide.is_there() && report.fault.code != FaultCode::kNone) {  // in the stop at the start
    return fmt::format("{} {}", static_cast<int>(report.fault.code), to_string(report.fault.code));
  }
  if (guide.is_there()) {
    print_out(
        fmt::format("start       there after {:.1f} s, {:.1f} mm and {:.1f} mrad from the "
                    "twin's start; gantry {:.0f} mm or mrad from its best place\n",
                    sample->record.time_s, 1e3 * guide.distance(), 1e3 * guide.angle(),
                    1e3 * guide.gantry_distance()));
  }
  return guide.problem();
}

void close_device(device::ConnectedDevice& device, const Fault& fault) {
  device.close(fault.code);
  if (!device.farewell().empty()) {
    print_out(fmt::format("message of the remote device: {}\n", device.farewell()));
  }
}

}  // namespace hg::apps
