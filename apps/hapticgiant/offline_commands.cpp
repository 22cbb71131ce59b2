#include "apps/hapticgiant/offline_commands.h"

#include <vector>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/sibling_program.h"

namespace hg::apps {

void add_offline_commands(Command app) {
  for (const OfflineCommand& offline : kOfflineCommands) {
    const Command command =
        app.add_subcommand(std::string(offline.name), std::string(offline.description));
    command.take_all_words();
    command.callback([command] {
      std::vector<std::string> words = {command.name()};
      for (const std::string& word : command.remaining()) words.push_back(word);
      become_sibling("offline", words, command.name() + ": not built",
                     "'make build' makes it from source");
    });
  }
}

}  // namespace hg::apps
