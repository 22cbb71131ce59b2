/// The few pieces of HTML that reports are made of: self-contained pages that print well.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hg::apps {

/// <, > and & as text.
std::string escaped(std::string_view text);

/// The first row is the head. Cells are text.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// An SVG file inside the page; empty when there is no such file.
std::string html_figure(const std::filesystem::path& svg, const std::string& caption);

/// A whole page, dark on white, A4.
std::string html_page(const std::string& title, const std::string& body);

/// Likewise for documentation.
std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace hg::apps
