#include "apps/hapticgiant/study_command.h"

#include <CLI/CLI.hpp>

#include "apps/hapticgiant/python_program.h"

namespace hg::apps {

void add_study(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "study", "User studies: plan, check, simulate, report (docs/start/user_studies.md).");
  command->set_help_flag();  // everything is Python's, --help too
  command->prefix_command();
  command->callback([command] { become_python_program("study", command->remaining()); });
}

}  // namespace hg::apps
