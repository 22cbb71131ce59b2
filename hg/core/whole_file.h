/// Files written whole or not at all.
///
/// For set-up and for output outside the control loop.
#pragma once

#include <string>
#include <string_view>

namespace hg {

/// Beginning of a file of each kind; an existing file with another beginning is never replaced.
inline constexpr std::string_view kJson = "{", kSvg = "<svg", kMarkdown = "# ",
                                  kCapture = "\x4d\x3c\xb2\xa1";

/// Refuses a path that cannot be written, before the work for the file begins; also an existing
/// file that does not begin with `beginning`, such as the scenario itself. Throws SetupError;
/// `file` may be empty, which means "no file".
void check_writable(const std::string& file, std::string_view beginning = {});

/// Replaces a regular file in one step; others are written to. Throws SetupError. Waits while the
/// output is not read; half a second from the moment on that `is_interrupted` returns true.
void write_whole_file(const std::string& file, std::string_view text,
                      bool (*is_interrupted)() noexcept = nullptr);

/// Creates a folder with its parent folders. Throws SetupError.
void make_folder(const std::string& folder);

}  // namespace hg
