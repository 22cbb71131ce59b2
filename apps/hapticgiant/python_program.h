/// The parts of the program that are written in Python.
#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

namespace hg::apps {

/// The environment variable HAPTICGIANT_PYTHON, else .venv/bin/python of the installation
/// (shipped_files.h), else python3.
std::string python_interpreter();

/// How a program has ended.
struct Ended {
  static constexpr int kNotStarted = 127;
  int code = kNotStarted;  ///< exit code; -1: a signal
  std::string said;        ///< its standard output
};

/// Runs a program to its end, in the root folder: Python would take modules from the working
/// directory. It has no input, and the error output of this process.
Ended run_program(std::vector<std::string> words);

/// Replaces this process, in the root folder, by a program whose standard input is `input`. Does
/// not return; throws SetupError where it cannot be started.
[[noreturn]] void become_program(std::vector<std::string> words, std::string_view input);

/// Starts a program with one end of a pipe as its standard input or output (`stream`), which is
/// closed here; returns its process, 0 where it does not start. Without input it reads nothing.
pid_t start_program(std::vector<std::string>& words, int end, int stream);

/// Words that start hapticgiant/`part` of the installation (shipped_files.h) as a program, without
/// the package's own imports; without one the module of that name.
std::vector<std::string> python_program(const std::string& part);

/// The same; sets HAPTICGIANT_PROGRAM, which names hapticgiant to parts that run it, and
/// HAPTICGIANT_PAGE, the folder of the page.
std::vector<std::string> python_program_that_runs_us(const std::string& part);

/// Replaces this process by that program with these arguments; HAPTICGIANT_PROGRAM names
/// hapticgiant. Does not return; throws SetupError where the interpreter cannot be started.
[[noreturn]] void become_python_program(const std::string& part,
                                        const std::vector<std::string>& arguments);

}  // namespace hg::apps
