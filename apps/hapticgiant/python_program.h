/// The parts of the program that are written in Python.
#pragma once

#include <string>
#include <vector>

namespace hg::apps {

/// The environment variable HAPTICGIANT_PYTHON, else .venv/bin/python of the installation
/// (shipped_files.h), else python3.
std::string python_interpreter();

/// Words that start python/hapticgiant/`part`, or its module where the package is installed.
std::vector<std::string> python_program(const std::string& part);

}  // namespace hg::apps
