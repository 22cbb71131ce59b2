#include "hg/runtime/runtime.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "hg/controller/cycle.h"
#include "hg/core/allocation_counter.h"
#include "hg/core/allowed_to_wait.h"
#include "hg/core/error.h"
#include "hg/core/index.h"
#include "hg/core/monotonic_clock.h"
#include "hg/runtime/requests.h"

namespace hg::runtime {
namespace {

constexpr std::int64_t kPausePoll = 2'000'000;  // ns
constexpr double kStandstill = 2e-2;  // rad/s and m/s; measured, so above the noise of encoders
constexpr double kRest = 0.1;         // s at rest; an arm whose brakes close late sags within it

// Detects standstill after a fault: the motion until then belongs into the recording.
class WayToRest {
 public:
  explicit WayToRest(double longest_s) : longest_s_(longest_s) {}

  /// Whether the recording may end; call after each cycle in mode fault.
  bool is_over(const Sample& sample) noexcept {
    const double now_s = sample.record.time_s;
    if (since_s_ < 0.0) since_s_ = moved_s_ = now_s;
    if (moves(sample.sensors.dq_m) || moves(sample.record.robot.dq_p)) moved_s_ = now_s;
    return now_s > moved_s_ + kRest || now_s > since_s_ + longest_s_;
  }

 private:
  // a component that cannot be measured counts as being at rest
  template <typename Vector>
  static bool moves(const Vector& speed) noexcept {
    return (speed.array().abs() > kStandstill).any();
  }

  double longest_s_;
  double since_s_ = -1.0, moved_s_ = -1.0;
};

}  // namespace

void check_runtime_options(const RuntimeOptions& options) {
  const auto require = [](bool ok, const char* rule, double value) {
    if (!ok) throw SetupError(std::string("runtime: ") + rule + ", got " + std::to_string(value));
  };
  require(std::isfinite(options.duration_s) && options.duration_s >= 0.0,
          "duration_s must not be negative", options.duration_s);
  require(std::isfinite(options.longest_stop_s) && options.longest_stop_s > 0.0,
          "longest_stop_s must be above 0", options.longest_stop_s);
  check_thread_options(options.thread);
}

Runtime::Runtime(const RuntimeOptions& options, controller::Cycle& cycle, device::Device& device)
    : options_((check_runtime_options(options), options)),
      cycle_(cycle),
      device_(device),
      connection_(dynamic_cast<const device::ConnectedDevice*>(&device)),
      session_(cycle, device,
               {.changes = options.changes,
                .load = options.load,
                .twin_force = options.twin_force,
                .twin_base = options.twin_base}),
      samples_(options.ring),
      hand_targets_(256),
      parameter_changes_(256),
      requests_(64),
      timed_panels_(options.panel) {}

Runtime::~Runtime() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

void Runtime::start() {
  if (options_.desk != nullptr) {
    stops_ = options_.desk->stops();
    holds_ = options_.desk->holds();
    script_releases_ = options_.desk->script_releases();
    options_.desk->open();
  }
  thread_ = std::thread([this] { loop(); });
}

const hqp::ProblemCapture& Runtime::kept_problems() const noexcept {
  return cycle_.kept_problems();
}

RuntimeReport Runtime::join() {
  if (thread_.joinable()) thread_.join();
  report_.dropped = samples_.dropped();
  return report_;
}

void Runtime::run_cycle() noexcept HG_NONBLOCKING {
  if (options_.desk != nullptr) session_.input().is_clutch_open = options_.desk->is_clutch_open();
  session_.read();
  Sample& sample = session_.sample();
  OperatorFrame& input = sample.operator_input;
  read_ns_ = stage_ns_ = now_ns();
  while (hand_targets_.pop(session_.input().hand_target)) {
  }
  input.hand_target = session_.input().hand_target;
  if (input.change.parameter == Parameter::kNone) parameter_changes_.pop(input.change);
  read_desk(input);
  session_.step();
  const std::int64_t end_ns = now_ns();
  session_.write();
  sample.cycle_time_us = 1e-3 * static_cast<double>(end_ns - read_ns_);
  if (!options_.is_fast) count_stages();
  const bool is_slow = sample.cycle_time_us > options_.slow_cycle_us;
  if (is_slow && (report_.thread.priority > 0 || options_.is_fast)) {
    cycle_.keep_problem(sample.cycle_time_us);
  }
}

void Runtime::stage_ended(void* runtime, Stage stage) noexcept {
  auto& self = *static_cast<Runtime*>(runtime);
  const std::int64_t now = now_ns();
  self.stage_time_ns_[index(stage)] += now - self.stage_ns_;
  self.stage_ns_ = now;
}

void Runtime::count_stages() noexcept {
  for (std::size_t i = 0; i < stage_time_ns_.size(); ++i) {
    std::int64_t& time_ns = stage_time_ns_[i];
    if (time_ns > 0) report_.stage_us[i].add(1e-3 * static_cast<double>(time_ns));
    time_ns = 0;
  }
}

bool Runtime::stop_is_requested() const noexcept {
  return stop_requested_.load(std::memory_order_relaxed) ||
         (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) ||
         (options_.desk != nullptr && options_.desk->end_was_asked());
}

Schedule Runtime::new_schedule() const noexcept {
  return Schedule(now_ns(), std::llround(1e9 / (cycle_.device().rate_Hz * speed_)),
                  report_.reported_late_cycles ? 0 : Schedule::kMostToMakeUp);
}

// Waits until the next cycle is due. Cycles skipped by a pause are not late.
void Runtime::wait_for_turn(Schedule& schedule) noexcept {
  sleep_until(schedule.due_ns());
  report_.wake_up_us.add(1e-3 * static_cast<double>(now_ns() - schedule.due_ns()));
  bool was_paused = false;
  while (!pace_.may_run() && !stop_is_requested()) {
    was_paused = true;
    sleep_until(now_ns() + kPausePoll);
  }
  const double speed = pace_.speed();
  if (!was_paused && speed == speed_) return;
  speed_ = speed;
  schedule = new_schedule();
}

// Cycles missed by a device that is the clock, because this one began too late or took too long.
std::uint32_t Runtime::late_for_device() noexcept {
  const auto periods = [&](std::int64_t time_ns) {
    const double count = 1e-9 * static_cast<double>(time_ns) * cycle_.device().rate_Hz;
    return static_cast<std::uint32_t>(std::min(count, 1e6));
  };
  const std::uint32_t late = periods(now_ns() - read_ns_);
  if (connection_ == nullptr) return late;
  const std::int64_t woken_late_ns = connection_->late_ns();
  report_.wake_up_us.add(1e-3 * static_cast<double>(woken_late_ns));
  return late + periods(woken_late_ns);
}

void Runtime::count_late(std::uint32_t cycles) noexcept {
  report_.overruns += cycles;
  overruns_in_a_row_ = cycles == 0 ? 0 : overruns_in_a_row_ + cycles;
  report_.most_overruns_in_a_row = std::max(report_.most_overruns_in_a_row, overruns_in_a_row_);
  session_.input().late_cycles = report_.reported_late_cycles ? cycles : 0;
}

void Runtime::note(const CycleRecord& record) noexcept {
  ++report_.cycles;
  report_.has_run = report_.has_run || record.mode == Mode::kRunning;
  if (record.refusal != Refusal::kNone) report_.refusal = record.refusal;
  if (report_.fault.code == FaultCode::kNone) report_.fault = record.fault;
}

void Runtime::hand_out(const Sample& sample) noexcept {
  if (options_.is_fast && samples_.is_full()) {
    const AllowedToWait whoever_takes_them;  // no real time to keep
    while (samples_.is_full()) std::this_thread::yield();
  }
  samples_.push(sample);
}

// sends the last command: drives off, brakes closed, all speeds zero
void Runtime::release(CommandFrame& command) noexcept {
  disable(command);
  device_.write(command);
}

void Runtime::prepare_thread() noexcept {
  if (options_.is_fast) return;
  report_.thread = become_real_time(options_.thread);
  report_.reported_late_cycles = options_.reports_late_cycles && report_.thread.priority > 0;
  cycle_.watch({.ended = &Runtime::stage_ended, .listener = this});
}

// An emergency stop released by an operator stays released until the script presses it again.
void Runtime::play_script(const TimedPanel& due) noexcept {
  const bool stays_pressed = timed_panel_.emergency_stop && due.panel.emergency_stop;
  const bool was_pressed = script_panel_.emergency_stop;
  timed_panel_ = script_panel_ = due.panel;
  if (stays_pressed) script_panel_.emergency_stop = was_pressed;
}

// Request of the next cycle: by script, by an operator, or automatic.
void Runtime::operate(bool is_stopping) noexcept {
  script_panel_.reset = false;
  Request next;
  request_stops_.reset();
  bool is_asked = requests_.pop(next);
  if (is_asked) {
    is_operated_ = is_operated_ || takes_over(next.request);
    request_stops_ = next.stops;
  }
  if (const TimedPanel* due = timed_panels_.due(cycle_.time_s())) {
    play_script(*due);
    if (due->request != ModeRequest::kNone) {
      next.request = due->request;
      request_stops_.reset();
      is_asked = true;
      is_operated_ = is_operated_ || takes_over(due->request);
    }
  }
  const bool is_fault = session_.record().mode == Mode::kFault;
  is_operated_ = is_operated_ || (options_.stays_in_fault && is_fault);
  if (is_operated_ || is_asked) session_.request(next.request);
  if (is_stopping) session_.stop();
}

// Panel of this cycle, and stops of pages: requests made before a stop are dropped.
void Runtime::read_desk(OperatorFrame& input) noexcept {
  input.panel = script_panel_;
  if (is_reset_pressed_.load(std::memory_order_relaxed)) {
    input.panel.reset = is_reset_pressed_.exchange(false) || input.panel.reset;
  }
  if (options_.desk == nullptr) return;
  OperatorDesk& desk = *options_.desk;
  const std::uint32_t releases = desk.script_releases();
  if (std::exchange(script_releases_, releases) != releases) {
    script_panel_.emergency_stop = input.panel.emergency_stop = false;
  }
  desk.tell_script_stop(script_panel_.emergency_stop);
  desk.look(now_ns(), input.panel);
  const std::uint32_t stops = desk.stops(), holds = desk.holds();
  is_operated_ = is_operated_ || stops != stops_;
  stops_ = stops;
  if (request_stops_ && *request_stops_ != stops) input.request = ModeRequest::kNone;
  if (std::exchange(holds_, holds) != holds) input.request = ModeRequest::kStop;
}

void Runtime::loop() noexcept {
  prepare_thread();
  Schedule schedule = new_schedule();
  const long faults_before = page_faults();

  AllocationCounter allocations;
  double stop_since_s = -1.0;
  WayToRest way_to_rest(options_.longest_stop_s);
  Sample& sample = session_.sample();
  while (true) {
    run_cycle();
    const CycleRecord& record = sample.record;
    note(record);
    hand_out(sample);

    const bool is_over = options_.duration_s > 0.0 && record.time_s >= options_.duration_s;
    const bool is_stopping = is_over || stop_is_requested();
    if (is_stopping && stop_since_s < 0.0) stop_since_s = record.time_s;
    const bool ends_in_fault = !options_.stays_in_fault || is_stopping;
    if (record.mode == Mode::kFault && ends_in_fault && way_to_rest.is_over(sample)) break;
    const bool is_at_rest = record.mode != Mode::kRunning && record.mode != Mode::kStopping;
    if (is_stopping && is_at_rest && record.mode != Mode::kFault) break;
    const bool has_waited = is_stopping && record.time_s > stop_since_s + options_.longest_stop_s;
    report_.stop_timed_out = has_waited && record.mode != Mode::kFault;
    if (has_waited) break;
    operate(is_stopping);

    if (options_.is_fast) continue;
    const std::uint32_t late = device_.is_clock() ? late_for_device() : schedule.advance(now_ns());
    count_late(late);
    if (!device_.is_clock()) wait_for_turn(schedule);
  }
  release(sample.command);
  cycle_.watch({});
  report_.page_faults = page_faults() - faults_before;
  report_.allocations = allocations.count();
  if (options_.desk != nullptr) options_.desk->close();
  finished_.store(true);
}

}  // namespace hg::runtime
