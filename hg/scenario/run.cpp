#include "hg/scenario/run.h"

#include <algorithm>
#include <cstring>
#include <string>

#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"

namespace hg::scenario {
namespace {

std::string text_of(int error) { return error == 0 ? "" : std::strerror(error); }

analysis::Timing timing_of(const runtime::RuntimeOptions& options,
                           const runtime::RuntimeReport& report) {
  const runtime::ThreadReport& thread = report.thread;
  analysis::Timing timing = {.is_fast = options.is_fast,
                             .priority = thread.priority,
                             .priority_refusal = text_of(thread.priority_error),
                             .cpu = thread.cpu,
                             .cpu_refusal = text_of(thread.cpu_error),
                             .is_memory_locked = thread.is_memory_locked,
                             .page_faults = report.page_faults,
                             .overruns = report.overruns,
                             .most_overruns_in_a_row = report.most_overruns_in_a_row,
                             .overruns_stop = report.reported_late_cycles,
                             .wake_up_us = report.wake_up_us};
  for (int i = 0; i < kStageCount; ++i) {
    const Histogram& times = report.stage_us[i];
    if (times.count() == 0) continue;
    timing.stages.push_back({to_string(static_cast<Stage>(i)), times.distribution()});
  }
  return timing;
}

}  // namespace

runtime::RuntimeOptions run_options(const config::Scenario& scenario) {
  runtime::RuntimeOptions options;
  options.duration_s = planned_duration_s(scenario);
  options.longest_stop_s = longest_stop_s(scenario);
  options.changes = scenario.changes;
  options.panel = scenario.panel;
  options.load = faults::loads_of(scenario.faults);
  options.stays_in_fault = std::ranges::find(scenario.panel, ModeRequest::kReset,
                                             &TimedPanel::request) != scenario.panel.end();
  return options;
}

analysis::RunFacts facts_of_run(const config::Scenario& scenario,
                                const runtime::RuntimeOptions& options,
                                const runtime::RuntimeReport& report) {
  analysis::RunFacts facts = facts_of_scenario(scenario);
  facts.rate_Hz = scenario.device.model.rate_Hz;
  facts.timing = timing_of(options, report);
  facts.dropped = report.dropped;
  facts.allocations_in_loop = report.allocations;
  facts.stop_timed_out = report.stop_timed_out;
  return facts;
}

}  // namespace hg::scenario
