/// Tables that `hapticgiant export` writes, a block of rows at a time.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hg/messages/event.h"
#include "hg/recording/columns.h"

namespace hg::apps {

/// What shows that a file is of an older export, which may be replaced.
enum class ExportMark {
  kDictionary,  ///< JSON of an object with exported_by
  kBeside,      ///< a table that begins with time_s; the dictionary is beside it
  kInside,      ///< Parquet or HDF5 with the dictionary inside
};

/// Files of one export. Each is written under a name of its own, which no other file has, and gets
/// its final one when all of them are whole; otherwise none is left.
class ExportFiles {
 public:
  /// `dictionary`: the JSON file that is or would be beside tables of this name
  explicit ExportFiles(const std::string& dictionary);
  ~ExportFiles();
  ExportFiles(const ExportFiles&) = delete;
  ExportFiles& operator=(const ExportFiles&) = delete;

  /// Adds a file and returns the name to write it under: an empty file is there. A file without
  /// the mark is never replaced. Throws SetupError.
  std::string add(const std::string& file, ExportMark mark);
  /// Gives all files their names, and returns these. Throws SetupError.
  std::vector<std::string> keep();

 private:
  struct Added {
    std::string file, partial;
  };
  std::vector<Added> files_;
  bool has_dictionary_;  // of an older export
};

class ExportTable {
 public:
  virtual ~ExportTable() = default;
  /// Appends the rows of the kept columns. Throws SetupError.
  virtual void write(const recording::Columns& rows) = 0;
  /// Completes all files. Throws SetupError.
  virtual void finish() = 0;
};

/// A table as `out`.csv with `out`.events.csv and `out`.json. `facts` has "columns" with names and
/// widths in their order. Throws SetupError.
std::unique_ptr<ExportTable> make_csv(ExportFiles& files, const std::string& out,
                                      const nlohmann::ordered_json& facts,
                                      const std::vector<messages::Event>& events);

/// A table that Python writes: `format` parquet or hdf5. Throws SetupError, with what to install.
std::unique_ptr<ExportTable> make_python_table(ExportFiles& files, const std::string& format,
                                               const std::string& out,
                                               const nlohmann::ordered_json& facts,
                                               const std::vector<messages::Event>& events);

}  // namespace hg::apps
