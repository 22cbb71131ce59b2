#include "apps/hapticgiant/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/print_datasheet.h"

namespace hg::apps {
namespace {

using check::CheckedFile;
using check::CheckReport;
using check::Finding;
using check::Severity;

std::string counted(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

int count(const CheckReport& report, Severity severity) {
  return static_cast<int>(std::ranges::count(report.findings, severity, &Finding::severity));
}

void print(const CheckReport& report) {
  for (const CheckedFile& file : report.files) print_out("{}: {}\n", file.name, file.kind);
  if (!report.findings.empty()) print_out("\n");
  for (const Finding& finding : report.findings) {
    print_out("{}:{}:{}: {}: {}{}{}\n", finding.file, finding.place.line, finding.place.column,
              to_string(finding.severity), finding.item, finding.item.empty() ? "" : ": ",
              finding.what);
    if (!finding.fix.empty()) print_out("    to fix: {}\n", finding.fix);
  }
  for (const check::Datasheet& sheet : report.datasheets) print_datasheet(sheet);
  const int faults = count(report, Severity::kFault);
  print_out("\n{}: {}, {}, {}\n", counted(static_cast<int>(report.files.size()), "file"),
            counted(faults, "fault"), counted(count(report, Severity::kWarning), "warning"),
            counted(count(report, Severity::kNote), "note"));
  if (faults > 0) print_out("Every key, its range and meaning: docs/reference/configuration.md\n");
}

std::string to_json(const CheckReport& report) {
  nlohmann::json json;
  json["files"] = nlohmann::json::array();
  for (const CheckedFile& file : report.files) {
    json["files"].push_back({{"file", file.name}, {"kind", file.kind}});
  }
  json["findings"] = nlohmann::json::array();
  for (const Finding& finding : report.findings) {
    json["findings"].push_back({{"severity", to_string(finding.severity)},
                                {"file", finding.file},
                                {"line", finding.place.line},
                                {"column", finding.place.column},
                                {"item", finding.item},
                                {"what", finding.what},
                                {"fix", finding.fix}});
  }
  json["faults"] = count(report, Severity::kFault);
  json["warnings"] = count(report, Severity::kWarning);
  json["notes"] = count(report, Severity::kNote);
  json["datasheets"] = nlohmann::json::array();
  for (const check::Datasheet& sheet : report.datasheets) {
    json["datasheets"].push_back(datasheet_json(sheet));
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace hg::apps
