#include "hg/scenario/run/run_streams.h"

#include <fmt/format.h>

#include <cstdlib>

namespace hg::scenario {
namespace {

// coordinates of the twin, in their order
std::vector<lab_streaming::Channel> coordinates_of(const config::Scenario& scenario) {
  std::vector<lab_streaming::Channel> all;
  for (const model::Joint& joint : scenario.twin.model.chain.joints()) {
    if (joint.type != model::JointType::kFloating) {
      all.push_back({joint.name, joint.is_slide() ? "m" : "rad"});
      continue;
    }
    for (const char* entry : {"x", "y", "z"}) all.push_back({joint.name + "." + entry, "m"});
    for (const char* entry : {"qx", "qy", "qz", "qw"})
      all.push_back({joint.name + "." + entry, ""});
  }
  return all;
}

}  // namespace

std::vector<std::string> lab_libraries(std::vector<std::string> packaged) {
  if (const char* chosen = std::getenv("PYLSL_LIB")) return {chosen};
  packaged.insert(packaged.end(), {"liblsl.so.2", "liblsl.so"});
  return packaged;
}

std::unique_ptr<lab_streaming::LabStreams> open_lab_streams(const lab_streaming::Liblsl& library,
                                                            const config::Scenario& scenario) {
  return std::make_unique<lab_streaming::LabStreams>(
      library, lab_streaming::StreamPlan{.rate_Hz = scenario.device.model.rate_Hz,
                                         .source = "HapticGiant " + scenario.device.name,
                                         .twin = coordinates_of(scenario)});
}

std::string to_text(const lab_streaming::StreamCounts& counts) {
  return fmt::format("  lab streams  {} samples, {} markers{}\n", counts.samples, counts.markers,
                     counts.dropped == 0
                         ? std::string()
                         : fmt::format("; LOST {} samples or markers", counts.dropped));
}

}  // namespace hg::scenario
