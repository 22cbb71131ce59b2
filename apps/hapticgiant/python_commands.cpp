#include "apps/hapticgiant/python_commands.h"

#include <string>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/python_program.h"

namespace hg::apps {
namespace {

struct PythonCommand {
  const char* name;  // also of its part
  const char* description;
};

constexpr PythonCommand kCommands[] = {
    {"render", "A recording as a video, a GIF or a picture (docs/start/viewer.md)."},
    {"sweep", "Many runs over a table of parameters, here or on a cluster (docs/start/sweep.md)."},
    {"imus",
     "Where inertial sensors observe best the joints of any URDF "
     "(docs/start/imu_placement.md)."},
    {"study", "User studies: plan, check, simulate, report (docs/start/user_studies.md)."}};

}  // namespace

void add_python_commands(Command app) {
  for (const auto& [name, description] : kCommands) {
    const Command command = app.add_subcommand(name, description);
    command.take_all_words();  // --help is Python's, too
    command.callback([command] { become_python_program(command.name(), command.remaining()); });
  }
}

}  // namespace hg::apps
