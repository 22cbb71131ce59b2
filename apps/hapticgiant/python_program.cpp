#include "apps/hapticgiant/python_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/page/built_page.h"

namespace hg::apps {

namespace fs = std::filesystem;

namespace {

// Everything that comes from a descriptor until it closes.
std::string read_all(int descriptor) {
  std::string text;
  char part[4096];
  for (;;) {
    const ssize_t count = read(descriptor, part, sizeof part);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(part, count);
  }
}

// for C, with a null at the end
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

// returns only where it fails, with errno
void execute(std::vector<std::string>& words) {
  execvp(words[0].c_str(), pointers_to(words).data());
}

}  // namespace

std::string python_interpreter() {
  if (const char* chosen = std::getenv("HAPTICGIANT_PYTHON")) {
    const std::string name = chosen;
    return name.find('/') == std::string::npos ? name : fs::absolute(name).string();
  }
  const fs::path root = config::installation_root();
  const fs::path own = root / ".venv" / "bin" / "python";
  std::error_code error;
  return !root.empty() && fs::exists(own, error) ? own.string() : "python3";
}

std::vector<std::string> python_program(const std::string& part) {
  const fs::path home = config::installation_root();
  std::vector<std::string> words = {python_interpreter(), "-B"};
  // of sources or a system package, or the Python package that home, share/hapticgiant, is in
  for (const fs::path& package :
       {home / "python" / "hapticgiant", home.parent_path().parent_path()}) {
    std::error_code error;
    if (home.empty() || package.filename() != "hapticgiant") continue;  // not what sources are in
    if (!fs::exists(package / part / "__main__.py", error)) continue;
    words.push_back((package / part).string());
    return words;
  }
  words.insert(words.end(), {"-m", "hapticgiant." + part});
  return words;
}

std::vector<std::string> python_program_that_runs_us(const std::string& part) {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  setenv("HAPTICGIANT_PROGRAM", (own.parent_path() / "hapticgiant").c_str(), 1);
  setenv("HAPTICGIANT_PAGE", page::page_folder().c_str(), 1);
  return python_program(part);
}

void become_python_program(const std::string& part, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = python_program_that_runs_us(part);
  words.insert(words.end(), arguments.begin(), arguments.end());
  execute(words);
  throw SetupError(fmt::format("{}: {} cannot be started", part, words[0]));
}

void become_program(std::vector<std::string> words, std::string_view input) {
  const int file = memfd_create("input", MFD_CLOEXEC);
  while (file >= 0 && !input.empty()) {
    const ssize_t written = write(file, input.data(), input.size());
    if (written < 0 && errno != EINTR) break;
    input.remove_prefix(std::max<ssize_t>(written, 0));
  }
  if (input.empty() && lseek(file, 0, SEEK_SET) == 0 && dup2(file, STDIN_FILENO) >= 0 &&
      chdir("/") == 0) {  // no module of the working directory runs
    execute(words);
  }
  throw SetupError(fmt::format("{}: cannot be started: {}", words[0], std::strerror(errno)));
}

pid_t start_program(std::vector<std::string>& words, int end, int stream) {
  std::vector<char*> arguments = pointers_to(words);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (stream != STDIN_FILENO) {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, end, stream);
  posix_spawn_file_actions_addchdir_np(&actions, "/");
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(end);
  return error == 0 ? child : 0;
}

Ended run_program(std::vector<std::string> words) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {};
  const OpenFile output(ends[0]);
  const pid_t child = start_program(words, ends[1], STDOUT_FILENO);
  if (child == 0) return {};
  Ended ended = {.code = -1, .said = read_all(output.descriptor())};
  int status = 0;
  if (waitpid(child, &status, 0) == child && WIFEXITED(status)) ended.code = WEXITSTATUS(status);
  return ended;
}

}  // namespace hg::apps
