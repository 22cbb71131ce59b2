/// Draws figures and writes reports with the installed Python.
///
/// The interpreter is that of the environment variable HAPTICGIANT_PYTHON, else .venv/bin/python of
/// the installation (shipped_files.h), else python3.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hg::apps {

/// Draws figure.svg and figure.png into `out` (python/hapticgiant/figures.py) from folders that
/// hold run.json and signals.csv; several are overlaid. Returns one line on why there are none and
/// how to get them; empty = drawn.
std::string draw_figures(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& folders);

/// Throws SetupError, with what to install, unless write_report() can work.
void check_report_program();

/// Writes the report on `folder`/results.json into the folder, or that on the runs in `runs`, each
/// a folder with run.json and signals.npy (python/hapticgiant/report). Prints what the report says,
/// and refreshes the page of this report in `docs`; empty = none. Returns the exit code that the
/// report asks for: 0, 1 not as expected, 3 a fault. Throws SetupError when there is no report.
int write_report(const std::filesystem::path& folder, const std::string& docs,
                 const std::vector<std::filesystem::path>& runs = {});

}  // namespace hg::apps
