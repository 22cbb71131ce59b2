/// The Lab Streaming Layer of `hapticgiant run --lsl`.
#pragma once

#include <memory>

#include "hg/config/simulation/scenario.h"
#include "hg/lab_streaming/lab_streams.h"

namespace hg::apps {

/// liblsl from the file that PYLSL_LIB names; else that of the package pylsl of the interpreter
/// that writes reports (report.h); else the system's. Throws SetupError.
std::unique_ptr<lab_streaming::Liblsl> load_liblsl();

/// Opens the streams of a run. `library` must outlive them. Throws SetupError.
std::unique_ptr<lab_streaming::LabStreams> open_lab_streams(const lab_streaming::Liblsl& library,
                                                            const config::Scenario& scenario);

/// Prints the line of the summary.
void print_streamed(const lab_streaming::StreamCounts& counts);

}  // namespace hg::apps
