#include "hg/doctor/jitter.h"

#include <cmath>
#include <cstdint>
#include <thread>

#include "hg/core/monotonic_clock.h"

namespace hg::doctor {
namespace {

void measure(double seconds, const runtime::ThreadOptions& options, Jitter& jitter) noexcept {
  jitter.thread = runtime::become_real_time(options);
  const std::int64_t period_ns = std::llround(1e9 / jitter.rate_Hz);
  const auto periods = static_cast<std::int64_t>(seconds * jitter.rate_Hz);
  std::int64_t due_ns = now_ns();
  for (std::int64_t i = 0; i < periods; ++i) {
    due_ns += period_ns;
    sleep_until(due_ns);
    const std::int64_t late_ns = now_ns() - due_ns;
    jitter.wake_up_us.add(1e-3 * static_cast<double>(late_ns));
    // missed periods appear as one, with their whole length
    if (late_ns > period_ns) due_ns += late_ns / period_ns * period_ns;
  }
}

}  // namespace

Jitter measure_jitter(double rate_Hz, double seconds, const runtime::ThreadOptions& options) {
  Jitter jitter;
  jitter.rate_Hz = rate_Hz;
  std::thread thread([&] { measure(seconds, options, jitter); });
  thread.join();
  return jitter;
}

}  // namespace hg::doctor
