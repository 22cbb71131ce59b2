/// Findings of `check`: plain data, printed by the program.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hg/config/sources.h"
#include "hg/core/input_fault.h"
#include "hg/model/urdf.h"

namespace hg::check {

enum class Severity {
  kNote,     ///< information
  kWarning,  ///< usable, but not as expected
  kFault,    ///< unusable or unsafe
};

std::string_view to_string(Severity severity) noexcept;

struct Finding {
  Severity severity = Severity::kFault;
  std::string file;
  config::Place place;
  std::string item;  ///< path of the key, e.g. "joints.m1.ddq_max_rad_per_s2"
  std::string what;  ///< the value and the expected one
  std::string fix;   ///< suggested change; empty where `what` contains it
};
using Findings = std::vector<Finding>;

/// Collects the findings of one YAML file and of the URDF that it names.
class Collector {
 public:
  /// `sources` are those of the inspected item, its YAML file first. Both must outlive the
  /// collector.
  Collector(const std::vector<config::SourceText>& sources, const config::Places& places);

  /// Adds a finding at a key of the YAML file or, where it is not given, at the map or list that
  /// would hold it.
  void add(Severity severity, const std::string& item, std::string what, std::string fix);
  /// Adds a finding at the line of a joint or link of the URDF; at the YAML file where there is
  /// none.
  void add_at_urdf(Severity severity, std::string_view kind, const std::string& name,
                   std::string what, std::string fix);

  Findings findings;

 private:
  const std::vector<config::SourceText>& sources_;
  const config::Places& places_;
  std::optional<std::vector<model::Urdf>> urdfs_;  // among the sources, once one is needed
};

/// A positive value with so many digits, rounded so that who takes it over keeps a limit: not above
/// the value, or not below it.
std::string rounded_down(double value, int digits);
std::string rounded_up(double value, int digits);

/// By its name or its first character: other files may speak of <robot>, too.
bool is_urdf(const config::SourceText& source);

/// The URDFs among these texts.
std::vector<model::Urdf> urdfs_among(const std::vector<config::SourceText>& sources);

/// A finding from a fault. Without a line it is at the beginning of `file`, the inspected one; its
/// item is then the file of the fault, if that is another one.
Finding finding_of(const InputFault& fault, const std::string& file);
/// Findings from an error of a loader or another part of the program, one per fault.
Findings findings_of(const SetupError& error, const std::string& file);

}  // namespace hg::check
