#include "hg/analysis/timing.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace hg::analysis {
namespace {

constexpr double kBounds_us[] = {1,    2,    5,    10,  20,  50,  100, 200, 500,
                                 1000, 2000, 5000, 1e4, 2e4, 5e4, 1e5, 1e6};

std::string line(const char* label, const std::string& value) {
  return fmt::format("  {:<12} {}\n", label, value);
}

double percent(std::uint64_t part, std::uint64_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string wake_up_text(const Histogram& times) {
  const Distribution us = times.distribution();
  std::string text = fmt::format("median {:.1f} us, 99.9 % {:.1f} us, max {:.1f} us late;",
                                 us.median, us.p99_9, us.max);
  const char* separator = " ";
  for (const double bound : {10.0, 100.0, 1000.0}) {
    text += fmt::format("{}{:.2f} % within {:.0f} us", separator,
                        percent(times.below(bound), times.count()), bound);
    separator = ", ";
  }
  return text;
}

std::string stages_text(const std::vector<StageTime>& stages) {
  std::string text;
  for (const StageTime& stage : stages) {
    text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ", stage.name, stage.us.median);
  }
  return text + " us (medians)";
}

std::string late_text(const Timing& timing) {
  const char* why = "";
  if (!timing.overruns_stop) {
    why = timing.priority == 0 ? "; counted only: the thread is not real time"
                               : "; counted only: the device waits for its controller";
  }
  return fmt::format("{} cycles of this computer, at most {} in a row{}", timing.overruns,
                     timing.most_overruns_in_a_row, why);
}

}  // namespace

std::string priority_text(const Timing& timing) {
  if (timing.is_fast) return "normal (fast)";
  if (timing.priority == 0) {
    return timing.priority_refusal.empty()
               ? "normal"
               : fmt::format("normal (SCHED_FIFO refused: {}; see hapticgiant doctor)",
                             timing.priority_refusal);
  }
  std::string text = fmt::format("real time, priority {}", timing.priority);
  if (timing.cpu >= 0) text += fmt::format(", processor {}", timing.cpu);
  if (!timing.cpu_refusal.empty()) text += ", processor refused: " + timing.cpu_refusal;
  text += timing.is_memory_locked ? ", memory locked" : ", memory not locked";
  return text + fmt::format(", {} page faults in the loop", timing.page_faults);
}

std::string timing_lines(const Timing& timing) {
  std::string text;
  if (timing.wake_up_us.count() > 0) text += line("wake-up", wake_up_text(timing.wake_up_us));
  if (!timing.is_fast && timing.overruns > 0) text += line("late", late_text(timing));
  if (!timing.stages.empty()) text += line("stages", stages_text(timing.stages));
  return text;
}

void add_to(nlohmann::ordered_json& json, const Timing& timing) {
  json["overruns"] = timing.overruns;
  json["most_overruns_in_a_row"] = timing.most_overruns_in_a_row;
  json["overruns_stop"] = timing.overruns_stop;
  json["real_time"] = timing.priority > 0;
  json["priority"] = timing.priority;
  json["cpu"] = timing.cpu;
  json["memory_locked"] = timing.is_memory_locked;
  json["page_faults_in_loop"] = timing.page_faults;
  if (timing.wake_up_us.count() > 0) json["wake_up_us"] = to_json(timing.wake_up_us);
  for (const StageTime& stage : timing.stages) {
    json["stage_time_us"][stage.name] = to_json(stage.us);
  }
}

nlohmann::ordered_json to_json(const Distribution& d) {
  return {{"median", d.median}, {"p99_9", d.p99_9}, {"max", d.max}};
}

nlohmann::ordered_json to_json(const Histogram& histogram) {
  nlohmann::ordered_json json = to_json(histogram.distribution());
  json["histogram"] = nlohmann::ordered_json::array();
  std::uint64_t below = 0;
  for (const double bound : kBounds_us) {
    if (below == histogram.count()) break;
    const std::uint64_t now = histogram.below(bound);
    json["histogram"].push_back({{"below", bound}, {"count", now - below}});
    below = now;
  }
  return json;
}

}  // namespace hg::analysis
