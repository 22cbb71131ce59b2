#include "hg/live/link_file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg::live {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = ".live";
constexpr std::uintmax_t kMostBytes = 4096;

/// Why the folder cannot be trusted; empty: it belongs to this user alone, or `is_missing`.
std::string look_at(const fs::path& folder, bool& is_missing) {
  struct stat status = {};
  is_missing = ::lstat(folder.c_str(), &status) != 0;
  if (is_missing) return errno == ENOENT ? "" : folder.string() + ": " + std::strerror(errno);
  if (!S_ISDIR(status.st_mode) || status.st_uid != ::getuid() || (status.st_mode & 077u) != 0) {
    return folder.string() + ": must be a folder of this user alone (mode 0700)";
  }
  return {};
}

/// Process that wrote the file; 0: the name is none of ours.
pid_t writer_of(const fs::path& file) {
  const std::string name = file.filename().string();
  pid_t process = 0;
  const char* end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data(), end, process);
  return error == std::errc() && std::string_view(rest, end) == kEnding && process > 0 ? process
                                                                                       : 0;
}

bool is_alive(pid_t process) { return ::kill(process, 0) == 0 || errno == EPERM; }

}  // namespace

std::string live_address(const std::string& page_link) {
  const std::size_t host = page_link.find("://");
  const std::size_t token = page_link.find("#token=");
  if (host == std::string::npos || token == std::string::npos) return {};
  return "ws" + page_link.substr(host, token - host) + "live?token=" + page_link.substr(token + 7);
}

fs::path link_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && *runtime == '/') return fs::path(runtime) / "hapticgiant";
  return "/tmp/hapticgiant-" + std::to_string(::getuid());
}

LinkFile::LinkFile(const std::string& address, const fs::path& folder) {
  bool is_missing = false;
  problem_ = look_at(folder, is_missing);
  if (problem_.empty() && is_missing && ::mkdir(folder.c_str(), 0700) != 0) {
    problem_ = folder.string() + ": " + std::strerror(errno);
  }
  if (!problem_.empty()) return;
  const fs::path file = folder / (std::to_string(::getpid()) + std::string(kEnding));
  const fs::path unfinished = file.string() + ".part";
  ::unlink(unfinished.c_str());
  {
    const OpenFile opened(
        ::open(unfinished.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
    const std::string text = address + "\n";
    const auto size = static_cast<ssize_t>(text.size());
    if (opened.descriptor() < 0 || ::write(opened.descriptor(), text.data(), text.size()) != size) {
      problem_ = unfinished.string() + ": " + std::strerror(errno);
      return;
    }
  }
  if (::rename(unfinished.c_str(), file.c_str()) != 0) {
    problem_ = file.string() + ": " + std::strerror(errno);
    return;
  }
  file_ = file;
}

LinkFile::~LinkFile() {
  if (!file_.empty()) ::unlink(file_.c_str());
}

std::vector<std::string> running_addresses(const fs::path& folder) {
  bool is_missing = false;
  if (const std::string problem = look_at(folder, is_missing); !problem.empty()) {
    throw SetupError(problem);
  }
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  std::error_code error;
  for (const fs::path& file : fs::directory_iterator(folder, error)) {
    const pid_t process = writer_of(file);
    if (process == 0) continue;
    if (!is_alive(process)) {
      fs::remove(file, error);
      continue;
    }
    try {
      std::string address = read_file(file, kMostBytes);
      while (address.ends_with('\n')) address.pop_back();
      found.emplace_back(fs::last_write_time(file, error), std::move(address));
    } catch (const SetupError&) {
      continue;  // the run has just ended
    }
  }
  std::ranges::sort(found, std::greater<>());
  std::vector<std::string> addresses;
  for (auto& [time, address] : found) addresses.push_back(std::move(address));
  return addresses;
}

}  // namespace hg::live
