#include "hg/recording/recording_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/recording/mcap_file.h"
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
  EXPECT_TRUE(read_recording(file, counts).is_whole());
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
  ASSERT_TRUE(read_recording(file, whole).is_whole());
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
      const ReadResult result = read_recording(part, counts);
      EXPECT_TRUE(result.losses.empty()) << cut << " of " << size << ": " << to_text(result.losses);
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

/// Samples with and without gaps.
struct Gaps final : RecordingListener {
  void configuration(const NamedText&) override { ++configurations; }
  void event(const Event&) override { ++events; }
  void sample(const Sample& sample) override {
    if (sample.record.cycle < next) is_in_order = false;
    if (sample.record.cycle > next) missing.push_back({next, sample.record.cycle});
    next = sample.record.cycle + 1;
    ++samples;
  }
  // after the last sample
  void end(std::uint64_t count) {
    if (next < count) missing.push_back({next, count});
  }
  std::uint64_t samples = 0, next = 0, events = 0, configurations = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> missing;
  bool is_in_order = true;
};

/// A file of `samples` samples with one bit flipped: all but what it hits is there, and named is
/// what is not. True: samples are lost.
bool check_flipped(const std::filesystem::path& file, std::uint64_t samples) {
  Gaps gaps;
  ReadResult result;
  try {
    result = read_recording(file, gaps);
  } catch (const SetupError& error) {
    ADD_FAILURE() << error.what();
    return false;
  }
  gaps.end(samples);
  const std::string losses = to_text(result.losses);
  EXPECT_TRUE(gaps.is_in_order);
  EXPECT_TRUE(result.is_complete);
  EXPECT_LE(result.losses.size(), 1u) << losses;
  const bool has_losses = !result.losses.empty() && result.losses[0].samples > 0;
  EXPECT_EQ(gaps.missing.size(), has_losses ? 1u : 0u) << losses;
  if (gaps.missing.size() != 1 || !has_losses) return false;
  const auto [first, end] = gaps.missing[0];
  const Loss& loss = result.losses[0];
  EXPECT_LE(loss.samples, 250u);  // a chunk
  EXPECT_EQ(loss.samples, end - first);
  EXPECT_NEAR(loss.from_s, static_cast<double>(first) / kRate_Hz, 1e-9);
  EXPECT_NEAR(loss.to_s, static_cast<double>(end - 1) / kRate_Hz, 1e-9);
  return true;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

// --gtest_random_seed says which bits
std::mt19937 seeded_by_the_command_line() {
  return std::mt19937(static_cast<unsigned>(GTEST_FLAG_GET(random_seed)));
}

TEST_F(RecordedRunTest, AFlippedBitCostsOneChunkAtMostAndIsNamed) {
  const std::string good = content_of(record(3000));
  std::mt19937 random = seeded_by_the_command_line();
  int with_losses = 0;
  for (int i = 0; i < 200; ++i) {
    const std::size_t bit = random() % (8 * good.size());
    SCOPED_TRACE("bit " + std::to_string(bit) + " of " + std::to_string(8 * good.size()));
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
    with_losses += check_flipped(temporary_.write("bad.mcap", bad), 3000);
  }
  EXPECT_GT(with_losses, 100);
}

// opcodes and lengths, which say where everything is
TEST_F(RecordedRunTest, AFlippedBitInAnyHeadOfARecordCostsNoMore) {
  constexpr std::size_t kMagic = 8;
  constexpr std::size_t kHead = 9;
  const std::string good = content_of(record(600));
  std::mt19937 random = seeded_by_the_command_line();
  for (std::size_t at = kMagic; at + kMagic < good.size();) {
    for (int i = 0; i < 3; ++i) {
      const std::size_t bit = 8 * at + random() % (8 * kHead);
      SCOPED_TRACE("bit " + std::to_string(bit - 8 * at) + " of the record at " +
                   std::to_string(at));
      std::string bad = good;
      bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
      check_flipped(temporary_.write("bad.mcap", bad), 600);
    }
    std::uint64_t length = 0;
    std::memcpy(&length, &good[at + 1], sizeof(length));
    at += kHead + length;
  }
}

// as after a bad sector or a file system that has lost a block; it may cover the index of a chunk
TEST_F(RecordedRunTest, ABlockOfZerosOrOnesCostsTheChunksThatItTouches) {
  constexpr std::size_t kBlock = 4096;
  const std::string good = content_of(record(3000));
  const std::size_t begin = good.find("--law paper") + kBlock;  // behind the attachments
  std::mt19937 random = seeded_by_the_command_line();
  for (int i = 0; i < 60; ++i) {
    const std::size_t at = begin + random() % (good.size() * 8 / 10 - begin);
    SCOPED_TRACE("block at " + std::to_string(at));
    std::string bad = good;
    std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(at), kBlock, i % 2 == 0 ? '\0' : '\xff');
    const std::filesystem::path file = temporary_.write("bad.mcap", bad);
    Gaps gaps;
    const ReadResult result = read_recording(file, gaps);
    gaps.end(3000);
    const auto samples_of = [](const std::vector<Loss>& losses) {
      std::uint64_t samples = 0;
      for (const Loss& loss : losses) samples += loss.samples;
      return samples;
    };
    const std::uint64_t lost = samples_of(result.losses);
    EXPECT_EQ(samples_of(RecordedRun(file, 0.01).losses()), lost);
    if (!result.losses.empty() && !result.losses.front().is_counted) {
      EXPECT_EQ(gaps.missing.front().first, 0u);  // there is no sample before
      continue;
    }
    EXPECT_EQ(gaps.samples + lost, 3000u) << to_text(result.losses);
    EXPECT_LE(lost, 500u) << to_text(result.losses);
    if (gaps.missing.empty()) continue;  // only the index of a chunk
    EXPECT_NEAR(result.losses.front().from_s,
                static_cast<double>(gaps.missing.front().first) / kRate_Hz, 1e-6);
    EXPECT_NEAR(result.losses.back().to_s,
                static_cast<double>(gaps.missing.back().second - 1) / kRate_Hz, 1e-6);
  }
}

// as where a file was cut off while it was written, or a loss of power has taken its end
TEST_F(RecordedRunTest, AHoleIsReportedWhereverItIs) {
  const std::string good = content_of(record(3000));
  struct Case {
    double from, to;
    bool is_counted, is_complete;
  };
  for (const Case& hole :
       {Case{0.0, 0.4, false, true}, Case{0.4, 0.7, true, true}, Case{0.4, 1.0, false, false}}) {
    SCOPED_TRACE(hole.from);
    std::string bad = good;
    const auto place = [&](double part) {
      return bad.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(bad.size()));
    };
    std::fill(place(hole.from), place(hole.to), '\0');
    Gaps gaps;
    const ReadResult result = read_recording(temporary_.write("bad.mcap", bad), gaps);
    gaps.end(3000);
    EXPECT_EQ(result.is_complete, hole.is_complete);
    ASSERT_FALSE(result.losses.empty());
    std::uint64_t lost = 0;
    for (const Loss& loss : result.losses) lost += loss.samples;
    EXPECT_EQ(result.losses.back().is_counted, hole.is_counted) << to_text(result.losses);
    EXPECT_EQ(gaps.samples + lost == 3000u, hole.is_counted);
    EXPECT_GT(gaps.samples, 500u);
    EXPECT_LT(gaps.samples, 2500u);
  }
}

TEST_F(RecordedRunTest, AnEndlessHoleIsSkipped) {
  const std::filesystem::path file = record(600);
  std::error_code error;
  std::filesystem::resize_file(file, 4'000'000'000'000U, error);
  if (error) GTEST_SKIP() << "no files with holes here: " << error.message();
  Gaps gaps;
  const ReadResult result = read_recording(file, gaps);
  EXPECT_EQ(gaps.samples, 600u);
  EXPECT_EQ(result.losses.size(), 1u);
}

TEST_F(RecordedRunTest, NamesAConfigurationThatIsDamaged) {
  const std::filesystem::path file = record(100);
  std::string text = content_of(file);
  text[text.find("title: Door")] ^= 1;
  const std::filesystem::path bad = temporary_.write("bad.mcap", text);
  Gaps gaps;
  const ReadResult result = read_recording(bad, gaps);
  EXPECT_EQ(to_text(result.losses), "DAMAGED     attachment door.yaml: no sample is lost\n");
  EXPECT_EQ(gaps.samples, 100u);
  EXPECT_EQ(gaps.configurations, 1u);  // the other one
  EXPECT_EQ(RecordedRun(bad, 0.01).losses().size(), 1u);
}

TEST_F(RecordedRunTest, RefusesOtherFilesAndNamesThem) {
  EXPECT_NE(refusal(temporary_.write("text.mcap", "hello")).find("text.mcap: must be a recording"),
            std::string::npos);
  EXPECT_NE(refusal(temporary_.path() / "nowhere.mcap"), "");
  EXPECT_NE(refusal(record(0)).find("no sample"), std::string::npos);
}

TEST_F(RecordedRunTest, RefusesSamplesOfTwoRuns) {
  const auto refusal_of = [this](std::uint64_t cycles, double later_s) {
    Recorder recorder(example_info(temporary_.path()));
    for (std::uint64_t cycle = 0; cycle < 100; ++cycle) {
      recorder.push_waiting(example_sample(cycle, kRate_Hz));
    }
    for (std::uint64_t cycle = 0; cycle < cycles; ++cycle) {
      Sample sample = example_sample(cycle, kRate_Hz);
      sample.record.time_s += later_s;
      recorder.push_waiting(sample);
    }
    return refusal(recorder.close().file);
  };
  EXPECT_NE(refusal_of(50, 0.0).find("sample 100 is not later than the one before"),
            std::string::npos);
  EXPECT_EQ(refusal_of(50, 0.1), "");
}

// its chunks cannot be read, as of one that is packed in another way; the index names its topics
TEST_F(RecordedRunTest, OfAnotherToolIsNotCalledDamaged) {
  const std::filesystem::path path = temporary_.path() / "other.mcap";
  McapFile other(path);
  const std::uint16_t pose = other.add_channel("/pose", "a/msg/Pose", "float64 x");
  other.write(pose, 0, 1, std::array<std::byte, 64>{});
  other.finish();
  std::string bytes = content_of(path);
  const std::size_t packed = bytes.find("zstd");
  ASSERT_NE(packed, std::string::npos);
  bytes[packed + 16] ^= 0x5a;
  EXPECT_NE(
      refusal(temporary_.write("bad.mcap", bytes)).find("it has no topic /hapticgiant/sample"),
      std::string::npos);
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

TEST(Playback, MovesWithItsSpeedUntilTheEndAndRestarts) {
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
