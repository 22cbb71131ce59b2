#include "apps/hapticgiant/python_commands.h"

#include <CLI/CLI.hpp>
#include <string>

#include "apps/hapticgiant/python_program.h"

namespace hg::apps {
namespace {

struct PythonCommand {
  const char* name;  // also of its part
  const char* description;
};

constexpr PythonCommand kCommands[] = {
    {"sweep", "Many runs over a table of parameters, here or on a cluster (docs/start/sweep.md)."},
    {"imus",
     "Where inertial sensors observe best the joints of any URDF "
     "(docs/start/imu_placement.md)."},
    {"study", "User studies: plan, check, simulate, report (docs/start/user_studies.md)."}};

}  // namespace

void add_python_commands(CLI::App& app) {
  for (const auto& [name, description] : kCommands) {
    CLI::App* command = app.add_subcommand(name, description);
    command->set_help_flag();  // everything is Python's, --help too
    command->prefix_command();
    command->callback(
        [command] { become_python_program(command->get_name(), command->remaining()); });
  }
}

}  // namespace hg::apps
