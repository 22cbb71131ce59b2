#include "hg/recording/recording_folder.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <regex>
#include <string_view>
#include <system_error>
#include <utility>

#include "hg/core/error.h"

namespace hg::recording {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartial = ".partial";
constexpr std::string_view kExtension = ".mcap";
constexpr std::string_view kFixed = "recording.mcap";
constexpr std::chrono::minutes kAbandoned(1);

/// A finished or broken recording.
struct Recording {
  /// Age: date and time, then the number that separates files of the same second
  std::string stamp;
  int number;
  fs::path path;
  double bytes;
};

// whether another run is writing it; a paused run still writes now and then, a broken file is no
// longer written
bool is_being_written(const fs::path& path) {
  if (path.stem().extension() != kPartial) return false;
  std::error_code error;
  const fs::file_time_type written = fs::last_write_time(path, error);
  return !error && fs::file_time_type::clock::now() - written < kAbandoned;
}

std::vector<Recording> oldest_first(const fs::path& folder) {
  static const std::regex kPattern(R"(.*_(\d{8}_\d{6})(?:_(\d{1,6}))?(?:\.partial)?\.mcap)");
  std::vector<Recording> recordings;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code no_file;
    std::smatch match;
    if (!std::regex_match(name, match, kPattern) || entry->is_symlink(no_file)) continue;
    const std::uintmax_t bytes = entry->file_size(no_file);
    if (no_file || is_being_written(entry->path())) continue;
    const int number = match[2].matched ? std::stoi(match[2]) : 1;
    recordings.push_back({match[1], number, entry->path(), static_cast<double>(bytes)});
  }
  std::sort(recordings.begin(), recordings.end(), [](const Recording& a, const Recording& b) {
    return std::tie(a.stamp, a.number, a.path) < std::tie(b.stamp, b.number, b.path);
  });
  return recordings;
}

// Returns errno; 0: renamed.
int rename_to_free_name(const fs::path& from, const fs::path& to) {
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return errno;
  // file system without that operation
  std::error_code error;
  if (fs::symlink_status(to, error).type() != fs::file_type::not_found) return EEXIST;
  fs::rename(from, to, error);
  return error.value();
}

}  // namespace

std::string stamped(const std::string& name, std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof(text), "_%Y%m%d_%H%M%S", &parts);
  return name + std::string(text, length);
}

RecordingFolder::RecordingFolder(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    throw SetupError("recording folder " + folder_.string() +
                     ": must be a folder that can be written, got: " + error.message());
  }
}

fs::path RecordingFolder::new_path(const std::string& name,
                                   std::chrono::system_clock::time_point start) const {
  static const std::regex kPattern("[A-Za-z0-9._-]+");
  if (!std::regex_match(name, kPattern)) {
    throw SetupError(
        "recording name: must consist of letters, digits, dots, dashes and underscores, got \"" +
        name + "\"");
  }

  const std::string stem = stamped(name, start);
  for (int number = 1;; ++number) {
    const std::string numbered = number == 1 ? stem : stem + "_" + std::to_string(number);
    const fs::path complete = folder_ / (numbered + std::string(kExtension));
    const fs::path partial = folder_ / (numbered + std::string(kPartial) + std::string(kExtension));
    std::error_code ignored;
    if (!fs::exists(complete, ignored) && !fs::exists(partial, ignored)) return partial;
  }
}

fs::path RecordingFolder::new_fixed_path() const {
  const fs::path partial =
      folder_ / ("recording" + std::string(kPartial) + std::string(kExtension));
  std::error_code ignored;
  fs::remove(partial, ignored);
  return partial;
}

fs::path RecordingFolder::complete(const fs::path& partial, std::string& why) const {
  std::string name = partial.filename().string();
  name.erase(name.rfind(kPartial), kPartial.size());
  const fs::path complete = folder_ / name;
  if (name == kFixed) {  // replaces that of an earlier run in one step
    std::error_code failed;
    fs::rename(partial, complete, failed);
    if (!failed) return complete;
    why = complete.string() + ": " + failed.message();
    return partial;
  }
  const int error = rename_to_free_name(partial, complete);
  if (error != 0) {
    why = complete.string() + ": " + std::strerror(error);
    return partial;
  }
  link_latest(complete);
  return complete;
}

std::string RecordingFolder::link_latest(const fs::path& file) const {
  const fs::path fresh = folder_ / "latest.new", latest = folder_ / "latest.mcap";
  for (const fs::path& name : {fresh, latest}) {
    std::error_code ignored;
    const fs::file_type type = fs::symlink_status(name, ignored).type();
    if (type == fs::file_type::symlink || type == fs::file_type::not_found) continue;
    return name.string() + " is no link of this program and stays as it is";
  }
  // renaming replaces an old link in one step: there is always a link
  std::error_code ignored;
  fs::remove(fresh, ignored);
  fs::create_symlink(file.filename(), fresh, ignored);
  fs::rename(fresh, latest, ignored);
  return {};
}

std::vector<std::string> RecordingFolder::make_room(const fs::path& current, double current_bytes,
                                                    double budget_bytes) const {
  std::vector<Recording> others = oldest_first(folder_);
  std::erase_if(others, [&](const Recording& r) { return r.path == current; });
  double total = current_bytes;
  for (const Recording& recording : others) total += recording.bytes;

  std::vector<std::string> deleted;
  for (const Recording& recording : others) {
    if (total <= budget_bytes) break;
    std::error_code ignored;
    if (!fs::remove(recording.path, ignored)) continue;
    total -= recording.bytes;
    deleted.push_back(recording.path.filename().string());
  }
  return deleted;
}

}  // namespace hg::recording
