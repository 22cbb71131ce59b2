/// Description of the start test in device.yaml.
#pragma once

#include <string>
#include <vector>

#include "hg/config/schema.h"
#include "hg/signals/start_test_config.h"

namespace hg::config {

template <class V>
void describe(V& v, StartTestConfig& test) {
  const std::vector<std::string> names(kSafetyInputNames.begin(), kSafetyInputNames.end());
  std::vector<int> inputs;
  if (v.names("inputs", inputs, names, "an input of the safety controller",
              "that this device has and a person operates in the test; without it all, but for the "
              "dead-man switch of a tool that has none")) {
    test.has_input.fill(false);
    for (const int input : inputs) test.has_input[input] = true;
  }
  v.number("valid_for_s", test.valid_for_s, kPositive, "how long the result of a test counts");
  v.number("brake_motion_rad", test.brake_motion, kPositive,
           "that a braked revolute joint or axis may move under its load");
  v.number("brake_motion_m", test.slide_brake_motion, kPositive, "the same of a prismatic one");
  v.number("posture_rad", test.posture, kPositive,
           "that a revolute joint or axis may stand elsewhere than the last run has left it");
  v.number("posture_m", test.slide_posture, kPositive, "the same of a prismatic one");
}

}  // namespace hg::config
