/// Source texts of a configuration, from disk or from a recording; places in them, and their
/// faults.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/input_fault.h"

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

/// Position in a file, counted from 1.
struct Place {
  int line = 1;
  int column = 1;
};

/// Place of each key of a file, by its path: "joints.m1.q_max_rad", "virtual_joints[0]". A value
/// that is a word or a number counts with its own place, a map or list with that of its key.
class Places {
 public:
  /// The first place of an item counts.
  void add(const std::string& item, Place place);
  /// Place of `item` or, where it is not given, of the innermost map or list that would hold it.
  Place nearest(std::string item) const;

 private:
  std::map<std::string, Place> places_;
};

class Faults {
 public:
  /// Creates a collector of the faults of `file`.
  explicit Faults(std::string file) : file_(std::move(file)) {}

  /// Adds a fault of this file.
  void add(Place place, std::string_view item, std::string_view what);
  /// The same with all that is known of it; file, line and column are set here.
  void add(Place place, InputFault fault);
  /// Adds the faults of another file or reader, after all of this file.
  void add_all(const SetupError& error);

  std::size_t count() const noexcept { return faults_.size(); }
  /// Throws InputError with the faults in the order of the file.
  void throw_if_any() const;

 private:
  struct Placed {
    Place order;
    InputFault fault;
  };
  std::string file_;
  std::vector<Placed> faults_;
};

}  // namespace hg::config
