#include "hg/scenario/run/move_to_start.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <utility>

#include "hg/core/error.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/run.h"
#include "hg/scenario/way_to_start.h"
#include "hg/signals/off_command.h"

namespace hg::scenario {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongest = 120.0;  // s, of the way with all that it waits for
constexpr double kSettled = 1.0;    // s, after which what is missing is asked for
constexpr std::chrono::milliseconds kIdle(2);
constexpr std::chrono::milliseconds kStatusPeriod(100);
constexpr int kSamples = 20;  // until the values of a posture are those of sensors

// Where the device of the run stands, with its drives off.
SensorFrame posture_of(PreparedRun& run, const std::string& address) {
  const config::DeviceConfig& device = run.scenario.device;
  device::ConnectedDevice& remote = *run.remote();
  SensorFrame sensors;
  CommandFrame off = off_command(device.model.n_p, device.model.n_m,
                                 device.control.method != tracking::Method::kDrives);
  for (int i = 0; i < kSamples; ++i) {
    remote.read(sensors);
    if (sensors.driver_fault != FaultCode::kNone) {
      throw SetupError(fmt::format("{}: the device has gone before it was armed {}", address,
                                   remote.farewell()));
    }
    off.sequence = sensors.sequence;
    off.q_m = sensors.q_m;
    remote.write(off);
  }
  return sensors;
}

runtime::RuntimeOptions options_of(const config::Scenario& way, const RunTiming& timing,
                                   const std::atomic<bool>& stop, page::RunPage* page) {
  runtime::RuntimeOptions options = run_options(way);
  options.stop = &stop;
  options.is_fast = timing.is_fast;
  options.thread = {.priority = timing.priority, .cpu = timing.cpu};
  options.reports_late_cycles = true;
  options.duration_s = kLongest;
  if (page != nullptr) options.desk = &page->desk();
  // a request that changes nothing, after which none is made without being asked for; and the key
  // of a simulated operator, which a machine does not look at
  options.panel = {{.at_s = 0.0, .panel = {.override_key = true}, .request = ModeRequest::kStop}};
  return options;
}

// Asks for what is due; the pause before makes it an edge.
void ask(runtime::Runtime& runtime, WayGuide& guide, std::uint32_t stops) {
  const ModeRequest request = guide.request();
  if (request == ModeRequest::kNone) return;
  if (runtime.request(ModeRequest::kNone, stops)) {
    (void)runtime.request(request, stops);  // repeated if there is no place
  }
}

/// Follows the run along the way.
class WayWatch {
 public:
  WayWatch(const config::Scenario& way, WayGuide& guide, page::RunPage* page, RunObserver& observer)
      : way_(way), guide_(guide), page_(page), observer_(observer) {}

  // `stops`: how many stops a page had asked for before the way was begun
  void follow(runtime::Runtime& runtime, std::uint32_t stops) {
    observer_.phase(RunPhase::kMoving, 0.0, "");
    runtime.start();
    while (true) {
      const bool is_finished = runtime.is_finished();
      const bool any = take(runtime);
      if (is_finished) break;
      if (guide_.is_over()) runtime.request_stop();
      ask(runtime, guide_, stops);
      want();
      if (page_ != nullptr) page_->follow(&runtime, note_);
      if (!any) std::this_thread::sleep_for(kIdle);
    }
  }

  double time_s() const { return sample_->record.time_s; }

 private:
  // takes and shows what has come; whether anything has
  bool take(runtime::Runtime& runtime) {
    bool any = false;
    while (runtime.pop(*sample_)) {
      guide_.observe(*sample_);
      if (page_ != nullptr) page_->observe(*sample_, note_);
      any = true;
    }
    if (!any) return false;
    if (page_ != nullptr) page_->show(*sample_);
    if (const auto now = Clock::now(); now - last_status_ > kStatusPeriod) {
      last_status_ = now;
      observer_.status(*sample_, way_);
    }
    return true;
  }

  void want() {
    std::string wanted = time_s() > kSettled ? guide_.wanted() : "";
    if (wanted == wanted_) return;
    wanted_ = std::move(wanted);
    observer_.phase(RunPhase::kMoving, time_s(), wanted_);
    if (!wanted_.empty()) note_("start", wanted_);
  }

  const config::Scenario& way_;
  WayGuide& guide_;
  page::RunPage* page_;
  RunObserver& observer_;
  std::unique_ptr<Sample> sample_ = std::make_unique<Sample>();
  page::RunPage::Note note_ = [this](std::string_view name, const std::string& text) {
    observer_.event(time_s(), name, text);
    if (page_ != nullptr) page_->announce(time_s(), name, text);
  };
  std::string wanted_;
  Clock::time_point last_status_ = {};
};

std::string words_of(const Fault& fault) {
  return fmt::format("{} {}", static_cast<int>(fault.code), to_string(fault.code));
}

}  // namespace

PreparedWay prepare_way(const ScenarioOptions& world, const MachineAddress& machine,
                        const RunTiming& timing, const RunRecords& records) {
  auto probe = std::make_unique<PreparedRun>(world, machine, timing, records);
  const config::Scenario scenario = probe->scenario;
  if (!scenario.device.monitor.has_dead_man) {
    throw SetupError(fmt::format(
        "--move-to-start: {} has no dead-man switch: it cannot know whether a hand holds its "
        "handle, and does not move on its own",
        scenario.device.name));
  }
  const Start start = find_start(scenario.device, scenario.twin);
  const SensorFrame now = posture_of(*probe, machine.address);
  probe->remote()->close(FaultCode::kNone);
  probe.reset();
  return {.run = std::make_unique<PreparedRun>(way_to_start(scenario, start, now.q_p, now.q_m),
                                               world, machine, timing, records),
          .goal = start};
}

std::string move_to_start(PreparedWay& way, const RunTiming& timing,
                          const start_test::MachineMemory& memory, page::RunPage* page,
                          RunObserver& observer, const std::atomic<bool>& stop) {
  PreparedRun& run = *way.run;
  WayGuide guide(run.scenario, way.goal);
  WayWatch watch(run.scenario, guide, page, observer);
  const std::uint32_t stops = page == nullptr ? 0 : page->desk().stops();
  if (page != nullptr) page->begin(run.shown(kMovesItself), "", std::chrono::system_clock::now());
  observer.note("start", run.scenario.description);

  runtime::Runtime runtime(options_of(run.scenario, timing, stop, page), run.cycle, run.device());
  watch.follow(runtime, stops);
  const Fault fault = runtime.join().fault;
  if (run.machine() != nullptr) {
    for (const std::string& line :
         start_test::leave_machine(memory, run.scenario.device, *run.machine(), fault.code)) {
      observer.note("", "  " + line);
    }
  }
  if (const std::string said = close_device(*run.remote(), fault.code); !said.empty()) {
    observer.note("", "message of the remote device: " + said);
  }
  if (!guide.is_there()) return stop.load() ? "interrupted" : guide.problem();
  if (fault.code != FaultCode::kNone) return words_of(fault);  // in the stop at the start
  observer.note("start", fmt::format("there after {:.1f} s, {:.1f} mm and {:.1f} mrad from the "
                                     "twin's start; gantry {:.0f} mm or mrad from its best place",
                                     watch.time_s(), 1e3 * guide.distance(), 1e3 * guide.angle(),
                                     1e3 * guide.gantry_distance()));
  return {};
}

}  // namespace hg::scenario
