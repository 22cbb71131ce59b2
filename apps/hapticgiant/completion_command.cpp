#include "apps/hapticgiant/completion_command.h"

#include <memory>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"

namespace hg::apps {
namespace {

struct Script {
  const char *shell, *text;
};

// Each asks the program (kComplete of start.h); where it has no answer, files are completed.
constexpr Script kScripts[] = {{"bash", R"script(_hapticgiant() {
  mapfile -t COMPREPLY < <("$1" __complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -o default -F _hapticgiant hapticgiant
)script"},
                               {"zsh", R"script(_hapticgiant() {
  local -a found
  found=(${(f)"$("${words[1]}" __complete "${(@)words[2,CURRENT]}" 2>/dev/null)"})
  if (( $#found )); then compadd -- $found; else _files; fi
}
compdef _hapticgiant hapticgiant
)script"},
                               {"fish", R"script(function __hapticgiant
  set -l words (commandline -opc) (commandline -ct)
  $words[1] __complete $words[2..-1] 2>/dev/null
end
complete -c hapticgiant -a '(__hapticgiant)'
)script"}};

}  // namespace

void add_completion(Command app) {
  const Command command = app.add_subcommand(
      "completion", "Prints the script by which a shell completes this program's command lines.");
  command.footer(
      "bash: eval \"$(hapticgiant completion bash)\" in ~/.bashrc; zsh likewise, after compinit");
  const auto shell = std::make_shared<std::string>();
  std::vector<std::string> names;
  for (const Script& script : kScripts) names.emplace_back(script.shell);
  command.add_option("shell", *shell, "the shell").one_of(names).required();
  command.callback([shell] {
    for (const Script& script : kScripts) {
      if (*shell == script.shell) print_out(std::string(script.text));
    }
  });
}

}  // namespace hg::apps
