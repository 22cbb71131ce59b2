#include "hg/identify/recorded_device.h"

#include <fmt/format.h>

#include "hg/core/error.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::identify {

config::SimulatedDeviceConfig recorded_device(
    const std::string& file, const std::vector<recording::NamedText>& configuration) {
  try {
    return scenario::recorded_scenario(configuration).device;
  } catch (const SetupError& error) {
    throw SetupError(
        fmt::format("{}: its configuration is not understood, give the device with --device: {}",
                    file, error.what()));
  }
}

}  // namespace hg::identify
