#include "hg/check/findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/model/urdf.h"

namespace hg::check {
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

std::string rounded_down(double value, int digits) {
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (!(std::stod(text) > value)) return text;
  const double step = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return fmt::format("{:.{}g}", value - step / 2.0, digits);
}

std::string rounded_up(double value, int digits) {
  std::string text = fmt::format("{:.{}g}", value, digits);
  if (!(std::stod(text) < value)) return text;
  const double step = std::pow(10.0, std::floor(std::log10(value)) - digits + 1);
  return fmt::format("{:.{}g}", value + step / 2.0, digits);
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

Finding finding_of(const InputFault& fault, const std::string& file) {
  Finding finding = {.file = file, .place = {}, .item = fault.item, .what = fault.what, .fix = {}};
  if (fault.line > 0) {
    finding.file = fault.file;
    finding.place = {fault.line, std::max(1, fault.column)};
  } else if (!fault.file.empty() && fault.file != file) {
    finding.item = fault.file;
    finding.what = text_without_place(fault);
  }
  return finding;
}

Findings findings_of(const SetupError& error, const std::string& file) {
  Findings findings;
  for (const InputFault& fault : faults_of(error)) findings.push_back(finding_of(fault, file));
  return findings;
}

}  // namespace hg::check
