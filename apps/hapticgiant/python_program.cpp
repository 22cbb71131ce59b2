#include "apps/hapticgiant/python_program.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "hg/config/shipped_files.h"
#include "hg/core/error.h"

namespace hg::apps {

namespace fs = std::filesystem;

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
  const fs::path script = home / "python" / "hapticgiant" / part;
  std::error_code error;
  std::vector<std::string> words = {python_interpreter(), "-B"};
  if (!home.empty() && fs::exists(script, error)) {
    words.push_back(script.string());
  } else {
    words.insert(words.end(), {"-m", "hapticgiant." + part});
  }
  return words;
}

void become_python_program(const std::string& part, const std::vector<std::string>& arguments) {
  std::error_code error;
  const std::string program = fs::read_symlink("/proc/self/exe", error).string();
  setenv("HAPTICGIANT_PROGRAM", program.c_str(), 1);
  std::vector<std::string> words = python_program(part);
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data());
  throw SetupError(part + ": " + words[0] + " cannot be started");
}

}  // namespace hg::apps
