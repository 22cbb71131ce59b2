/// Files that the program writes on request: whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hg/core/whole_file.h"

namespace hg::apps {

/// Writes a file as write_whole_file(); what goes to standard output (/dev/stdout) is printed.
/// Throws SetupError. Waits while the output is not read; after an interruption for half a second.
void write_output(const std::string& file, const std::string& text);

/// Writes measurements as JSON, with the version of the program, as write_output(); an empty `file`
/// means none.
void write_json(const std::string& file, nlohmann::ordered_json json);

}  // namespace hg::apps
