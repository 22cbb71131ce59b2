/// Files that the program writes on request: whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace hg::apps {

/// Beginning of a file of each kind; an existing file with another beginning is never replaced.
inline constexpr std::string_view kJson = "{", kSvg = "<svg", kMarkdown = "# ",
                                  kCapture = "\x4d\x3c\xb2\xa1";

/// Refuses a path that cannot be written, before the work for the file begins; also an existing
/// file that does not begin with `beginning`, such as the scenario itself. Throws SetupError;
/// `file` may be empty, which means "no file".
void check_writable(const std::string& file, std::string_view beginning = {});

/// Replaces a regular file in one step; others are written to, and what goes to standard output
/// (/dev/stdout) is printed. Throws SetupError. Waits while the output is not read; after an
/// interruption for half a second.
void write_output(const std::string& file, const std::string& text);

/// Writes measurements as JSON, with the version of the program, as write_output(); an empty `file`
/// means none.
void write_json(const std::string& file, nlohmann::ordered_json json);

/// Creates a folder with its parent folders. Throws SetupError.
void make_folder(const std::string& folder);

}  // namespace hg::apps
