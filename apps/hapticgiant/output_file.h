/// Files that the program writes on request: whole or not at all.
#pragma once

#include <string>

namespace hg::apps {

/// Refuses a place that cannot be written, before the work that leads to the file begins. Throws
/// SetupError; `file` may be empty, which means "no file".
void check_writable(const std::string& file);

/// Replaces a regular file in one step; others (/dev/stdout) are written to. Throws SetupError.
void write_output(const std::string& file, const std::string& text);

/// With the folders that it lies in. Throws SetupError.
void make_folder(const std::string& folder);

}  // namespace hg::apps
