/// Files that the program writes on request: whole or not at all.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace hg::apps {

/// What a file of a kind begins with: nothing else that is there already is replaced by one.
inline constexpr std::string_view kJson = "{", kSvg = "<svg", kMarkdown = "# ",
                                  kCapture = "\x4d\x3c\xb2\xa1";

/// Refuses a place that cannot be written, before the work that leads to the file begins: also one
/// where a file is that does not begin with `beginning`, as the scenario itself would not. Throws
/// SetupError; `file` may be empty, which means "no file".
void check_writable(const std::string& file, std::string_view beginning = {});

/// Replaces a regular file in one step; others are written to, and what goes to standard
/// output (/dev/stdout) is printed. Throws SetupError.
/// Where nobody reads it waits, after an interruption for half a second.
void write_output(const std::string& file, const std::string& text);

/// JSON of measurements, with the version of the program; an empty `file` means none. As above.
void write_json(const std::string& file, nlohmann::ordered_json json);

/// With the folders that it lies in. Throws SetupError.
void make_folder(const std::string& folder);

}  // namespace hg::apps
