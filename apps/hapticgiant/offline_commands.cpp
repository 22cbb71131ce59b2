#include "apps/hapticgiant/offline_commands.h"

#include <algorithm>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/hapticgiant/sibling_program.h"
#include "apps/hapticgiant/start.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

// What follows the name of such a command is completed by the program that has it.
void complete_offline(const std::vector<std::string>& words) {
  if (std::ranges::find(kOfflineCommands, words[1], &OfflineCommand::name) ==
      kOfflineCommands.end()) {
    return;
  }
  try {
    become_sibling("offline", words, "", "");
  } catch (const SetupError&) {  // not built: there is nothing to complete
  }
}

}  // namespace

void add_offline_commands(Command app, int argc, char** argv) {
  // from the command's name on: no option of the program stands before it
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (is_completion(argc, argv) && words.size() > 2) complete_offline(words);
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
