/// Source texts of a configuration: read from disk, or from a recording.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hg::config {

struct SourceText {
  std::string name;  ///< path as it was opened
  std::string content;
};

/// Reads files and keeps their texts.
class SourceReader {
 public:
  /// Reads from disk.
  SourceReader() = default;
  /// Never touches the disk: only the files in `recorded` exist.
  explicit SourceReader(std::vector<SourceText> recorded);

  bool exists(const std::filesystem::path& file) const;
  /// Names of the files beside `file` with the same extension; empty when there are none.
  std::vector<std::string> siblings(const std::filesystem::path& file) const;
  /// Throws SetupError when the file cannot be read or is larger than 4 MB.
  std::string read(const std::filesystem::path& file);

  /// Everything read so far, in order.
  const std::vector<SourceText>& texts() const noexcept { return texts_; }
  /// Texts read since texts() had `count` entries.
  std::vector<SourceText> since(std::size_t count) const;

 private:
  bool is_recorded_ = false;
  std::vector<SourceText> recorded_;
  std::vector<SourceText> texts_;
};

}  // namespace hg::config
