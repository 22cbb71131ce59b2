#include "hg/core/whole_file.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <system_error>

#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kAtOnce = 512;  // a pipe that takes any takes as many
constexpr int kLook_ms = 50;
constexpr std::chrono::milliseconds kPatience(500);  // after an interruption

// only what is, or becomes, a regular file is replaced
bool is_replaced(const std::string& file) {
  std::error_code error;
  const auto type = fs::symlink_status(file, error).type();
  return type == fs::file_type::regular || type == fs::file_type::not_found;
}

// The name under which a file is written until it is whole. A link of that name, in a foreign
// folder, is removed: what it leads to is not written. A named pipe or folder is refused later.
std::string partial_of(const std::string& file) {
  std::string partial = file + ".partial";
  std::error_code error;
  if (fs::is_symlink(fs::symlink_status(partial, error))) fs::remove(partial, error);
  return partial;
}

// 0, or the error that has ended the writing.
int write_all(const OpenFile& file, std::string_view text, bool (*is_interrupted)() noexcept) {
  auto patient_until = Clock::time_point::max();
  while (!text.empty()) {
    pollfd place = {.fd = file.descriptor(), .events = POLLOUT, .revents = 0};
    if (poll(&place, 1, kLook_ms) == 0) {
      if (is_interrupted != nullptr && is_interrupted())
        patient_until = std::min(patient_until, Clock::now() + kPatience);
      if (Clock::now() >= patient_until) return EINTR;
      continue;
    }
    const ssize_t written = write(file.descriptor(), text.data(), std::min(text.size(), kAtOnce));
    if (written < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (written < 0) return errno;
    text.remove_prefix(written);
  }
  return 0;
}

// existing content of another kind is kept
void check_replaced(const std::string& file, std::string_view beginning) {
  std::error_code error;
  if (beginning.empty() || !fs::is_regular_file(file, error)) return;
  const OpenFile present = open_to_read(file);
  std::string found(beginning.size(), '\0');
  const ssize_t size = read(present.descriptor(), found.data(), found.size());
  if (size == 0 || found == beginning) return;
  throw SetupError(file +
                   ": exists already and is no file of the kind that would be written there; it is "
                   "not replaced");
}

}  // namespace

void check_writable(const std::string& file, std::string_view beginning) {
  if (file.empty()) return;
  check_replaced(file, beginning);
  std::error_code error;
  if (!is_replaced(file)) {
    if (!fs::exists(file, error)) throw SetupError(file + ": cannot be written there");
    open_to_write(file, Content::kKept);
    return;
  }
  const std::string partial = partial_of(file);
  const bool existed = fs::exists(partial, error);
  open_to_write(partial, Content::kKept);
  if (!existed) fs::remove(partial, error);
}

void write_whole_file(const std::string& file, std::string_view text,
                      bool (*is_interrupted)() noexcept) {
  const bool replaces = is_replaced(file);
  const std::string written = replaces ? partial_of(file) : file;
  std::error_code error(write_all(open_to_write(written, Content::kEmptied), text, is_interrupted),
                        std::generic_category());
  if (!error && replaces) fs::rename(written, file, error);
  if (!error) return;
  std::error_code ignored;
  if (replaces) fs::remove(written, ignored);
  throw SetupError(file + ": could not be written: " + error.message());
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder, error)) return;
  throw SetupError(folder + ": expected a folder, or a place where one can be made" +
                   (error ? ": " + error.message() : ""));
}

}  // namespace hg
