#include "apps/hapticgiant/experiments/figure_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "hg/config/shipped_files.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kNoMatplotlib = 3;  // exit code of figures.py

std::string interpreter(const fs::path& root) {
  if (const char* chosen = std::getenv("HAPTICGIANT_PYTHON")) {
    const std::string name = chosen;
    return name.find('/') == std::string::npos ? name : fs::absolute(name).string();
  }
  const fs::path own = root / ".venv" / "bin" / "python";
  std::error_code error;
  return !root.empty() && fs::exists(own, error) ? own.string() : "python3";
}

// Exit code; 127: it could not be started. It starts in the root folder: Python would take modules
// from the working directory.
int run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addchdir_np(&actions, "/");
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return 127;
  int status = 0;
  if (waitpid(child, &status, 0) != child || !WIFEXITED(status)) return -1;
  return WEXITSTATUS(status);
}

}  // namespace

std::string draw_figures(const fs::path& out, const std::vector<fs::path>& folders) {
  const fs::path home = config::installation_root();
  const fs::path script = home / "python" / "hapticgiant" / "figures.py";
  const std::string python = interpreter(home);
  std::error_code error;
  std::vector<std::string> words = {python, "-B"};
  if (!home.empty() && fs::exists(script, error)) {
    words.push_back(script.string());
  } else {
    words.insert(words.end(), {"-m", "hapticgiant.figures"});
  }
  words.push_back(fs::absolute(out).string());
  for (const fs::path& folder : folders) words.push_back(fs::absolute(folder).string());
  const int code = run_program(words);
  if (code == 0) return {};
  if (code == 127 || code == kNoMatplotlib) {
    return fmt::format(
        "no figures: {} has no matplotlib; tools/setup.sh build, or pip install "
        "matplotlib, then the same command again",
        python);
  }
  return fmt::format("no figures: {} ended with {}", words[2], code);
}

}  // namespace hg::apps
