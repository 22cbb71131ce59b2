/// The Lab Streaming Layer of a run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/lab_streaming/lab_streams.h"

namespace hg::scenario {

/// Files of liblsl to try: that of the variable PYLSL_LIB alone; else `packaged`, those of a
/// package, and the system's.
std::vector<std::string> lab_libraries(std::vector<std::string> packaged = {});

/// Opens the streams of a run. `library` must outlive them. Throws SetupError.
std::unique_ptr<lab_streaming::LabStreams> open_lab_streams(const lab_streaming::Liblsl& library,
                                                            const config::Scenario& scenario);

/// The line of the summary.
std::string to_text(const lab_streaming::StreamCounts& counts);

}  // namespace hg::scenario
