#include "bench/bench_results.h"

#include <cmath>

namespace hg::bench {
namespace {

using nlohmann::ordered_json;

ordered_json ns_of(const Times& times) {
  std::vector<long long> ns;
  for (const double us : times.us()) ns.push_back(std::llround(1e3 * us));
  return ns;
}

ordered_json json_of(const SolverSet& set) {
  ordered_json runs = ordered_json::array();
  for (const SolverRun& run : set.runs) {
    runs.push_back({{"solver", std::string(run.solver)},
                    {"ns", ns_of(run.times)},
                    {"active_sets_tried", run.iterations},
                    {"failed", run.failures},
                    {"wrong", run.wrong ? ordered_json(*run.wrong) : ordered_json()}});
  }
  return {{"set", set.name},
          {"variables", set.variables},
          {"levels", set.levels},
          {"problems", set.problems},
          {"runs", runs}};
}

ordered_json json_of(const GrowthRow& row) {
  return {{"variables", row.variables},
          {"levels", row.levels},
          {"rows", row.rows},
          {"cold_ns", ns_of(row.cold)},
          {"cold_active_sets_tried", row.cold_iterations},
          {"warm_ns", ns_of(row.warm)},
          {"warm_active_sets_tried", row.warm_iterations},
          {"failed", row.failures}};
}

ordered_json json_of(const LawRun& run) {
  return {{"scenario", run.scenario},
          {"law", run.law},
          {"bounds", run.bounds},
          {"events", run.events},
          {"expected_events", run.expected_events},
          {"missing_events", run.missing},
          {"fault", std::string(to_string(run.fault))},
          {"cycles", run.cycles},
          {"unsolved", run.unsolved},
          {"duration_s", run.duration_s},
          {"changes", run.changes},
          {"changed_cycles", run.changed_cycles},
          {"sum_acceleration_change", run.sum_acceleration_change},
          {"max_acceleration_change", run.max_acceleration_change},
          {"worst_violation",
           {{"limit", run.worst_limit},
            {"value", run.worst_violation},
            {"unit", run.worst_is_angle ? "rad" : "m"}}},
          {"solver_ns", ns_of(run.solver)},
          {"cycle_ns", ns_of(run.cycle)}};
}

template <typename Item>
ordered_json json_of(const std::vector<Item>& items) {
  ordered_json json = ordered_json::array();
  for (const Item& item : items) json.push_back(json_of(item));
  return json;
}

}  // namespace

ordered_json json_of(const CycleTimes& times) {
  ordered_json stages = ordered_json::object();
  for (int i = 0; i < kStageCount; ++i) {
    stages[to_string(static_cast<Stage>(i))] = ns_of(times.stages[i]);
  }
  return {{"scenario", times.scenario}, {"total", ns_of(times.total)}, {"stages", stages}};
}

ordered_json to_json(const BenchResults& results) {
  return {{"kind", "bench"},
          {"machine", results.machine},
          {"passes", results.passes},
          {"most_problems", results.most_problems},
          {"most_cycles", results.most_cycles},
          {"remarks", results.remarks},
          {"solver", json_of(results.solver)},
          {"cycles", json_of(results.cycles)},
          {"growth", json_of(results.growth)},
          {"laws", json_of(results.laws)}};
}

}  // namespace hg::bench
