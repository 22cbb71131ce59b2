#include "hg/messages/diagnostics.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "hg/core/text.h"

namespace hg::messages {
namespace {

constexpr std::uint8_t kOk = 0, kWarning = 1, kError = 2;
constexpr const char* kHardware = "hapticgiant";

std::size_t limit_count(const LimitCatalogue& limits, const CycleRecord& record) {
  return std::min<std::size_t>(limits.size(), static_cast<std::size_t>(record.limit_count));
}

bool acts(const LimitReport& report) { return report.state != LimitState::kInactive; }

std::string rounded(double value) { return to_text(std::round(1e3 * value) * 1e-3); }

}  // namespace

Diagnostics::Diagnostics(const RunNames& names)
    : limits_(names.limits), is_acting_(names.limits.size()) {}

void Diagnostics::observe(const Sample& sample) {
  late_cycles_ += sample.operator_input.late_cycles;
  longest_cycle_us_ = std::max(longest_cycle_us_, sample.cycle_time_us);
}

bool Diagnostics::is_due(const CycleRecord& record) const {
  if (!has_message_ || record.mode != mode_ || record.fault.code != fault_) return true;
  if (record.time_s - time_s_ >= kPeriod_s || record.time_s < time_s_) return true;
  for (std::size_t i = 0; i < limit_count(limits_, record); ++i) {
    if (acts(record.limits[i]) != is_acting_[i]) return true;
  }
  return false;
}

const DiagnosticArray& Diagnostics::update(const Sample& sample, std::uint64_t time_ns) {
  const CycleRecord& record = sample.record;
  message_.header.stamp = to_ros(time_ns);
  message_.status = {device_status(sample), loop_status(), limit_status(record)};
  has_message_ = true;
  time_s_ = record.time_s;
  mode_ = record.mode;
  fault_ = record.fault.code;
  for (std::size_t i = 0; i < limit_count(limits_, record); ++i) {
    is_acting_[i] = acts(record.limits[i]);
  }
  longest_cycle_us_ = 0.0;
  return message_;
}

DiagnosticStatus Diagnostics::device_status(const Sample& sample) const {
  const CycleRecord& record = sample.record;
  DiagnosticStatus status{.name = "hapticgiant: device", .hardware_id = kHardware};
  const bool has_fault = record.fault.code != FaultCode::kNone;
  const bool has_warning = record.warning.code != FaultCode::kNone;
  status.level = has_fault ? kError : has_warning ? kWarning : kOk;
  status.message = to_string(record.mode);
  if (has_fault) status.message += ": " + std::string(to_string(record.fault.code));
  status.values = {
      {"mode", std::string(to_string(record.mode))},
      {"stop", std::string(to_string(record.stop))},
      {"fault", std::to_string(static_cast<int>(record.fault.code))},
      {"fault text", has_fault ? std::string(to_string(record.fault.code)) : ""},
      {"warning", has_warning ? std::string(to_string(record.warning.code)) : ""},
      {"tared", record.is_tared ? "true" : "false"},
      {"field_clear", sample.sensors.safety.is_field_clear ? "true" : "false"},
      {"time_s", rounded(record.time_s)},
  };
  return status;
}

DiagnosticStatus Diagnostics::loop_status() const {
  DiagnosticStatus status{.name = "hapticgiant: control loop", .hardware_id = kHardware};
  status.level = late_cycles_ > 0 ? kWarning : kOk;
  status.message = late_cycles_ > 0 ? std::to_string(late_cycles_) + " late cycles" : "in time";
  status.values = {{"late cycles", std::to_string(late_cycles_)},
                   {"longest cycle, us", rounded(longest_cycle_us_)}};
  return status;
}

DiagnosticStatus Diagnostics::limit_status(const CycleRecord& record) const {
  DiagnosticStatus status{.name = "hapticgiant: limits", .hardware_id = kHardware};
  for (std::size_t i = 0; i < limit_count(limits_, record); ++i) {
    const LimitReport& report = record.limits[i];
    if (!acts(report)) continue;
    if (report.state == LimitState::kViolated) status.level = kWarning;
    std::string text(to_string(report.state));
    text += ", ";
    text += to_string(report.cause);
    text += ", " + rounded(report.reaction) + (limits_[i].is_angle ? " Nm" : " N");
    status.values.push_back({limits_[i].name, std::move(text)});
  }
  status.message =
      status.values.empty() ? "none acts" : std::to_string(status.values.size()) + " act";
  return status;
}

}  // namespace hg::messages
