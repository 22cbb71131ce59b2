/// Wake-up latency of a thread that sleeps from one whole period to the next, as the control loop
/// does.
#pragma once

#include <string>

#include "hg/core/histogram.h"
#include "hg/runtime/control_thread.h"

namespace hg::doctor {

struct Jitter {
  double rate_Hz = 0.0;
  runtime::ThreadReport thread;
  Histogram wake_up_us;  ///< latency after the end of the sleep, us
};

/// Measures the latency on a thread of its own, for `seconds`. Locks the memory of the program
/// where options.priority > 0 and the system allows it.
Jitter measure_jitter(double rate_Hz, double seconds, const runtime::ThreadOptions& options);

}  // namespace hg::doctor
