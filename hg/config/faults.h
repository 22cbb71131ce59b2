/// Collects all faults of one configuration file, to report them together.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace hg::config {

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
  /// Creates a collector; `file` is put before every message.
  explicit Faults(std::string file) : file_(std::move(file)) {}

  /// Adds the fault "file:line:column: item: what".
  void add(Place place, std::string_view item, std::string_view what);
  /// Adds a message of another file or reader that already contains its place.
  void add_complete(std::string_view message);

  std::size_t count() const noexcept { return faults_.size(); }
  /// Throws SetupError with one fault per line, in the order of the file.
  void throw_if_any() const;

 private:
  struct Fault {
    Place place;
    std::string message;
  };
  std::string file_;
  std::vector<Fault> faults_;
};

}  // namespace hg::config
