/// Reports how suitable this computer is for a control loop, and what to change.
#pragma once

#include <string>

namespace hg::apps {

class Command;

struct DoctorArguments {
  double seconds = 3.0;  ///< duration of each of the four measurements
  int priority = 80;     ///< SCHED_FIFO priority, as in run
  int cpu = -1;          ///< CPU, as in run
  std::string json;      ///< JSON file; empty = none
};

/// Exit code: 0 nothing is bad, 1 something is. Throws SetupError.
int doctor(const DoctorArguments& arguments);

/// Adds the subcommand to the program; running it sets `exit_code`.
void add_doctor(Command app, int& exit_code);

}  // namespace hg::apps
