/// The folder of the recordings: names of files, the link `latest.mcap`, and the disk budget.
///
/// A recording is called NAME_yyyymmdd_hhmmss.mcap (UTC), with _2, _3, ... where that exists; while
/// it is written, or after a crash, it ends in .partial.mcap. Only files named like that count and
/// are ever deleted: rename a recording to keep it.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace hg::recording {

/// File stem NAME_yyyymmdd_hhmmss, the time in UTC.
std::string stamped(const std::string& name, std::chrono::system_clock::time_point time);

class RecordingFolder {
 public:
  /// Creates the folder if it is missing. Throws SetupError when that fails.
  explicit RecordingFolder(std::filesystem::path folder);

  /// Returns a free path ending in .partial.mcap. Throws SetupError unless `name` consists of
  /// letters, digits, dots, dashes and underscores.
  std::filesystem::path new_path(const std::string& name,
                                 std::chrono::system_clock::time_point start) const;

  /// The path of recording.partial.mcap; what an earlier run has left there is deleted.
  std::filesystem::path new_fixed_path() const;

  /// Removes .partial from the name and points `latest.mcap` at the file; recording.mcap replaces
  /// an earlier one instead, without a link. Returns the new path, or the old one where the name is
  /// taken or renaming fails; then `why` gives the reason.
  std::filesystem::path complete(const std::filesystem::path& partial, std::string& why) const;

  /// Points `latest.mcap` at a file of this folder; no effect where links are not supported.
  /// Returns an error when `latest.mcap` exists and is no link: that is a foreign file; else empty.
  std::string link_latest(const std::filesystem::path& file) const;

  /// Deletes the oldest recordings until all together, `current` with `current_bytes`, take at most
  /// `budget_bytes`; never `current`. Returns the names of the deleted files.
  std::vector<std::string> make_room(const std::filesystem::path& current, double current_bytes,
                                     double budget_bytes) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace hg::recording
