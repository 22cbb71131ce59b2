/// Collects everything that is wrong with one configuration file, to be told at once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hg::config {

/// Position in a file, counted from 1.
struct Place {
  int line = 1;
  int column = 1;
};

class Faults {
 public:
  /// `file` stands before every message.
  explicit Faults(std::string file) : file_(std::move(file)) {}

  /// "file:line:column: item: what".
  void add(Place place, std::string_view item, std::string_view what);
  /// A message of another file or reader, which says itself where it belongs.
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
