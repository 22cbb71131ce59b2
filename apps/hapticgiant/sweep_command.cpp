#include "apps/hapticgiant/sweep_command.h"

#include <CLI/CLI.hpp>

#include "apps/hapticgiant/python_program.h"

namespace hg::apps {

void add_sweep(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Many runs over a table of parameters, here or on a cluster (docs/start/sweep.md).");
  command->set_help_flag();  // everything is Python's, --help too
  command->prefix_command();
  command->callback([command] { become_python_program("sweep", command->remaining()); });
}

}  // namespace hg::apps
