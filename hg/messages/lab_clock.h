/// Message of the lab's clock in a recording.
#pragma once

#include "hg/core/fields.h"

namespace hg::messages {

/// From this moment of the run on, the local clock of the Lab Streaming Layer is run time plus the
/// offset.
struct LabClock {
  double time_s = 0.0;
  double offset_s = 0.0;
};

template <typename Archive, Is<LabClock> T>
void fields(Archive& a, T& clock) {
  a("time_s", clock.time_s, "nominal time of the run from which on the offset is stated", unit::kS);
  a("offset_s", clock.offset_s, "local clock of LSL minus nominal time of the run", unit::kS);
}

}  // namespace hg::messages
