#include "bench/player.h"

namespace hg::bench {

config::Scenario with_law(config::Scenario scenario, rendering::Law law, rendering::Bounds bounds) {
  scenario.device.rendering.law = law;
  scenario.device.rendering.bounds = bounds;
  return scenario;
}

}  // namespace hg::bench
