#include "apps/hapticgiant/lab_streams.h"

#include <cstdlib>
#include <string>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/report.h"

namespace hg::apps {
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

std::unique_ptr<lab_streaming::Liblsl> load_liblsl() {
  std::vector<std::string> candidates;
  if (const char* chosen = std::getenv("PYLSL_LIB")) {
    candidates.emplace_back(chosen);
  } else {
    const std::string package = python_package_folder("pylsl");
    if (!package.empty()) candidates.push_back(package + "/lib/liblsl.so");
    candidates.insert(candidates.end(), {"liblsl.so.2", "liblsl.so"});
  }
  return std::make_unique<lab_streaming::Liblsl>(candidates);
}

std::unique_ptr<lab_streaming::LabStreams> open_lab_streams(const lab_streaming::Liblsl& library,
                                                            const config::Scenario& scenario) {
  auto streams = std::make_unique<lab_streaming::LabStreams>(
      library, lab_streaming::StreamPlan{.rate_Hz = scenario.device.model.rate_Hz,
                                         .source = "HapticGiant " + scenario.device.name,
                                         .twin = coordinates_of(scenario)});
  print_out("lab streams HapticGiant and HapticGiantEvents, by {}\n", library.file());
  return streams;
}

void print_streamed(const lab_streaming::StreamCounts& counts) {
  print_out("  lab streams  {} samples, {} markers{}\n", counts.samples, counts.markers,
            counts.dropped == 0 ? std::string()
                                : fmt::format("; LOST {} samples or markers", counts.dropped));
}

}  // namespace hg::apps
