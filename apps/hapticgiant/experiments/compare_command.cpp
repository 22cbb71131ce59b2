#include "apps/hapticgiant/experiments/compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/recorded_signals.h"
#include "apps/hapticgiant/output.h"

namespace hg::apps {
namespace {

using Json = nlohmann::ordered_json;

// smallest reported differences: half a cycle, an imperceptible force, a fraction of the allowed
// excess
constexpr double kTime_s = 5e-4, kForce_N = 0.05, kExcess = 5e-5, kShare = 0.02;

/// Lines under a heading; no lines means no difference.
class Findings {
 public:
  void add(const std::string& text) { lines_.push_back(text); }
  bool is_empty() const { return lines_.empty(); }
  void print(const std::string& heading, const std::string& otherwise) const {
    print_out(fmt::format("{:<14} {}\n", heading, lines_.empty() ? otherwise : lines_.front()));
    for (std::size_t i = 1; i < lines_.size(); ++i) {
      print_out(fmt::format("{:<14} {}\n", "", lines_[i]));
    }
  }

 private:
  std::vector<std::string> lines_;
};

const recording::NamedText* find(const std::vector<recording::NamedText>& texts,
                                 const std::string& name) {
  const auto found = std::ranges::find(texts, name, &recording::NamedText::name);
  return found == texts.end() ? nullptr : &*found;
}

std::string in_one_line(std::string text) {
  if (!text.empty() && text.back() == '\n') text.pop_back();
  std::ranges::replace(text, '\n', ' ');
  return text.empty() ? "none" : text;
}

Findings configuration(const RecordedSignals& a, const RecordedSignals& b) {
  Findings findings;
  const auto options = [](const RecordedSignals& run) {
    const auto* text = find(run.configuration, "arguments");
    return in_one_line(text == nullptr ? "" : text->text);
  };
  if (options(a) != options(b)) {
    findings.add(fmt::format("options: {} -> {}", options(a), options(b)));
  }
  for (const recording::NamedText& text : a.configuration) {
    if (text.name == "arguments") continue;
    const auto* other = find(b.configuration, text.name);
    if (other == nullptr) findings.add(text.name + ": only in the first");
    if (other != nullptr && other->text != text.text) findings.add(text.name + ": changed");
  }
  for (const recording::NamedText& text : b.configuration) {
    if (text.name != "arguments" && find(a.configuration, text.name) == nullptr) {
      findings.add(text.name + ": only in the second");
    }
  }
  return findings;
}

Findings state(const RecordedSignals& a, const RecordedSignals& b) {
  Findings findings;
  const std::uint64_t first_a = a.hashes.front().cycle, first_b = b.hashes.front().cycle;
  if (first_a != first_b) findings.add(fmt::format("begins with cycle {} / {}", first_a, first_b));
  // cycle by cycle, of those that both have
  bool is_different = false;
  std::size_t only_first = 0, only_second = 0;
  auto other = b.hashes.begin();
  for (const CycleHash& one : a.hashes) {
    while (other != b.hashes.end() && other->cycle < one.cycle) ++other, ++only_second;
    if (other == b.hashes.end()) break;
    if (other->cycle != one.cycle) {
      ++only_first;
      continue;
    }
    if (!is_different && other->hash != one.hash) {
      is_different = true;
      findings.add(fmt::format("different from cycle {} ({:.3f} s) on", one.cycle,
                               static_cast<double>(one.cycle) / a.rate_Hz()));
    }
    ++other;
  }
  if (only_first + only_second > 0) {
    findings.add(fmt::format("{} cycles are in the first only, {} in the second only", only_first,
                             only_second));
  }
  if (a.hashes.size() != b.hashes.size()) {
    findings.add(fmt::format("{} -> {} cycles", a.hashes.size(), b.hashes.size()));
  }
  return findings;
}

Findings events(const RecordedSignals& a, const RecordedSignals& b) {
  Findings findings;
  std::vector<bool> is_matched(b.marks.size());
  for (const Mark& mark : a.marks) {
    std::size_t other = 0;  // the first of that name that has no partner yet
    while (other < b.marks.size() && (is_matched[other] || b.marks[other].label != mark.label)) {
      ++other;
    }
    if (other == b.marks.size()) {
      findings.add(fmt::format("{} ({:.3f} s) is missing in the second", mark.label, mark.time_s));
      continue;
    }
    is_matched[other] = true;
    const double later = b.marks[other].time_s - mark.time_s;
    if (std::abs(later) < kTime_s) continue;
    findings.add(fmt::format("{} {:.0f} ms {} ({:.3f} -> {:.3f} s)", mark.label,
                             1e3 * std::abs(later), later > 0.0 ? "later" : "earlier", mark.time_s,
                             b.marks[other].time_s));
  }
  for (std::size_t i = 0; i < b.marks.size(); ++i) {
    if (!is_matched[i]) {
      findings.add(
          fmt::format("{} ({:.3f} s) is new in the second", b.marks[i].label, b.marks[i].time_s));
    }
  }
  return findings;
}

// "mean 10.5 -> 11.2 N"; nothing where the difference is at most `least`
void tell(Findings& findings, const std::string& what, const Json& a, const Json& b, double least,
          double scale, const std::string& unit, int digits) {
  if (!a.is_number() || !b.is_number()) return;
  const double before = a.get<double>(), after = b.get<double>();
  if (std::abs(after - before) <= least) return;
  findings.add(fmt::format("{} {:.{}f} -> {:.{}f} {}", what, scale * before, digits, scale * after,
                           digits, unit));
}

Findings forces(const Json& a, const Json& b) {
  Findings findings;
  tell(findings, "mean", a["force"]["mean_N"], b["force"]["mean_N"], kForce_N, 1.0, "N", 2);
  tell(findings, "largest", a["force"]["max_N"], b["force"]["max_N"], kForce_N, 1.0, "N", 1);
  tell(findings, "largest torque", a["force"]["max_torque_Nm"], b["force"]["max_torque_Nm"],
       kForce_N, 1.0, "Nm", 2);
  return findings;
}

void compare_limits(Findings& findings, const std::string& where, const Json& a, const Json& b) {
  for (const auto& [name, limit] : a.items()) {
    if (!b.contains(name)) continue;
    const bool is_angle = limit["unit"] == "rad";
    tell(findings, fmt::format("{}{} exceeded by", where, name), limit["worst_violation"],
         b[name]["worst_violation"], kExcess, 1e3, is_angle ? "mrad" : "mm", 2);
  }
}

Findings limits(const Json& a, const Json& b) {
  Findings findings;
  compare_limits(findings, "", a["limits"], b["limits"]);
  if (a.contains("reality") && b.contains("reality")) {
    compare_limits(findings, "in truth ", a["reality"]["limits"], b["reality"]["limits"]);
  }
  return findings;
}

Findings motion(const Json& a, const Json& b) {
  Findings findings;
  tell(findings, "hand and twin apart by at most", a["sync_error"]["max_m"],
       b["sync_error"]["max_m"], kExcess, 1e3, "mm", 2);
  tell(findings, "active-set changes", a["solver"]["active_set_changes_per_second"],
       b["solver"]["active_set_changes_per_second"], 0.1, 1.0, "per second", 1);
  tell(findings, "acceleration changes per cycle", a["acceleration_change_per_cycle"]["mean"],
       b["acceleration_change_per_cycle"]["mean"], 1e-3, 1.0, "m/s^2", 4);
  return findings;
}

Findings timing(const Json& a, const Json& b) {
  Findings findings;
  const Json &before = a["cycle_time_us"], &after = b["cycle_time_us"];
  for (const auto& [key, name] :
       {std::pair("median", "median"), std::pair("p99_9", "99.9 %"), std::pair("max", "largest")}) {
    if (before[key] == 0.0 || after[key] == 0.0) continue;  // not recorded
    tell(findings, name, before[key], after[key], kShare * before[key].get<double>(), 1.0, "us", 1);
  }
  return findings;
}

std::string head(const RecordedSignals& run) {
  return fmt::format(
      "{}, law {}, {} bounds, {:g} Hz, {:.1f} s{}", run.summary["scenario"].get<std::string>(),
      run.summary["law"].get<std::string>(), run.summary["bounds"].get<std::string>(),
      run.rate_Hz(), run.summary["duration_s"].get<double>(),
      run.read.is_complete ? "" : ", cut off");
}

}  // namespace

int compare(const CompareArguments& arguments) {
  const RecordedSignals a = read_signals(arguments.a, kFigurePeriod_s);
  const RecordedSignals b = read_signals(arguments.b, kFigurePeriod_s);
  print_out("{:<14} {}: {}\n{}{:<14} {}: {}\n{}\n", "first", arguments.a, head(a),
            recording::to_text(a.read.losses), "second", arguments.b, head(b),
            recording::to_text(b.read.losses));
  const std::pair<const char*, Findings> all[] = {{"configuration", configuration(a, b)},
                                                  {"state", state(a, b)},
                                                  {"events", events(a, b)},
                                                  {"forces", forces(a.summary, b.summary)},
                                                  {"limits", limits(a.summary, b.summary)},
                                                  {"motion", motion(a.summary, b.summary)}};
  bool is_same = true;
  for (const auto& [heading, findings] : all) {
    findings.print(heading,
                   heading == std::string("state") ? "the same in every cycle" : "nothing changed");
    is_same = is_same && findings.is_empty();
  }
  timing(a.summary, b.summary).print("timing", "nothing changed, or not recorded");
  return is_same ? 0 : 1;
}

}  // namespace hg::apps
