/// Description of the switches of the panel in a scenario.
#pragma once

#include <array>
#include <vector>

#include "hg/config/schema.h"
#include "hg/signals/timed_panel.h"

namespace hg::config {

inline constexpr std::array<Choice<ModeRequest>, 6> kRequests = {
    {{"arm", ModeRequest::kArm},
     {"run", ModeRequest::kRun},
     {"run_alone", ModeRequest::kAutonomous},
     {"stop", ModeRequest::kStop},
     {"reset", ModeRequest::kReset},
     {"tare", ModeRequest::kTare}}};

template <class V>
void describe(V& v, std::vector<TimedPanel>& panels) {
  TimedPanel now;
  if (!panels.empty()) now = panels.back();  // values not given stay unchanged
  const double last_s = now.at_s;
  now.request = ModeRequest::kNone;
  now.panel.reset = false;
  v.number("at_s", now.at_s, kNotNegative, "when this is done", Need::kRequired);
  v.rule(now.at_s >= last_s, "at_s", "events must be in the order of their times");
  v.flag("emergency_stop", now.panel.emergency_stop, "whether the stop button is pressed");
  v.flag("operator_enable", now.panel.operator_enable, "whether the enabling switch is held");
  v.flag("override_key", now.panel.override_key, "whether the override key is turned");
  v.flag("person_in_field", now.panel.person_in_field,
         "whether a person besides the user is in the scanner's field");
  v.flag("reset", now.panel.reset, "presses the reset button of the safety controller");
  v.choice("request", now.request, kRequests,
           "requested mode; after the first request other than a tare none is made automatically");
  panels.push_back(now);
}

template <class V>
void describe_panel(V& v, std::vector<TimedPanel>& panels) {
  v.list(
      "panel", [&](auto& child) { describe(child, panels); },
      "what a simulated operator does; first the switch is held and nothing else is touched; what "
      "an entry does not give stays as it is");
}

}  // namespace hg::config
