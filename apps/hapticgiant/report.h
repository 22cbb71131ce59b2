/// Reports whose numbers are the program's and whose text and pictures are Python's
/// (python/hapticgiant/report).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
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

}  // namespace hg::apps
