/// `hapticgiant run`: a person at a device, and the twin felt at its handle.
#pragma once

#include <optional>
#include <string>

#include "hg/scenario/run/run_plan.h"

namespace hg::apps {

class Command;

struct RunArguments {
  std::string program = "hapticgiant";  ///< program name as called, for printed commands
  scenario::RunPlan plan;
  std::string request;           ///< file of a plan in JSON, "-" = standard input; empty = none
  std::optional<int> report_to;  ///< descriptor for reports as JSON lines
  std::string summary;           ///< JSON file; empty = none
  bool is_list = false;          ///< prints what is shipped, and runs nothing
};

/// Exit code: that of scenario::RunOutcome; also 4 if the summary could not be written. Throws
/// SetupError for bad input.
int run(const RunArguments& arguments);

/// Adds the subcommand to the program, which was called as `program`; running it sets `exit_code`.
void add_run(Command app, const std::string& program, int& exit_code);

}  // namespace hg::apps
