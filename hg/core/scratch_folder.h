/// Temporary folder for files that are not kept.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "hg/core/error.h"

namespace hg {

/// A folder among the temporary files, removed with all that is in it.
class ScratchFolder {
 public:
  /// Creates the folder. Throws SetupError.
  ScratchFolder() {
    path_ = (std::filesystem::temp_directory_path() / "hapticgiant_XXXXXX").string();
    if (mkdtemp(path_.data()) == nullptr) {
      throw SetupError(path_ + ": cannot be created: " + std::strerror(errno));
    }
  }
  ~ScratchFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace hg
