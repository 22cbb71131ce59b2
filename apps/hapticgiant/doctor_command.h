/// Says how ready this computer is for a control loop, and what to change.
#pragma once

#include <string>

namespace hg::apps {

struct DoctorArguments {
  double seconds = 3.0;  ///< of each of the four measurements
  int priority = 80;     ///< as in run
  int cpu = -1;          ///< as in run
  std::string json;      ///< file; empty = none
};

/// Exit code: 0 nothing is bad, 1 something is. Throws SetupError.
int doctor(const DoctorArguments& arguments);

}  // namespace hg::apps
