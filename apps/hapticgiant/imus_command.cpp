#include "apps/hapticgiant/imus_command.h"

#include <CLI/CLI.hpp>

#include "apps/hapticgiant/python_program.h"

namespace hg::apps {

void add_imus(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("imus",
                         "Where inertial sensors tell most about the joints of any URDF "
                         "(docs/start/imu_placement.md).");
  command->set_help_flag();  // everything is Python's, --help too
  command->prefix_command();
  command->callback([command] { become_python_program("imus", command->remaining()); });
}

}  // namespace hg::apps
