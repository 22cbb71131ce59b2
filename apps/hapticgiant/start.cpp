#include "apps/hapticgiant/start.h"

#include <csignal>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/stack.h"
#include "apps/hapticgiant/version.h"
#include "hg/config/shipped_files.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

constexpr int kInternalError = 1, kBadInput = 2;

// `exit_code` is that of the subcommand that the command line names, which runs at once
int parse(Program& program, int argc, char** argv, const int& exit_code) {
  try {
    const std::optional<int> refused = program.parse(argc, argv);
    return refused.value_or(exit_code);
  } catch (const SetupError& error) {
    print_error("{}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    print_error("internal error: {}\n", error.what());
    return kInternalError;
  }
}

}  // namespace

bool is_completion(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == kComplete;
}

std::vector<char*> with_help_as_option(int argc, char** argv) {
  static char help[] = "--help";
  std::vector<char*> words(argv, argv + argc);
  if (argc > 1 && std::string_view(argv[1]) == "help") {
    words.erase(words.begin() + 1);
    words.push_back(help);
  }
  words.push_back(nullptr);
  return words;
}

int start(int argc, char** argv, const std::function<void(Command program, int& exit_code)>& add,
          const Advices& advices) {
  open_standard_files();
  if (const std::string lack = provide_stack(); !lack.empty()) {
    print_error("{}\n", lack);
    return kBadInput;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that must not grow is an error of that file

  Program program("HapticGiant: feel the digital twin of any serial chain.", "hapticgiant");
  program.set_version(kVersion);
  program.set_advices(advices);
  program.set_shipped_files(config::installation_root().string());
  program.command().require_subcommand(1);
  int exit_code = 0;
  add(program.command(), exit_code);
  if (is_completion(argc, argv)) {
    for (const std::string& word : program.command().completions({argv + 2, argv + argc})) {
      print_out(word + "\n");
    }
    return 0;
  }
  return code_after_output(parse(program, argc, argv, exit_code));
}

}  // namespace hg::apps
