/// What `check` finds: plain data, printed by the program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hg/config/faults.h"
#include "hg/config/sources.h"

namespace hg::inspection {

enum class Severity {
  kNote,     ///< worth knowing
  kWarning,  ///< it runs, but not as one would expect
  kFault,    ///< it cannot run, or must not
};

std::string_view to_string(Severity severity) noexcept;

struct Finding {
  Severity severity = Severity::kFault;
  std::string file;
  config::Place place;
  std::string item;  ///< path of the key: "joints.m1.ddq_max_rad_per_s2"
  std::string what;  ///< the value, and what is expected
  std::string mend;  ///< what to change; empty where `what` says it
};
using Findings = std::vector<Finding>;

/// Collects the findings of one YAML file and of the URDF that it names.
class Collector {
 public:
  /// `sources` are those of the thing, its YAML file first. Both must outlive the collector.
  Collector(const std::vector<config::SourceText>& sources, const config::Places& places);

  /// At a key of the YAML file or, where it is not given, at what would hold it.
  void add(Severity severity, const std::string& item, std::string what, std::string mend);
  /// At the line of a joint or link of the URDF; at the YAML file where there is none.
  void add_at_urdf(Severity severity, std::string_view kind, const std::string& name,
                   std::string what, std::string mend);

  Findings findings;

 private:
  const std::vector<config::SourceText>& sources_;
  const config::Places& places_;
};

/// Findings for what a loader or another part of the program refuses: one per line of `message`,
/// each "file:line:column: item: what" as far as it has these; `file` stands in for a missing one.
Findings findings_of_message(std::string_view message, const std::string& file);

}  // namespace hg::inspection
