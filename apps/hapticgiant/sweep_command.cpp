#include "apps/hapticgiant/sweep_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/hapticgiant/python_program.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

// Does not return, but for an interpreter that cannot be started.
void become_sweep(const std::vector<std::string>& arguments) {
  std::error_code error;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  setenv("HAPTICGIANT_PROGRAM", program.c_str(), 1);  // plays the runs
  std::vector<std::string> words = python_program("sweep");
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data());
  throw SetupError(fmt::format("sweep: {} cannot be started", words[0]));
}

}  // namespace

void add_sweep(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Many runs over a table of parameters, here or on a cluster (docs/start/sweep.md).");
  command->set_help_flag();  // everything is Python's, --help too
  command->prefix_command();
  command->callback([command] { become_sweep(command->remaining()); });
}

}  // namespace hg::apps
