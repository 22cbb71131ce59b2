#include "hg/scenario/run/run_player.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hg/core/open_file.h"
#include "hg/core/test/message_of.h"
#include "hg/recording/recorder.h"
#include "hg/scenario/run/connection.h"

namespace hg::scenario {
namespace {

using Json = nlohmann::ordered_json;

/// Keeps what a run reports, in order.
class Log final : public RunObserver {
 public:
  void phase(RunPhase phase, double, const std::string&) override {
    add("phase " + std::string(to_string(phase)));
    if (phase == RunPhase::kRunning && at_running) at_running();
  }
  void sample(const Sample& sample) override {
    EXPECT_EQ(sample.record.cycle, samples++);
    time_s = sample.record.time_s;
  }
  void event(double at_s, std::string_view name, std::string_view) override {
    EXPECT_EQ(at_s, time_s) << name;  // after its sample
    add("event " + std::string(name));
  }
  void status(const Sample& sample, const config::Scenario&) override {
    if (stop_at_s >= 0.0 && sample.record.time_s >= stop_at_s) stop = true;
  }
  void problem(const std::string& text) override { add("problem " + text); }
  void fault(const RunFault& fault) override {
    add("fault " + std::string(to_string(fault.fault.code)));
  }
  void summary(const RunSummary& summary) override {
    add("summary");
    json = summary.json;
    closing_lines = summary.text;
  }

  std::ptrdiff_t place(const std::string& line) const {
    return std::ranges::find(lines, line) - lines.begin();
  }
  bool has(const std::string& line) const { return std::ranges::find(lines, line) != lines.end(); }

  std::vector<std::string> lines;
  Json json;
  std::string closing_lines;
  std::uint64_t samples = 0;
  double time_s = -1.0;     ///< of the last sample
  double stop_at_s = -1.0;  ///< sets `stop` then; negative = never
  std::atomic<bool> stop{false};
  std::function<void()> at_running;

 private:
  void add(std::string line) { lines.push_back(std::move(line)); }
};

class RunPlayerTest : public ::testing::Test {
 protected:
  RunPlayerTest() {
    folder_ = std::filesystem::temp_directory_path() / ("run_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    plan_.timing.is_fast = true;
    plan_.records.folder = folder_.string();
    plan_.records.flight_recorder = "off";
    plan_.records.has_recording = false;
  }
  ~RunPlayerTest() override { std::filesystem::remove_all(folder_); }

  // the scenario `name` with these lines at its end
  std::string scenario_with(const std::string& name, const std::string& lines) const {
    std::string text = read_file("models/scenarios/" + name + ".yaml");
    const std::string models = (std::filesystem::current_path() / "models").string();
    for (std::size_t at = 0; (at = text.find(": ../", at)) != std::string::npos;) {
      text.replace(at, 5, ": " + models + "/");
    }
    const std::filesystem::path file = folder_ / (name + ".yaml");
    std::ofstream(file) << text << lines;
    return file.string();
  }

  std::filesystem::path folder_;
  RunPlan plan_;
  Log log_;
};

TEST_F(RunPlayerTest, AWholeRunReportsItsPhasesInOrderAndEndsWithZero) {
  const RunOutcome outcome = play(plan_, log_, log_.stop);
  EXPECT_EQ(outcome.exit_code, 0) << log_.closing_lines;
  EXPECT_EQ(outcome.fault, FaultCode::kNone);
  const std::vector<std::string> order = {"phase ready",  "phase armed",    "phase running",
                                          "event locked", "phase stopping", "phase over",
                                          "summary"};
  EXPECT_TRUE(
      std::ranges::is_sorted(order, {}, [&](const auto& line) { return log_.place(line); }));
  for (const std::string& line : order) EXPECT_TRUE(log_.has(line)) << line;
  EXPECT_EQ(log_.lines.back(), "summary");
  EXPECT_EQ(Json::parse(outcome.summary), log_.json);
  EXPECT_EQ(log_.samples, log_.json["cycles"]);
  EXPECT_FALSE(log_.json["interrupted"]);
  EXPECT_EQ(outcome.recording, "");
}

TEST_F(RunPlayerTest, TheSamePlanGivesTheSameState) {
  plan_.timing.duration_s = 2.0;
  Log other;
  play(plan_, log_, log_.stop);
  play(plan_, other, other.stop);
  EXPECT_EQ(log_.json["state_hash"], other.json["state_hash"]);
  EXPECT_EQ(log_.lines, other.lines);
}

TEST_F(RunPlayerTest, AReproducibleRecordingHasTheSameBytesAndReplacesTheLast) {
  if (!recording::recording_available()) GTEST_SKIP();
  plan_.timing.duration_s = 1.0;
  plan_.records.has_recording = plan_.records.is_reproducible = true;
  std::vector<std::string> texts;
  for (int i = 0; i < 2; ++i) {
    const RunOutcome outcome = play(plan_, *std::make_unique<Log>(), log_.stop);
    EXPECT_EQ(outcome.recording, folder_ / "recording.mcap");
    texts.push_back(read_file(outcome.recording));
    std::ofstream(folder_ / "recording.partial.mcap") << "of a run that was killed";
  }
  EXPECT_EQ(texts[0], texts[1]);
  EXPECT_GT(texts[0].size(), 1000U);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "latest.mcap"));
}

TEST_F(RunPlayerTest, EveryObserverSeesEverySample) {
  plan_.timing.duration_s = 0.5;
  Log other;
  RunObservers both({&log_, &other});
  play(plan_, both, log_.stop);
  EXPECT_GT(log_.samples, 0U);
  EXPECT_EQ(log_.samples, other.samples);
}

TEST_F(RunPlayerTest, AnEventThatIsMissingEndsWithOne) {
  plan_.timing.duration_s = 1.0;
  EXPECT_EQ(play(plan_, log_, log_.stop).exit_code, 1);
}

TEST_F(RunPlayerTest, AFaultEndsWithThree) {
  plan_.world.scenario =
      scenario_with("free_space", "faults:\n  - {at_s: 1.0, fault: emergency_stop}\n");
  plan_.timing.duration_s = 3.0;
  const RunOutcome outcome = play(plan_, log_, log_.stop);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.fault, FaultCode::kEmergencyStop);
  EXPECT_TRUE(log_.has("fault emergency stop"));
}

/// From now on no file of this program grows.
class FullDisk {
 public:
  FullDisk() {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }
  void begin() const {
    const rlimit none = {.rlim_cur = 1, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &none);
  }

 private:
  rlimit before_{};
};

TEST_F(RunPlayerTest, ARecordingThatIsIncompleteEndsWithFour) {
  if (!recording::recording_available()) GTEST_SKIP();
  plan_.world.scenario = "free_space";
  plan_.records.has_recording = true;
  plan_.timing.duration_s = 600.0;
  log_.stop_at_s = 3.0;
  const FullDisk disk;
  log_.at_running = [&] { disk.begin(); };
  const RunOutcome outcome = play(plan_, log_, log_.stop);
  EXPECT_EQ(outcome.exit_code, kRecordingIncomplete) << log_.closing_lines;
  EXPECT_TRUE(std::ranges::any_of(log_.lines, [](const std::string& line) {
    return line.starts_with("problem recording ended early");
  }));
}

TEST_F(RunPlayerTest, TheStopFlagEndsARunInOrderWithItsRecording) {
  plan_.records.has_recording = recording::recording_available();
  plan_.timing.duration_s = 600.0;
  log_.stop_at_s = 1.0;
  const RunOutcome outcome = play(plan_, log_, log_.stop);
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(log_.json["interrupted"]);
  EXPECT_TRUE(log_.has("phase over"));
  if (plan_.records.has_recording) {
    EXPECT_TRUE(outcome.recording.string().ends_with(".mcap"));
    EXPECT_FALSE(outcome.recording.string().ends_with(".partial.mcap"));
    EXPECT_TRUE(std::filesystem::exists(outcome.recording));
  }
}

TEST_F(RunPlayerTest, BadInputIsRefusedBeforeAnythingHappens) {
  const auto refusal = [&](const RunPlan& plan) {
    return message_of([&] { const RunPlayer player(plan); });
  };
  RunPlan plan = plan_;
  plan.world.scenario = "dor";
  EXPECT_NE(refusal(plan).find("did you mean 'door'?"), std::string::npos);
  plan = plan_;
  plan.records.slow_solve = 0;
  EXPECT_EQ(refusal(plan), "--slow-solve: must be at least 1, got 0");
  plan = plan_;
  plan.world.user = "mouse";
  EXPECT_EQ(message_of([&] { play(plan, log_, log_.stop); }),
            "run: --fast without a script needs --duration S");
  EXPECT_TRUE(log_.lines.empty());
}

// Refused before anything is connected.
TEST_F(RunPlayerTest, ATransportRefusesWhatItsDevicesDoNotHave) {
  config::Scenario scenario = load({.scenario = "free_space"});
  const auto refusal = [&](const std::string& address, bool is_fast, const std::string& key) {
    const MachineAddress machine = {.address = address, .key_file = key};
    const RunTiming timing = {.is_fast = is_fast};
    return message_of([&] { connect_to_run(machine, timing, folder_.string(), scenario); });
  };
  EXPECT_EQ(refusal("franka://127.0.0.1:1", true, ""),
            "--fast: a Franka keeps its own time, leave it out");
  EXPECT_EQ(refusal("franka://127.0.0.1:1", false, "key"),
            "--key-file: a Franka's protocol has no key");
  EXPECT_EQ(refusal("ethercat://nowhere", false, "key"), "--key-file: a bus has no key");
}

TEST_F(RunPlayerTest, OnlyAFrankaMovesToTheStartByItself) {
  const auto moves = [](const std::string& address) {
    return moves_by_law({.address = address, .moves_to_start = true});
  };
  EXPECT_TRUE(moves("127.0.0.1:4810"));
  EXPECT_TRUE(moves("ethercat://eth0"));
  EXPECT_FALSE(moves("franka://127.0.0.1"));
  EXPECT_FALSE(moves_by_law({.address = "127.0.0.1:4810"}));
}

}  // namespace
}  // namespace hg::scenario
