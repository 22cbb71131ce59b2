/// The parts of the program that are written in Python.
///
/// The interpreter is that of the environment variable HAPTICGIANT_PYTHON, else .venv/bin/python of
/// the installation (shipped_files.h), else python3.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

/// Words that start python/hapticgiant/`part`, or its module where the package is installed.
std::vector<std::string> python_program(const std::string& part);

}  // namespace hg::apps
