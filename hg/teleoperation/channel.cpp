#include "hg/teleoperation/channel.h"

#include <string>

#include "hg/core/error.h"

namespace hg::teleoperation {

void check_channel(const ChannelConfig& config) {
  const auto require = [](bool ok, const char* rule, double value) {
    if (!ok) throw SetupError(std::string("link: ") + rule + ", got " + std::to_string(value));
  };
  constexpr double kLongest = 10.0;  // s
  require(config.delay >= 0.0 && config.delay <= kLongest, "delay must be 0..10 s", config.delay);
  require(config.jitter >= 0.0 && config.jitter <= kLongest, "jitter must be 0..10 s",
          config.jitter);
  require(config.loss >= 0.0 && config.loss <= 1.0, "loss must be 0..1", config.loss);
  require(config.burst == 0.0 || config.burst >= 1.0, "burst must be 0 or at least 1",
          config.burst);
}

}  // namespace hg::teleoperation
