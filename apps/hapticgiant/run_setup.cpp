#include "apps/hapticgiant/run_setup.h"

#include "apps/hapticgiant/version.h"

namespace hg::apps {

recording::RecordingInfo recording_info(const config::Scenario& scenario,
                                        const scenario::ScenarioOptions& options,
                                        const std::string& folder) {
  recording::RecordingInfo info = scenario::recording_info(scenario, options);
  info.folder = folder;
  info.version = kVersion;
  return info;
}

}  // namespace hg::apps
