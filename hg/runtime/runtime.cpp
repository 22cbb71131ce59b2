#include "hg/runtime/runtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/runtime/requests.h"

namespace hg::runtime {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr std::int64_t kPausePoll = 2'000'000;  // ns
constexpr double kLongestStop = 1.0;  // s; a device that is still moving then is left to its brakes

// SCHED_FIFO where the system allows it
bool become_real_time() noexcept {
  sched_param priority{};
  priority.sched_priority = 80;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority) == 0;
}

std::int64_t now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNanoseconds + now.tv_nsec;
}

void sleep_until(std::int64_t time_ns) noexcept {
  const timespec time{.tv_sec = time_ns / kNanoseconds, .tv_nsec = time_ns % kNanoseconds};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

}  // namespace

void check(const Options& options) {
  const auto require = [](bool ok, const char* rule, double value) {
    if (!ok) throw SetupError(std::string("runtime: ") + rule + ", got " + std::to_string(value));
  };
  require(options.rate_Hz >= 100.0 && options.rate_Hz <= 20000.0, "rate_Hz must be 100..20000",
          options.rate_Hz);
  require(std::isfinite(options.duration_s) && options.duration_s >= 0.0,
          "duration_s must not be negative", options.duration_s);
}

Runtime::Runtime(const Options& options, cycle::Cycle& cycle, device::Device& device)
    : options_((check(options), options)),
      cycle_(cycle),
      device_(device),
      samples_(options.ring),
      hand_targets_(256),
      parameter_changes_(256),
      changes_(options.changes) {}

Runtime::~Runtime() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

void Runtime::start() {
  thread_ = std::thread([this] { loop(); });
}

Report Runtime::join() {
  if (thread_.joinable()) thread_.join();
  report_.dropped = samples_.dropped();
  return report_;
}

void Runtime::run_cycle(Sample& sample) noexcept {
  device_.read(sample.sensors);
  const Truth* truth = device_.truth();
  sample.truth = truth != nullptr ? *truth : Truth{};
  const auto begin = std::chrono::steady_clock::now();
  while (hand_targets_.pop(sample.operator_input.hand_target)) {
  }
  sample.operator_input.change = next_change();
  cycle_.step(sample.sensors, sample.operator_input, sample.command, sample.record);
  const auto end = std::chrono::steady_clock::now();
  device_.write(sample.command);
  sample.cycle_time_us = std::chrono::duration<double, std::micro>(end - begin).count();
  const bool is_slow = sample.cycle_time_us > options_.slow_cycle_us;
  if (is_slow && (report_.is_real_time || options_.is_fast)) {
    cycle_.keep_problem(sample.cycle_time_us);
  }
}

ParameterChange Runtime::next_change() noexcept {
  ParameterChange change = changes_.due(static_cast<double>(report_.cycles) / options_.rate_Hz);
  if (change.parameter == Parameter::kNone) parameter_changes_.pop(change);
  return change;
}

// Until the next cycle is due. Cycles that were not run while paused are not late.
void Runtime::wait_for_turn(Schedule& schedule) noexcept {
  report_.overruns += schedule.advance(now_ns());
  sleep_until(schedule.due_ns());
  bool was_paused = false;
  while (!pace_.may_run() && !stop_requested_.load(std::memory_order_relaxed)) {
    was_paused = true;
    sleep_until(now_ns() + kPausePoll);
  }
  const double speed = pace_.speed();
  if (!was_paused && speed == speed_) return;
  speed_ = speed;
  schedule = Schedule(now_ns(), std::llround(1e9 / (options_.rate_Hz * speed)));
}

void Runtime::hand_out(const Sample& sample) noexcept {
  while (options_.is_fast && samples_.is_full()) std::this_thread::yield();
  samples_.push(sample);
}

// drives off, brakes closed, nothing moves
void Runtime::release(CommandFrame& command) noexcept {
  command.enable = false;
  command.dq_m.setZero();
  command.ddq_m.setZero();
  command.tau_m.setZero();
  command.dq_p.setZero();
  device_.write(command);
}

void Runtime::loop() noexcept {
  if (!options_.is_fast) {
    report_.is_real_time = become_real_time();
    report_.is_memory_locked = report_.is_real_time && mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  }
  const auto sample = std::make_unique<Sample>();
  Schedule schedule(now_ns(), std::llround(1e9 / options_.rate_Hz));

  AllocationCounter allocations;
  double stop_since_s = -1.0;
  while (true) {
    run_cycle(*sample);
    const CycleRecord& record = sample->record;
    ++report_.cycles;
    hand_out(*sample);

    const bool is_over = options_.duration_s > 0.0 && record.time_s >= options_.duration_s;
    const bool is_stopping = is_over || stop_requested_.load(std::memory_order_relaxed);
    if (is_stopping && stop_since_s < 0.0) stop_since_s = record.time_s;
    const bool is_at_rest = record.mode != Mode::kRunning && record.mode != Mode::kStopping;
    if (record.mode == Mode::kFault || (is_stopping && is_at_rest)) break;
    report_.stop_timed_out = is_stopping && record.time_s > stop_since_s + kLongestStop;
    if (report_.stop_timed_out) break;
    sample->operator_input.request =
        next_request(record, cycle_.is_held(sample->sensors), is_stopping);

    if (options_.is_fast || device_.is_clock()) continue;
    wait_for_turn(schedule);
  }
  release(sample->command);
  report_.allocations = allocations.count();
  finished_.store(true);
}

}  // namespace hg::runtime
