#include "apps/hapticgiant/experiments/html.h"

#include <fmt/format.h>

#include <system_error>

#include "hg/core/open_file.h"

namespace hg::apps {
namespace {

constexpr std::string_view kStyle = R"(
@page { size: A4; margin: 16mm 15mm; }
html { background: #fff; color: #111; font: 10pt/1.4 "Helvetica Neue", Arial, sans-serif; }
body { max-width: 180mm; margin: 10mm auto; padding: 0 4mm; }
h1 { font-size: 16pt; margin: 0 0 1mm; } h2 { font-size: 11.5pt; margin: 6mm 0 1.5mm; }
p { margin: 1.5mm 0; } .source { color: #555; margin: 0 0 3mm; }
.good, .bad { padding: 1.5mm 3mm; border-left: 1.2mm solid #2a7d3f; background: #f1f7f2; }
.bad { border-color: #b3261e; background: #fbf1f0; }
table { border-collapse: collapse; width: 100%; font-size: 8.7pt; }
th, td { text-align: left; vertical-align: top; padding: 1mm 2mm 1mm 0; }
th { border-top: 0.5mm solid #111; border-bottom: 0.25mm solid #111; font-weight: 600; }
tr:last-child td { border-bottom: 0.5mm solid #111; }
figure { margin: 4mm 0; break-inside: avoid; } figure img { width: 100%; }
figcaption { font-size: 8.7pt; color: #333; } code { font-size: 8.7pt; }
@media print { body { margin: 0; max-width: none; padding: 0; } }
)";

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) {
      return i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U;
    };
    const unsigned group = (byte(0) << 16U) | (byte(1) << 8U) | byte(2);
    for (unsigned k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[(group >> (18U - 6U * k)) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<table>\n";
  const char* cell = "th";
  for (const auto& row : rows) {
    html += "<tr>";
    for (const std::string& text : row) html += fmt::format("<{0}>{1}</{0}>", cell, escaped(text));
    html += "</tr>\n";
    cell = "td";
  }
  return html + "</table>\n";
}

std::string html_figure(const std::filesystem::path& svg, const std::string& caption) {
  std::error_code error;
  if (!std::filesystem::exists(svg, error)) return {};
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\">"
      "<figcaption>{0}</figcaption></figure>\n",
      escaped(caption), base64(read_file(svg)));
}

std::string html_page(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escaped(title), kStyle, body);
}

std::string markdown_table(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (const auto& row : rows) {
    text += "|";
    for (const std::string& cell : row) text += " " + cell + " |";
    text += "\n";
    if (&row != &rows.front()) continue;
    text += "|";
    for (std::size_t i = 0; i < row.size(); ++i) text += " --- |";
    text += "\n";
  }
  return text;
}

}  // namespace hg::apps
