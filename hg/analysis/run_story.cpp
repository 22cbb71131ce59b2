#include "hg/analysis/run_story.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/controller/safety/rules.h"

namespace hg::analysis {
namespace {

constexpr double kGap_s = 0.5;          // interruptions of a span up to this are not reported
constexpr double kShortest_s = 0.02;    // limits that act for less are not reported
constexpr double kMoving = 2e-2;        // rad/s or m/s, measured
constexpr double kForceWindow_s = 0.5;  // the largest force is that of this window and the last

double speed_of(const Sample& sample) {
  double speed = 0.0;
  for (const double dq : sample.sensors.dq_m) speed = std::max(speed, std::abs(dq));
  for (const double dq : sample.record.robot.dq_p) speed = std::max(speed, std::abs(dq));
  return speed;
}

// force of the user; the true one if the device is simulated
double force_of(const Sample& sample) {
  const Vector6& w = sample.truth.is_known ? sample.truth.w_H : sample.record.robot.w_H;
  return w.head<3>().norm();
}

std::string side_text(LimitState state) {
  switch (state) {
    case LimitState::kLower:
      return "lower ";
    case LimitState::kUpper:
      return "upper ";
    case LimitState::kViolated:
      return "overruled ";
    case LimitState::kInactive:
      return "";
  }
  return "";
}

std::string_view reaction_text(Stop stop) {
  switch (stop) {
    case Stop::kNone:
      return "no stop was required";
    case Stop::kSs2:
      return "SS2: brought to rest under control, then drives off";
    case Stop::kSs1:
      return "SS1: brought to rest under control, then drives off and brakes closed";
    case Stop::kSto:
      return "STO: drives off and brakes closed at once";
  }
  return "unknown";
}

std::string why_it_stops(const Sample& sample, bool was_autonomous) {
  const FaultCode code = sample.record.fault.code;
  if (code == FaultCode::kOperatorReleased) return ": the operator let go of the enabling switch";
  if (safety::is_fault(code)) return ": a fault, see there";
  if (sample.operator_input.request == ModeRequest::kStop) return ": a stop was requested";
  if (was_autonomous && sample.sensors.dead_man) return ": the handle was grasped";
  if (was_autonomous && !sample.sensors.safety.override_key) {
    return ": the override key was turned off";
  }
  if (!sample.sensors.dead_man) return ": the user let go of the handle (dead-man open)";
  return "";
}

std::string release_text(const safety::Rule& rule) {
  const bool needs_new_run = rule.code == FaultCode::kDeviceSilent ||
                             rule.code == FaultCode::kDeviceGone ||
                             rule.code == FaultCode::kBrakesSlip;
  return std::string(rule.release) + (needs_new_run ? "" : ", then a reset");
}

std::string detail(const char* label, const std::string& text) {
  return fmt::format("{:<12} {}", label, text);
}

}  // namespace

RunStory::RunStory(Names names) : names_(std::move(names)) {}

void RunStory::add(const Sample& sample) {
  const CycleRecord& record = sample.record;
  if (first_s_ < 0.0) {
    begin(sample);
  } else {
    add_gap(record);
  }
  period_s_ = record.time_s - last_.time_s;
  if (record.time_s >= force_until_s_) {
    force_before_ = std::exchange(force_now_, 0.0);
    force_until_s_ = record.time_s + kForceWindow_s;
  }
  force_now_ = std::max(force_now_, force_of(sample));

  add_modes(sample);
  add_requests(record);
  add_limits(record);
  add_others(sample);
  add_fault(sample);
  if (has_aftermath_) follow(sample);
  close_spans(record.time_s, false);
  remember(sample);
}

// A recording that does not begin with the run does not show how its first state arose.
void RunStory::begin(const Sample& sample) {
  first_s_ = last_.time_s = sample.record.time_s;
  if (sample.record.cycle != 0) remember(sample);
}

void RunStory::remember(const Sample& sample) {
  const CycleRecord& record = sample.record;
  last_ = {record.cycle,      record.time_s, record.mode,
           record.fault.code, record.tare,   record.is_autonomous};
}

void RunStory::add_gap(const CycleRecord& record) {
  if (record.cycle <= last_.cycle + 1) return;
  if (lost_.gaps++ == 0) lost_.first_s = last_.time_s;
  lost_.samples += record.cycle - last_.cycle - 1;
  lost_.longest_s = std::max(lost_.longest_s, record.time_s - last_.time_s);
}

void RunStory::add_event(double time_s, const std::string& name, const std::string& text) {
  entries_.push_back({time_s, "event", name + ": " + text, {}});
}

void RunStory::add_modes(const Sample& sample) {
  const CycleRecord& record = sample.record;
  if (record.mode == last_.mode) return;
  std::string text = fmt::format("{} -> {}", to_string(last_.mode), to_string(record.mode));
  if (record.mode == Mode::kRunning) {
    text += record.is_autonomous ? ": autonomous, with the handle free"
                                 : ": the user holds the handle (dead-man closed)";
  }
  if (record.mode == Mode::kStopping) text += why_it_stops(sample, last_.is_autonomous);
  // a device at standstill stops at once
  const bool was_on = last_.mode == Mode::kArmed || last_.mode == Mode::kRunning;
  if (record.mode == Mode::kReady && was_on && !sample.sensors.safety.operator_enable) {
    text += ": the operator let go of the enabling switch";
  }
  entries_.push_back({record.time_s, "mode", text, {}});
}

void RunStory::add_requests(const CycleRecord& record) {
  if (record.refusal != Refusal::kNone) {
    entries_.push_back({record.time_s, "refused", std::string(to_string(record.refusal)), {}});
  }
  const bool is_silent = record.tare == TareStatus::kNone || record.tare == TareStatus::kUnderWay;
  if (record.tare != last_.tare && !is_silent) {
    entries_.push_back({record.time_s, "tare", std::string(to_string(record.tare)), {}});
  }
  if (record.change == ChangeStatus::kRefused) {
    entries_.push_back({record.time_s, "refused", "a change of a parameter of the twin", {}});
  }
}

void RunStory::extend(const char* kind, const std::string& text, double time_s, double value,
                      const char* unit) {
  const auto [found, is_new] = spans_.try_emplace({kind, text});
  Span& span = found->second;
  if (is_new) span.begin_s = time_s;
  span.end_s = time_s;
  span.active_s += period_s_;
  if (std::abs(value) >= std::abs(span.peak)) span.peak = value;
  span.unit = unit;
}

void RunStory::add_limits(const CycleRecord& record) {
  if (record.mode != Mode::kRunning && record.mode != Mode::kStopping) return;
  const int count = std::min(record.limit_count, static_cast<int>(names_.limits.size()));
  for (int i = 0; i < count; ++i) {
    const LimitReport& report = record.limits[i];
    const bool is_plain =
        report.state != LimitState::kViolated &&
        (report.cause == LimitCause::kAcceleration || report.cause == LimitCause::kFriction);
    if (report.state == LimitState::kInactive || is_plain) continue;
    const LimitInfo& info = names_.limits[i];
    extend(
        "limit",
        fmt::format("{}: {}{} limit", info.name, side_text(report.state), to_string(report.cause)),
        record.time_s, report.reaction, info.is_angle ? " Nm" : " N");
  }
}

void RunStory::add_others(const Sample& sample) {
  const CycleRecord& record = sample.record;
  if (record.warning.code != FaultCode::kNone) {
    const std::string part = part_of(record.warning, names_, sample.sensors);
    const std::string what = fmt::format("{}{}", fault_words(record.warning.code).name,
                                         part.empty() ? "" : " (" + part + ")");
    if (record.warning.code == FaultCode::kOscillation) {
      extend("warning", what + ": hand and device oscillate against each other", record.time_s);
    } else {
      extend("warning", fmt::format("{}, stops at {:.4g}", what, record.warning.limit),
             record.time_s, record.warning.value);
    }
  }
  if (record.touch.is_reported) {
    const std::string where =
        record.touch.joint < 0
            ? ""
            : fmt::format(" beyond joint {}", name_in(names_.joints, record.touch.joint, "number"));
    extend("contact", fmt::format("something touches the arm{}: arm and gantry yield", where),
           record.time_s, record.touch.wrench.head<3>().norm(), " N");
  }
  if (sample.truth.bystander.force > 0.0) {
    extend("bystander", "the arm hits the bystander", record.time_s, sample.truth.bystander.force,
           " N");
  }
  for (int i = 0; i < 32; ++i) {
    if (((record.sanitised >> i) & 1U) == 0) continue;
    const std::string which =
        i < 16 ? name_in(names_.joints, i, "number") : name_in(names_.gantry, i - 16, "gantry");
    extend("command", which + ": the sanitiser changed it before it left", record.time_s);
  }
  if (record.solver_status == SolverStatus::kBudgetSpent) {
    extend(
        "solver",
        "ended before its result was proven: the joints keep their limits, the twin is not exact",
        record.time_s);
  }
  if (record.solver_status == SolverStatus::kFailed) extend("solver", "failed", record.time_s);
  if (sample.operator_input.late_cycles > 0) {
    extend("late", "cycles that were missed at once", record.time_s,
           static_cast<double>(sample.operator_input.late_cycles));
  }
  if (record.tracking.is_clamped) {
    extend("tracking", "the device lagged behind: its reference was clamped to it", record.time_s);
  }
}

void RunStory::close_spans(double now_s, bool all) {
  for (auto it = spans_.begin(); it != spans_.end();) {
    const Span& span = it->second;
    if (!all && now_s < span.end_s + kGap_s) {
      ++it;
      continue;
    }
    const auto& [kind, text] = it->first;
    if (kind != "limit" || span.active_s >= kShortest_s) {
      const std::string peak =
          span.peak != 0.0 ? fmt::format(", up to {:.3g}{}", span.peak, span.unit) : "";
      entries_.push_back(
          {span.begin_s,
           kind,
           fmt::format("{}{}, for {:.3f} s until {:.3f} s", text, peak, span.active_s, span.end_s),
           {}});
    }
    it = spans_.erase(it);
  }
}

void RunStory::add_fault(const Sample& sample) {
  const CycleRecord& record = sample.record;
  const Fault& fault = record.fault;
  if (fault.code == last_.fault) return;
  end_aftermath();
  // the stop is reported with the mode, as is re-arming by the operator
  if (fault.code == FaultCode::kOperatorReleased) return;
  if (fault.code == FaultCode::kNone) {
    if (!safety::is_fault(last_.fault)) return;
    entries_.push_back({record.time_s, "reset", "the fault is gone and was reset", {}});
    return;
  }
  const FaultWords& words = fault_words(fault.code);
  const std::string figures = figures_of(fault, names_, sample.sensors);
  Entry entry{record.time_s,
              "FAULT",
              fmt::format("{} {}{}", static_cast<int>(fault.code), words.name,
                          figures.empty() ? "" : " (" + figures + ")"),
              {}};
  entry.details.push_back(detail("meaning", std::string(words.meaning)));
  entry.details.push_back(detail("released by", release_text(safety::rule_of(fault.code))));
  has_aftermath_ = true;
  aftermath_ = {.entry = entries_.size(),
                .fault_s = record.time_s,
                .force = std::max(force_before_, force_now_)};
  entries_.push_back(std::move(entry));
}

void RunStory::follow(const Sample& sample) {
  const CycleRecord& record = sample.record;
  aftermath_.force = std::max(aftermath_.force, force_of(sample));
  aftermath_.speed = speed_of(sample);
  if (aftermath_.speed > kMoving) aftermath_.moved_s = record.time_s;
  if (!sample.command.enable && aftermath_.off_s < 0.0) aftermath_.off_s = record.time_s;
  if (record.stop != Stop::kNone) aftermath_.stop = record.stop;
}

void RunStory::end_aftermath() {
  if (!std::exchange(has_aftermath_, false)) return;
  std::vector<std::string>& details = entries_[aftermath_.entry].details;
  const auto after_ms = [&](double time_s) { return 1e3 * (time_s - aftermath_.fault_s); };
  std::string what = aftermath_.stop != Stop::kNone ? std::string(reaction_text(aftermath_.stop))
                                                    : "the machine was stopped";
  if (aftermath_.off_s >= 0.0) {
    what += fmt::format("; drives off {:.0f} ms after the fault", after_ms(aftermath_.off_s));
  }
  details.push_back(detail("reaction", what));
  std::string rest = "the device was at rest already";
  if (aftermath_.moved_s >= last_.time_s && aftermath_.speed > kMoving) {
    rest = fmt::format(
        "not seen: {:.0f} ms later the recording ends, or the fault, at {:.3f} rad/s or "
        "m/s",
        after_ms(last_.time_s), aftermath_.speed);
  } else if (aftermath_.moved_s >= 0.0) {
    rest = fmt::format("{:.0f} ms after the fault", after_ms(aftermath_.moved_s));
  }
  details.push_back(detail("at rest", rest));
  details.push_back(
      detail("peak force",
             fmt::format("{:.1f} N between user and handle, from half a second or more before",
                         aftermath_.force)));
}

std::vector<Entry> RunStory::finish() {
  end_aftermath();
  close_spans(last_.time_s, true);
  if (lost_.gaps > 0) {
    entries_.push_back({lost_.first_s,
                        "LOST",
                        fmt::format("{} samples are missing from here on in {} gaps, the longest "
                                    "{:.3f} s: what happened there is not known",
                                    lost_.samples, lost_.gaps, lost_.longest_s),
                        {}});
  }
  std::ranges::stable_sort(entries_, {}, &Entry::time_s);
  return std::exchange(entries_, {});
}

}  // namespace hg::analysis
