#include "hg/recording/flight_recorder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/messages/cdr_reader.h"
#include "hg/recording/recording_reader.h"
#include "hg/recording/test/example_run.h"

namespace hg::recording {
namespace {

constexpr double kRate_Hz = 1000.0;

class FlightRecorderTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!recording_available()) GTEST_SKIP() << "built without Rust";
  }
  // pushes samples first .. last - 1
  static void push(FlightRecorder& recorder, std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t cycle = first; cycle < last; ++cycle) {
      recorder.push(example_sample(cycle, kRate_Hz));
    }
  }

  const TemporaryFolder temporary_;
};

TEST_F(FlightRecorderTest, WritesTheLastSecondsAtFullRateWithTheirEvents) {
  FlightRecorder recorder(example_info(temporary_.path()), 0.5);
  recorder.event(0.1, "early", "too early");
  push(recorder, 0, 1234);
  recorder.event(1.2, "fault", "302 tracking lost");
  recorder.write("fault302");
  const FlightRecorder::Result result = recorder.close();
  EXPECT_EQ(result.error, "");
  ASSERT_EQ(result.files.size(), 1u);
  EXPECT_TRUE(result.files[0].filename().string().starts_with("door_fault302_")) << result.files[0];

  const RecordedRun run(result.files[0], 0.0);
  ASSERT_EQ(run.size(), 500u);
  auto sample = std::make_unique<Sample>();
  for (std::size_t i = 0; i < run.size(); ++i) {
    run.read(i, *sample);
    const Sample expected = example_sample(734 + i, kRate_Hz);
    ASSERT_EQ(sample->record.cycle, 734 + i);
    ASSERT_EQ(sample->sensors.w_S, expected.sensors.w_S);
    ASSERT_EQ(sample->record.state_hash, expected.record.state_hash);
  }
  ASSERT_EQ(run.events().size(), 1u);
  EXPECT_EQ(run.events()[0].name, "fault");
  EXPECT_EQ(run.configuration().size(), 2u);
}

// The clocks of the lab in a file.
struct LabClocks final : MessageListener {
  std::vector<double> times_s, offsets_s;

  void configuration(const NamedText&) override {}
  void metadata(const std::string&, const KeyValues&) override {}
  void topic(const Topic&) override {}
  void message(std::string_view topic, std::uint64_t, std::span<const std::byte> bytes) override {
    LabClock clock;
    if (topic != "/hapticgiant/lab_clock") return;
    EXPECT_TRUE(messages::CdrReader(bytes).decode(clock));
    times_s.push_back(clock.time_s);
    offsets_s.push_back(clock.offset_s);
  }
};

TEST_F(FlightRecorderTest, KeepsTheLabClockThatIsOlderThanItsSamples) {
  FlightRecorder recorder(example_info(temporary_.path()), 0.5);
  recorder.lab_clock({.time_s = 0.1, .offset_s = 1111.0});
  recorder.lab_clock({.time_s = 0.2, .offset_s = 1234.5});
  push(recorder, 0, 1234);
  recorder.write("stop");
  const FlightRecorder::Result result = recorder.close();
  ASSERT_EQ(result.files.size(), 1u);
  LabClocks found;
  (void)read_messages(result.files[0], found);
  EXPECT_EQ(found.offsets_s, std::vector<double>{1234.5});
  EXPECT_GT(found.times_s.at(0), 0.7);  // that of the first sample
}

TEST_F(FlightRecorderTest, RestartsAfterItHasWritten) {
  FlightRecorder recorder(example_info(temporary_.path()), 0.5);
  push(recorder, 0, 100);
  recorder.write("one");
  ASSERT_EQ(recorder.close().files.size(), 1u);
  push(recorder, 100, 150);
  recorder.write("two");
  const FlightRecorder::Result result = recorder.close();
  ASSERT_EQ(result.files.size(), 2u);
  EXPECT_EQ(RecordedRun(result.files[0], 0.0).size(), 100u);
  EXPECT_EQ(RecordedRun(result.files[1], 0.0).size(), 50u);
}

TEST_F(FlightRecorderTest, WritesNothingOfNothingAndReportsWhyItCannotWrite) {
  RecordingInfo info = example_info(temporary_.path());
  FlightRecorder empty(info, 0.5);
  empty.write("nothing");
  EXPECT_TRUE(empty.close().files.empty());
  EXPECT_THROW(FlightRecorder(info, 0.0), SetupError);
}

/// While it lives, temporary files go elsewhere.
class TemporaryFiles {
 public:
  explicit TemporaryFiles(const std::filesystem::path& folder) {
    if (const char* old = std::getenv("TMPDIR")) old_ = old;
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryFiles() { old_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", old_.c_str(), 1); }
  TemporaryFiles(const TemporaryFiles&) = delete;
  TemporaryFiles& operator=(const TemporaryFiles&) = delete;

 private:
  std::string old_;
};

TEST_F(FlightRecorderTest, WritesAmongTheTemporaryFilesWhenItsFolderIsGone) {
  RecordingInfo info = example_info(temporary_.path());
  info.folder = temporary_.write("file", "no folder");
  FlightRecorder recorder(info, 0.5);
  push(recorder, 0, 10);
  {
    const TemporaryFiles nowhere(temporary_.path() / "nowhere");
    recorder.write("fault");
    const FlightRecorder::Result result = recorder.close();
    EXPECT_TRUE(result.files.empty());
    EXPECT_NE(result.error, "");
  }
  const TemporaryFiles elsewhere(temporary_.path());
  recorder.write("fault");  // it has kept them
  const FlightRecorder::Result result = recorder.close();
  ASSERT_EQ(result.files.size(), 1u);
  EXPECT_EQ(result.files[0].parent_path().parent_path(), temporary_.path());
  EXPECT_EQ(RecordedRun(result.files[0], 0.0).size(), 10u);
}

}  // namespace
}  // namespace hg::recording
