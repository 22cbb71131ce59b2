#include "apps/offline/experiment_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/run_data.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/run/run_player.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kFrame_s = 0.01;

Json expected_events(const config::Scenario& scenario) {
  Json events = Json::array();
  for (const EventRule& rule : scenario.events) {
    events.push_back(describe(rule, scenario));
    events.back()["time_s"] = nullptr;
  }
  return events;
}

bool walks_through_door(const config::Scenario& scenario) {
  return scenario.person == person::PersonKind::kScript &&
         scenario.script.script.walk.kind == person::WalkKind::kDoorway;
}

// The doorway, and the body that went through it.
Json describe_walk(const config::Scenario& scenario, const Json& film) {
  const auto pair = [](const Eigen::Vector2d& p) { return Json{p.x(), p.y()}; };
  const person::Doorway& doorway = scenario.script.script.walk.doorway;
  return {{"half_breadth_m", person::kHalfBreadth},
          {"joint", scenario.twin.model.chain.joints()[doorway.joint].name},
          {"hinge_m", pair(doorway.hinge)},
          {"along", pair(doorway.along)},
          {"away", pair(doorway.away)},
          {"leaf_width_m", doorway.leaf_width},
          {"clear_width_m", doorway.clear_width},
          {"columns", {"time_s", "x_m", "y_m", "heading_rad", "hold"}},
          {"film", film}};
}

/// What the report needs of a run, and its progress on a terminal.
class Collector final : public scenario::RunObserver {
 public:
  Collector(std::string_view name, const config::Scenario& scenario, double duration_s)
      : events(expected_events(scenario)),
        name_(name),
        scenario_(scenario),
        duration_s_(duration_s),
        is_filmed_(walks_through_door(scenario)),
        frame_cycles_(std::max(1L, std::lround(kFrame_s * scenario.device.model.rate_Hz))) {}

  void sample(const Sample& sample) override {
    const CycleRecord& record = sample.record;
    const WalkerReport& walker = sample.truth.walker;
    columns.append(sample);
    q_a_ = record.twin.q_a;
    if (!is_filmed_ || !walker.is_walking || record.cycle % frame_cycles_ != 0) return;
    film.push_back({record.time_s, walker.x, walker.y, walker.heading, walker.hold});
  }
  void event(double time_s, std::string_view name, std::string_view text) override {
    for (Json& event : events) {
      if (event["name"] != name || event["what"] != text) continue;
      event["time_s"] = time_s;
      event["points"] = twin_points(scenario_, q_a_);
      return;
    }
  }
  void status(const Sample& sample, const config::Scenario&) override {
    if (isatty(STDERR_FILENO) == 0) return;
    const double time_s = sample.record.time_s;
    draw_error(time_s >= duration_s_
                   ? ""
                   : fmt::format("{}: {:.0f} of {:.0f} s simulated", name_, time_s, duration_s_));
  }
  void note(std::string_view label, const std::string& text) override {
    if (label == "recording") print_out("recording   {}\n", text);
  }
  void problem(const std::string& text) override { failures.push_back(text); }
  void summary(const scenario::RunSummary& summary) override {
    timing = summary.json;
    if (isatty(STDERR_FILENO) != 0) draw_error("");
  }

  Json events, film = Json::array(), failures = Json::array(), timing;
  recording::Columns columns{signal_names()};

 private:
  std::string_view name_;
  const config::Scenario& scenario_;
  double duration_s_;
  bool is_filmed_;
  std::uint64_t frame_cycles_;
  ConfigurationA q_a_;  ///< of the twin, now
};

}  // namespace

void play_experiment(const PaperExperiment& experiment, const ExperimentRun& arguments,
                     const std::string& command) {
  const fs::path folder = arguments.folder;
  const config::Scenario scenario = scenario::load(arguments.world);
  const double script_s = scenario::planned_duration_s(scenario);
  Collector found(experiment.name, scenario, arguments.duration_s.value_or(script_s));
  const std::atomic<bool> stop{false};  // Ctrl-C ends the program
  scenario::play(
      {.world = arguments.world,
       .timing = {.duration_s = arguments.duration_s, .is_fast = true},
       .records = {.folder = arguments.folder, .is_reproducible = true, .flight_recorder = "off"}},
      found, stop);

  Json run = describe(scenario);
  run["kind"] = experiment.name;
  run["title"] = experiment.title;
  run["source"] = experiment.source;
  run["command"] = command;
  run["version"] = kVersion;
  run["seed"] = scenario.device.simulation.seed;
  run["events"] = found.events;
  if (walks_through_door(scenario)) run["person"] = describe_walk(scenario, found.film);
  run["failures"] = found.failures;
  write_run(folder, run, found.columns);
  write_output((folder / "timing.json").string(),
               found.timing.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace hg::apps
