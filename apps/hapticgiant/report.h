/// Reports whose numbers are the program's and whose text is Python's (python/hapticgiant/report).
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace hg::apps {

/// Writes `results` as results.json to `folder`, runs the report program on it, and returns the
/// text of its file `name`. Throws SetupError; results.json remains.
std::string report_text(const std::filesystem::path& folder, const nlohmann::ordered_json& results,
                        const char* name);

}  // namespace hg::apps
