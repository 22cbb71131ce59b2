/// Pages of docs/experiments/, whose figures come from a run.
#pragma once

#include <filesystem>
#include <string>

namespace hg::apps {

/// Replaces what stands between the lines "<!-- figures: begin -->" and "<!-- figures: end -->" of
/// `docs`/NAME.md by `text`, and copies `svg`, where there is one, to `docs`/NAME.svg. Throws
/// SetupError when page or lines are missing.
void refresh_page(const std::filesystem::path& docs, const std::string& name,
                  const std::string& text, const std::filesystem::path& svg);

}  // namespace hg::apps
