/// Tables that `hapticgiant export` writes, a block of rows at a time.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "hg/messages/event.h"
#include "hg/recording/columns.h"

namespace hg::apps {

/// Files of one export. Each is written under a name of its own and gets its final one when all of
/// them are whole; otherwise none is left.
class ExportFiles {
 public:
  ExportFiles() = default;
  ~ExportFiles();
  ExportFiles(const ExportFiles&) = delete;
  ExportFiles& operator=(const ExportFiles&) = delete;

  /// Adds a file and returns the name to write it under. `beginning` is how files of its kind
  /// begin: one that begins otherwise is never replaced. Throws SetupError.
  std::string add(const std::string& file, std::string_view beginning);
  /// Gives all files their names, and returns these. Throws SetupError.
  std::vector<std::string> keep();

 private:
  std::vector<std::string> files_;
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
