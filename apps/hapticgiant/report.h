/// Reports: the program measures, then becomes the Python program that computes, draws, prints and
/// writes (python/hapticgiant/report). Nothing comes back.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hg::apps {

/// What a report is made of, and where it goes.
struct Report {
  nlohmann::ordered_json results;            ///< their "kind" names the writer of the report
  std::string folder;                        ///< of all files of the report; empty = none is kept
  std::string docs;                          ///< documentation to refresh; empty = none
  std::map<std::string, std::string> files;  ///< files of the report, and where each is written
  std::string last_line;                     ///< printed at the end
  std::string kept;   ///< what has the data, in a line; printed where there can be no report
  int exit_code = 0;  ///< of the measurements
};

/// Throws SetupError, with what to install, unless become_reports() can work.
void check_report_program();

/// Becomes the program that makes these reports and ends with the worst of their exit codes: 0, 1
/// not as expected, 2 not usable, 3 a fault, kNotWritten. Where it cannot be started: prints why
/// and what has the data, and returns kNotWritten, or throws SetupError if nothing has.
int become_reports(const std::vector<Report>& reports);

/// Folder of a package that the interpreter has; empty = it has none.
std::string python_package_folder(const std::string& package);

/// Throws SetupError, with what to install, where ExportProgram cannot write files of `format`.
void check_export_program(const std::string& format);

/// The program that writes tables of a recording (python/hapticgiant/report/export.py), fed through
/// its standard input.
class ExportProgram {
 public:
  /// Starts it.
  explicit ExportProgram(const std::string& format);
  /// Ends it, if finish() did not.
  ~ExportProgram();
  ExportProgram(const ExportProgram&) = delete;
  ExportProgram& operator=(const ExportProgram&) = delete;

  /// Throws SetupError when it has ended.
  void write(std::string_view bytes);
  /// Waits for its end. Throws SetupError when it fails.
  void finish();

 private:
  std::vector<std::string> words_;
  int input_ = -1;
  pid_t child_ = 0;
};

}  // namespace hg::apps
