/// Opens files by name without ever blocking: named pipes, devices and folders are refused instead
/// of waited for.
///
/// For set-up and for output outside the control loop. Descriptors are closed on exec.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace hg {

/// Owner of a file descriptor; closes it on destruction.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) noexcept : descriptor_(descriptor) {}
  OpenFile(OpenFile&& other) noexcept : descriptor_(other.release()) {}
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile();

  int descriptor() const noexcept { return descriptor_; }
  /// Gives up ownership: returns the descriptor, which the caller must close.
  int release() noexcept;

 private:
  int descriptor_;
};

/// Opens a regular file for reading. Throws SetupError "FILE: cannot be read: why"; anything but a
/// regular file is refused.
OpenFile open_to_read(const std::filesystem::path& file);

/// Reads the whole content. Throws SetupError; a file of more than `most_bytes` is refused.
std::string read_file(const std::filesystem::path& file,
                      std::uintmax_t most_bytes = std::numeric_limits<std::uintmax_t>::max());

/// What happens to the content of a regular file opened for writing.
enum class Content { kEmptied, kKept };

/// Opens for writing: a regular file, created if missing; a character device such as /dev/null; or
/// the target of this program's standard output or error, appended to its output. All else is
/// refused. Throws SetupError "FILE: cannot be written: why".
OpenFile open_to_write(const std::filesystem::path& file, Content content);

/// Name of a file's kind by its st_mode, for example "a named pipe".
const char* kind_of_file(unsigned mode) noexcept;

}  // namespace hg
