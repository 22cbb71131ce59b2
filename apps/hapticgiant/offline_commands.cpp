#include "apps/hapticgiant/offline_commands.h"

#include <algorithm>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/sibling_program.h"

namespace hg::apps {

void add_offline_commands(Command app, int argc, char** argv) {
  // from the command's name on: no option of the program stands before it
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  for (const OfflineCommand& offline : kOfflineCommands) {
    const Command command =
        app.add_subcommand(std::string(offline.name), std::string(offline.description));
    command.take_all_words();
    command.callback([command, words] {
      become_sibling("offline", words, command.name() + ": not built",
                     "'make build' makes it from source");
    });
  }
}

}  // namespace hg::apps
