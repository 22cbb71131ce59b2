/// Opens files by name so that no name can hold the program up: a named pipe that nobody writes, a
/// device, a folder are refused instead of waited for.
///
/// For set-up and for what is written beside the loop. Descriptors are closed on exec.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace hg {

/// Closes its descriptor at the end.
class OpenFile {
 public:
  explicit OpenFile(int descriptor) noexcept : descriptor_(descriptor) {}
  OpenFile(OpenFile&& other) noexcept : descriptor_(other.release()) {}
  OpenFile& operator=(OpenFile&&) = delete;
  ~OpenFile();

  int descriptor() const noexcept { return descriptor_; }
  /// Leaves closing it to somebody else.
  int release() noexcept;

 private:
  int descriptor_;
};

/// For reading. Throws SetupError "FILE: cannot be read: why"; only regular files can be.
OpenFile open_to_read(const std::filesystem::path& file);

/// The whole content. Throws SetupError; a file of more than `most_bytes` is refused.
std::string read_file(const std::filesystem::path& file,
                      std::uintmax_t most_bytes = std::numeric_limits<std::uintmax_t>::max());

/// Of a regular file that is opened to be written.
enum class Content { kEmptied, kKept };

/// For writing: a regular file, which is made where it is missing; a character device such as
/// /dev/null; what the standard output or error of this program is, which is written behind what is
/// printed. Nothing else. Throws SetupError "FILE: cannot be written: why".
OpenFile open_to_write(const std::filesystem::path& file, Content content);

/// What a file is, of its st_mode: "a named pipe".
const char* kind_of_file(unsigned mode) noexcept;

}  // namespace hg
