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

/// Becomes python/hapticgiant/`part`, which finds this program in HAPTICGIANT_PROGRAM. Throws
/// SetupError where the interpreter cannot be started, and does not return otherwise.
void become_python_program(const std::string& part, const std::vector<std::string>& arguments);

}  // namespace hg::apps
