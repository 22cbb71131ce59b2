/// Draws figures and writes reports with the installed Python.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hg::apps {

/// Draws figure.svg and figure.png into `out` (python/hapticgiant/figures.py) from folders that
/// hold run.json and signals.csv; several are overlaid. Returns one line on why there are none and
/// how to get them; empty = drawn.
///
/// The interpreter is that of the environment variable HAPTICGIANT_PYTHON, else .venv/bin/python
/// of the installation (shipped_files.h), else python3.
std::string draw_figures(const std::filesystem::path& out,
                         const std::vector<std::filesystem::path>& folders);

/// Throws SetupError, with what to install, unless write_report() can work.
void check_report_program();

/// Writes report and tables beside results.json in `folder` (python/hapticgiant/report), and
/// refreshes the figures in the page of this report in `docs`; empty = none. Throws SetupError.
void write_report(const std::filesystem::path& folder, const std::string& docs);

}  // namespace hg::apps
