/// A recording as a folder that rosbag2 and its readers open: metadata.yaml beside the MCAP file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "hg/recording/recording_reader.h"

namespace hg::recording {

/// What becomes of a recording; times are run times, s.
struct Rosbag2Plan {
  std::filesystem::path folder;  ///< must not exist; made with its content, or not at all
  double from_s = -std::numeric_limits<double>::infinity();  ///< first moment
  double to_s = std::numeric_limits<double>::infinity();     ///< moment after the last one
  bool (*is_interrupted)() noexcept = nullptr;  ///< asked all the time; true: nothing is written
};

struct Rosbag2Result {
  std::uint64_t messages = 0;
  std::size_t topics = 0;
  bool is_link = false;  ///< the file of the folder is the recording itself, linked
  bool is_complete = false;
  std::vector<Loss> losses;  ///< everything else is in the folder
};

/// Writes the folder. A whole recording is linked, or copied where that is not possible; of a part,
/// and of one that is damaged or cut off, the intact messages are written into a complete file.
/// Throws SetupError: as read_recording(), the folder exists, cannot be written or described in
/// YAML, or would be empty; or it was interrupted.
Rosbag2Result write_rosbag2(const std::filesystem::path& recording, const Rosbag2Plan& plan);

}  // namespace hg::recording
