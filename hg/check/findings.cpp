#include "hg/check/findings.h"

#include <charconv>
#include <utility>

#include "hg/core/error.h"
#include "hg/model/urdf.h"

namespace hg::check {
namespace {

// Takes "12:" from the front of `text`; 0 if it does not begin so.
int take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end == text.data() + text.size() || *end != ':') return 0;
  text.remove_prefix(end - text.data() + 1);
  return value;
}

// "file:line:column: item: what"; column and item may be missing.
Finding finding_of_line(std::string_view line, const std::string& file) {
  Finding finding = {.file = file, .place = {}, .item = {}, .what = {}, .fix = {}};
  if (line.starts_with(file + ": ")) line.remove_prefix(file.size() + 2);
  for (std::size_t colon = line.find(':'); colon != std::string_view::npos;
       colon = line.find(':', colon + 1)) {
    std::string_view rest = line.substr(colon + 1);
    const int number = take_number(rest);
    if (number == 0) continue;
    finding.file = line.substr(0, colon);
    const int column = take_number(rest);
    finding.place = {number, column == 0 ? 1 : column};
    line = rest;
    break;
  }
  if (line.starts_with(' ')) line.remove_prefix(1);
  const std::size_t colon = line.find(": ");
  if (colon != std::string_view::npos &&
      line.substr(0, colon).find(' ') == std::string_view::npos) {
    finding.item = line.substr(0, colon);
    line.remove_prefix(colon + 2);
  }
  finding.what = line;
  return finding;
}

}  // namespace

std::string_view to_string(Severity severity) noexcept {
  switch (severity) {
    case Severity::kNote:
      return "note";
    case Severity::kWarning:
      return "warning";
    case Severity::kFault:
      return "fault";
  }
  return "";
}

Collector::Collector(const std::vector<config::SourceText>& sources, const config::Places& places)
    : sources_(sources), places_(places) {}

void Collector::add(Severity severity, const std::string& item, std::string what, std::string fix) {
  findings.push_back({severity, sources_.front().name, places_.nearest(item), item, std::move(what),
                      std::move(fix)});
}

void Collector::add_at_urdf(Severity severity, std::string_view kind, const std::string& name,
                            std::string what, std::string fix) {
  Finding finding = {severity,
                     sources_.front().name,
                     places_.nearest("urdf"),
                     std::string(kind) + " " + name,
                     std::move(what),
                     std::move(fix)};
  if (!urdfs_) urdfs_ = urdfs_among(sources_);
  for (const model::Urdf& urdf : *urdfs_) {
    const auto look = [&](const auto& parts) {
      for (const auto& part : parts) {
        if (part.name != name) continue;
        finding.file = urdf.source;
        finding.place = {part.line, 1};
      }
    };
    kind == "joint" ? look(urdf.joints) : look(urdf.links);
  }
  findings.push_back(std::move(finding));
}

bool is_urdf(const config::SourceText& source) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // of the byte order
  std::string_view text = source.content;
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return source.name.ends_with(".urdf") || (first != std::string_view::npos && text[first] == '<');
}

std::vector<model::Urdf> urdfs_among(const std::vector<config::SourceText>& sources) {
  std::vector<model::Urdf> urdfs;
  for (const config::SourceText& source : sources) {
    if (is_urdf(source)) urdfs.push_back(model::read_urdf_text(source.content, source.name));
  }
  return urdfs;
}

Findings findings_of_message(std::string_view message, const std::string& file) {
  Findings findings;
  while (!message.empty()) {
    const std::size_t end = message.find('\n');
    findings.push_back(finding_of_line(message.substr(0, end), file));
    message.remove_prefix(end == std::string_view::npos ? message.size() : end + 1);
  }
  return findings;
}

}  // namespace hg::check
