#include "hg/recording/recording_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/recording/playback.h"
#include "hg/recording/test/example_run.h"

namespace hg::recording {
namespace {

constexpr double kRate_Hz = 1000.0;

class RecordedRunTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!recording_available()) GTEST_SKIP() << "built without Rust";
  }

  // A recording with samples 0 .. count - 1 and one event.
  std::filesystem::path record(std::uint64_t count) const {
    RecordingInfo info = example_info(temporary_.path());
    info.configuration = {{"door.yaml", "title: Door"}, {"arguments", "--law paper\n"}};
    Recorder recorder(info);
    for (std::uint64_t cycle = 0; cycle < count; ++cycle) {
      recorder.push_waiting(example_sample(cycle, kRate_Hz));
    }
    recorder.event(0.5, "unlocked", "the lever is pressed");
    return recorder.close().file;
  }

  std::string refusal(const std::filesystem::path& file) const {
    try {
      RecordedRun run(file, 0.01);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "";
  }

  const TemporaryFolder temporary_;
};

TEST_F(RecordedRunTest, GivesBackOneSamplePerPeriodTheLastOneEventsAndConfiguration) {
  const RecordedRun run(record(1005), 0.01);
  ASSERT_EQ(run.size(), 102u);  // 0, 10, ... 1000, and 1004
  EXPECT_NEAR(run.duration_s(), 1.004, 1e-9);
  auto sample = std::make_unique<Sample>();
  for (const std::uint64_t index : {std::uint64_t{0}, std::uint64_t{7}, std::uint64_t{101}}) {
    const std::uint64_t cycle = index == 101 ? 1004 : 10 * index;
    run.read(index, *sample);
    const Sample expected = example_sample(cycle, kRate_Hz);
    EXPECT_EQ(sample->record.cycle, cycle);
    EXPECT_EQ(sample->record.time_s, expected.record.time_s);
    EXPECT_EQ(sample->sensors.w_S, expected.sensors.w_S);
    EXPECT_EQ(sample->cycle_time_us, expected.cycle_time_us);
  }
  ASSERT_EQ(run.events().size(), 1u);
  EXPECT_EQ(run.events()[0].name, "unlocked");
  EXPECT_EQ(run.events()[0].text, "the lever is pressed");
  EXPECT_EQ(run.events()[0].time_s, 0.5);
  ASSERT_EQ(run.configuration().size(), 2u);
  EXPECT_EQ(run.configuration()[1].text, "--law paper\n");
}

TEST_F(RecordedRunTest, FindsTheSampleBeforeATime) {
  const RecordedRun run(record(1000), 0.01);
  EXPECT_EQ(run.at(-1.0), 0u);
  EXPECT_EQ(run.at(std::nan("")), 0u);
  for (std::size_t i = 0; i < run.size(); ++i) {
    EXPECT_EQ(run.at(run.time_s(i)), i);
    EXPECT_EQ(run.at(run.time_s(i) - 1e-6), i == 0 ? 0 : i - 1);
  }
  EXPECT_EQ(run.at(1e9), run.size() - 1);
}

TEST_F(RecordedRunTest, ReadsAFileThatACrashHasCutOff) {
  const std::filesystem::path file = record(3000);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
  const RecordedRun run(file, 0.01);
  EXPECT_GT(run.duration_s(), 0.5);
  EXPECT_LT(run.duration_s(), 2.999);
}

struct Counts final : RecordingListener {
  void configuration(const NamedText& text) override {
    EXPECT_EQ(samples, 0u);
    names.push_back(text.name);
  }
  void event(const Event& event) override { events.push_back(event.name); }
  void sample(const Sample& sample) override {
    EXPECT_EQ(sample.record.cycle, samples);
    ++samples;
    if (samples == throws_at) throw std::runtime_error("enough");
  }
  std::uint64_t samples = 0, throws_at = 0;
  std::vector<std::string> names, events;
};

TEST_F(RecordedRunTest, IsHandedOutWholeAndInOrder) {
  const std::filesystem::path file = record(1005);
  Counts counts;
  EXPECT_TRUE(read_recording(file, counts));
  EXPECT_EQ(counts.samples, 1005u);
  EXPECT_EQ(counts.names, (std::vector<std::string>{"door.yaml", "arguments"}));
  EXPECT_EQ(counts.events, std::vector<std::string>{"unlocked"});
  Counts impatient;
  impatient.throws_at = 10;
  EXPECT_THROW(read_recording(file, impatient), std::runtime_error);
  EXPECT_EQ(impatient.samples, 10u);
}

// wherever a crash cuts it: everything before is there, in whole samples
TEST_F(RecordedRunTest, IsReadableWhereverItIsCutOff) {
  const std::filesystem::path file = record(3000);
  const auto size = std::filesystem::file_size(file);
  Counts whole;
  ASSERT_TRUE(read_recording(file, whole));
  std::uint64_t last = 0;
  std::uint64_t readable = 0;
  std::mt19937 random(7);
  std::vector<std::uintmax_t> cuts;
  for (int i = 0; i < 60; ++i) cuts.push_back(1 + random() % (size - 1));
  std::sort(cuts.begin(), cuts.end());
  std::ifstream stream(file, std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  for (const std::uintmax_t cut : cuts) {
    const auto part = temporary_.write("cut.mcap", good.substr(0, cut));
    Counts counts;
    try {
      read_recording(part, counts);
      ++readable;
    } catch (const SetupError& error) {
      // only before the first chunk is whole
      EXPECT_EQ(counts.samples, 0u) << cut << " of " << size << ": " << error.what();
    }
    EXPECT_GE(counts.samples, last) << cut << " of " << size;
    last = counts.samples;
  }
  EXPECT_GT(readable, 30u);
}

TEST_F(RecordedRunTest, RefusesWhatIsNoRecordingAndSaysWhich) {
  EXPECT_NE(refusal(temporary_.write("text.mcap", "hello")).find("text.mcap: must be a recording"),
            std::string::npos);
  EXPECT_NE(refusal(temporary_.path() / "nowhere.mcap"), "");
  EXPECT_NE(refusal(record(0)).find("no sample"), std::string::npos);
}

TEST_F(RecordedRunTest, NeverCrashesOnDamagedFiles) {
  const std::filesystem::path file = record(50);
  std::ifstream stream(file, std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  for (std::size_t i = 0; i < good.size(); i += 1 + good.size() / 400) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x5a);
    try {
      const RecordedRun run(temporary_.write("bad.mcap", bad), 0.01);
      auto sample = std::make_unique<Sample>();
      for (std::size_t k = 0; k < run.size(); ++k) run.read(k, *sample);
    } catch (const SetupError&) {
    }
  }
}

TEST(Playback, MovesWithItsSpeedUntilTheEndAndBeginsAnew) {
  Playback playback(10.0);
  ASSERT_TRUE(playback.set_speed(4.0));
  playback.advance(1.0);
  EXPECT_EQ(playback.position_s(), 4.0);
  playback.pause();
  playback.advance(1.0);
  EXPECT_EQ(playback.position_s(), 4.0);
  playback.move(-5.0);
  EXPECT_EQ(playback.position_s(), 0.0);
  playback.resume();
  playback.advance(100.0);
  EXPECT_TRUE(playback.is_over());
  EXPECT_EQ(playback.position_s(), 10.0);
  playback.resume();
  EXPECT_EQ(playback.position_s(), 0.0);
}

TEST(Playback, RefusesTimesAndSpeedsOutOfRange) {
  Playback playback(10.0);
  for (const double time_s : {-0.1, 10.1, std::nan("")}) EXPECT_FALSE(playback.seek(time_s));
  for (const double speed : {0.09, 8.1, 0.0, -1.0, std::nan("")}) {
    EXPECT_FALSE(playback.set_speed(speed));
  }
  EXPECT_EQ(playback.position_s(), 0.0);
  EXPECT_EQ(playback.speed(), 1.0);
  EXPECT_TRUE(playback.seek(10.0));
}

}  // namespace
}  // namespace hg::recording
