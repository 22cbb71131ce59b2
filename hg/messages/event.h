/// Message of a noteworthy event in a recording.
#pragma once

#include <string>

#include "hg/core/fields.h"

namespace hg::messages {

/// Noteworthy event in a recording.
struct Event {
  double time_s = 0.0;
  std::string name, text;
};

template <typename Archive, Is<Event> T>
void fields(Archive& a, T& event) {
  a("time_s", event.time_s, "nominal time of the run", unit::kS);
  a("name", event.name);
  a("text", event.text);
}

}  // namespace hg::messages
