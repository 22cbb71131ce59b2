/// The device of a recording.
#pragma once

#include <string>
#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/recording/recorder.h"

namespace hg::identify {

/// The device that the recording `file` was made with, from the configuration in it. Throws
/// SetupError that asks for a device where that is not understood.
config::SimulatedDeviceConfig recorded_device(
    const std::string& file, const std::vector<recording::NamedText>& configuration);

}  // namespace hg::identify
