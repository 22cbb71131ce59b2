#include "link.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace hapticgiant {
namespace {

namespace fs = std::filesystem;

fs::path link_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime == '/') return fs::path(runtime) / "hapticgiant";
  return "/tmp/hapticgiant-" + std::to_string(getuid());
}

bool is_trusted(const fs::path& folder) {
  struct stat status = {};
  if (lstat(folder.c_str(), &status) != 0) return true;  // empty
  return S_ISDIR(status.st_mode) && status.st_uid == getuid() && (status.st_mode & 077U) == 0;
}

// Whether the file is named after a process that is still there.
bool is_of_a_run(const fs::path& file) {
  const int process = std::atoi(file.stem().c_str());
  return file.extension() == ".live" && process > 0 && (kill(process, 0) == 0 || errno == EPERM);
}

}  // namespace

Link parse_link(const std::string& text) {
  static const std::regex form(
      R"((?:ws|http)://(\[[0-9a-fA-F:]+\]|[^/:]+):(\d+)/(?:live\?|#)token=([0-9a-f]+)\s*)");
  std::smatch parts;
  if (!std::regex_match(text, parts, form)) {
    throw std::runtime_error(
        "expected the link that the program prints, http://HOST:PORT/#token=TOKEN, got '" + text +
        "'");
  }
  return {parts[1], parts[2], parts[3]};
}

Link newest_link() {
  const fs::path folder = link_folder();
  if (!is_trusted(folder)) {
    throw std::runtime_error(folder.string() + ": must be a folder of this user alone (mode 0700)");
  }
  fs::path newest;
  std::error_code error;
  for (const fs::path& file : fs::directory_iterator(folder, error)) {
    if (!is_of_a_run(file)) continue;
    if (newest.empty() || fs::last_write_time(file, error) > fs::last_write_time(newest, error)) {
      newest = file;
    }
  }
  if (newest.empty()) throw std::runtime_error("no program is running (" + folder.string() + ")");
  std::ifstream file(newest);
  std::string text;
  std::getline(file, text);
  return parse_link(text);
}

}  // namespace hapticgiant
