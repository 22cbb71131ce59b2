#include "hg/simulator/person/script.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hg::person {

double minimum_jerk(double t, double start, double duration) noexcept {
  const double x = std::clamp((t - start) / duration, 0.0, 1.0);
  return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
}

std::array<double, kChannels> evaluate(const Script& script, double t) noexcept {
  std::array<double, kChannels> value = script.start;
  for (const Segment& segment : script.segments) {
    const double share = minimum_jerk(t, segment.start_s, segment.duration_s);
    if (share == 0.0) continue;
    double& channel = value[segment.channel];
    switch (segment.blend) {
      case Blend::kTo:
        channel += share * (segment.value - channel);
        break;
      case Blend::kBy:
        channel += share * segment.value;
        break;
      case Blend::kCircle: {
        // x and y turn about the origin, the azimuth turns along
        const double angle = 2.0 * std::numbers::pi * segment.value * share;
        const double x = value[0], y = value[1];
        value[0] = x * std::cos(angle) - y * std::sin(angle);
        value[1] = x * std::sin(angle) + y * std::cos(angle);
        value[3] += angle;
        break;
      }
    }
  }
  return value;
}

}  // namespace hg::person
