#include "apps/hapticgiant/experiments/figure_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "hg/config/shipped_files.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kNoMatplotlib = 3;  // exit code of figures.py and of report

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

// Words that start `name`, a file or folder of python/hapticgiant, or its module where the package
// is installed.
std::vector<std::string> program_of(const std::string& name, const std::string& module) {
  const fs::path home = config::installation_root();
  const fs::path script = home / "python" / "hapticgiant" / name;
  std::error_code error;
  std::vector<std::string> words = {interpreter(home), "-B"};
  if (!home.empty() && fs::exists(script, error)) {
    words.push_back(script.string());
  } else {
    words.insert(words.end(), {"-m", module});
  }
  return words;
}

bool is_incomplete(int code) { return code == 127 || code == kNoMatplotlib; }

}  // namespace

std::string draw_figures(const fs::path& out, const std::vector<fs::path>& folders) {
  std::vector<std::string> words = program_of("figures.py", "hapticgiant.figures");
  words.push_back(fs::absolute(out).string());
  for (const fs::path& folder : folders) words.push_back(fs::absolute(folder).string());
  const int code = run_program(words);
  if (code == 0) return {};
  if (is_incomplete(code)) {
    return fmt::format(
        "no figures: {} has no matplotlib; tools/setup.sh build, or pip install "
        "matplotlib, then the same command again",
        words[0]);
  }
  return fmt::format("no figures: {} ended with {}", words[2], code);
}

void check_report_program() {
  std::vector<std::string> words = program_of("report", "hapticgiant.report");
  words.emplace_back("--check");
  if (run_program(words) == 0) return;
  throw SetupError(fmt::format(
      "{} cannot write the report: it needs scipy, matplotlib and jinja2; tools/setup.sh build, or "
      "pip install scipy matplotlib jinja2, then the same command again",
      words[0]));
}

void write_report(const fs::path& folder, const std::string& docs) {
  std::vector<std::string> words = program_of("report", "hapticgiant.report");
  words.push_back(fs::absolute(folder).string());
  if (!docs.empty()) words.insert(words.end(), {"--docs", fs::absolute(docs).string()});
  const int code = run_program(words);
  if (code == 0) return;
  throw SetupError(fmt::format("{}: no report: {} ended with {}; the results are kept",
                               (folder / "results.json").string(), words[2], code));
}

}  // namespace hg::apps
