/// Reports whose numbers are the program's and whose text and pictures are Python's
/// (python/hapticgiant/report).
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace hg::apps {

/// Throws SetupError, with what to install, unless write_report() can work.
void check_report_program();

/// Writes the report on `folder`/results.json into the folder, or that on the runs in `runs`, each
/// a folder with run.json and signals.npy. Prints what the report says, and refreshes the page of
/// this report in `docs`; empty = none. Returns the exit code that the report asks for: 0, 1 not as
/// expected, 3 a fault. Throws SetupError when there is no report.
int write_report(const std::filesystem::path& folder, const std::string& docs,
                 const std::vector<std::filesystem::path>& runs = {});

/// Writes `results` as results.json to `folder` and then the report on it, as write_report().
/// Without a report results.json remains.
int report_on(const std::filesystem::path& folder, const nlohmann::ordered_json& results,
              const std::string& docs = {});

/// The same, and returns the text of the report's file `name`.
std::string report_text(const std::filesystem::path& folder, const nlohmann::ordered_json& results,
                        const char* name, const std::string& docs = {});

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
