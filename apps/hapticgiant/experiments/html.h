/// HTML elements of reports: self-contained pages that print well.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace hg::apps {

/// Text with <, > and & escaped.
std::string escaped(std::string_view text);

/// HTML table; the first row is the head, cells are text.
std::string html_table(const std::vector<std::vector<std::string>>& rows);

/// An SVG file inside the page; empty when there is no such file.
std::string html_figure(const std::filesystem::path& svg, const std::string& caption);

/// Complete HTML page, dark on white, A4.
std::string html_page(const std::string& title, const std::string& body);

/// Markdown table for documentation; the first row is the head.
std::string markdown_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace hg::apps
