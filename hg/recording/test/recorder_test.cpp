// What is inside the files is checked by read_recording.py with the official reader.
#include "hg/recording/recorder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "hg/core/allocation_counter.h"
#include "hg/core/error.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/recording/test/example_run.h"

namespace hg::recording {
namespace {

constexpr double kRate_Hz = 1000.0;

class RecorderTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!recording_available()) GTEST_SKIP() << "built without Rust";
  }

  RecordingInfo info() const {
    RecordingInfo info = example_info(temporary_.path());
    info.start = std::chrono::system_clock::time_point(std::chrono::seconds(1'800'000'000));
    return info;
  }

  const TemporaryFolder temporary_;
};

/// While it lives, no file of this process can grow beyond `bytes`: a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit = {bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  void (*old_handler_)(int);
  rlimit old_{};
};

std::string refusal(const RecordingInfo& info) {
  try {
    Recorder recorder(info);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST_F(RecorderTest, WritesWhatIsPushed) {
  Recorder recorder(info());
  for (std::uint64_t cycle = 0; cycle < 3000; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
  }
  const RecordingSummary summary = recorder.close();
  EXPECT_EQ(summary.samples, 3000u);
  EXPECT_EQ(summary.dropped, 0u);
  EXPECT_EQ(summary.error, "");
  EXPECT_EQ(summary.file, temporary_.path() / "door_20270115_080000.mcap");
  EXPECT_EQ(summary.bytes, std::filesystem::file_size(summary.file));
}

TEST_F(RecorderTest, IsCalledPartialWhileItIsWritten) {
  Recorder recorder(info());
  EXPECT_EQ(temporary_.names(),
            (std::set<std::string>{"door_20270115_080000.partial.mcap", "latest.mcap"}));
  EXPECT_EQ(std::filesystem::read_symlink(temporary_.path() / "latest.mcap"),
            "door_20270115_080000.partial.mcap");
}

TEST_F(RecorderTest, IsCompletedByItsDestructor) {
  { Recorder recorder(info()); }
  EXPECT_TRUE(std::filesystem::exists(temporary_.path() / "door_20270115_080000.mcap"));
}

TEST_F(RecorderTest, CountsEverySampleThatFindsNoPlace) {
  RecordingInfo small = info();
  small.rate_Hz = 1.0;  // a ring of one sample
  Recorder recorder(small);
  const Sample sample = example_sample(0, kRate_Hz);
  constexpr std::uint64_t kPatience = 1'000'000'000;
  std::uint64_t pushed = 0;
  std::uint64_t refused = 0;
  for (; refused < 5 && pushed < kPatience; ++pushed) {
    if (!recorder.push(sample)) ++refused;
  }
  const RecordingSummary summary = recorder.close();
  EXPECT_EQ(refused, 5u);
  EXPECT_EQ(summary.dropped, refused);
  EXPECT_EQ(summary.samples, pushed - refused);
}

TEST_F(RecorderTest, DropsWhatComesAfterClosing) {
  Recorder recorder(info());
  recorder.close();
  EXPECT_FALSE(recorder.push(example_sample(0, kRate_Hz)));
  recorder.push_waiting(example_sample(0, kRate_Hz));
  const RecordingSummary summary = recorder.close();
  EXPECT_EQ(summary.samples, 0u);
  EXPECT_EQ(summary.dropped, 2u);
}

TEST_F(RecorderTest, DoesNotAllocateInPush) {
  Recorder recorder(info());
  const Sample sample = example_sample(0, kRate_Hz);
  const AllocationCounter counter;
  for (int i = 0; i < 2000; ++i) recorder.push(sample);
  EXPECT_EQ(counter.count(), 0u);
}

TEST_F(RecorderTest, DeletesTheOldestRecordingsForTheBudget) {
  temporary_.write("door_20260101_000000.mcap", 1'800'000);
  temporary_.write("door_20260102_000000.mcap", 1'800'000);
  RecordingInfo small = info();
  small.disk_budget_bytes = 4e6;
  Recorder recorder(small);
  for (std::uint64_t cycle = 0; cycle < 2000; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
  }
  // at most 700 samples wait in the ring: enough of the others are in the file already
  EXPECT_FALSE(std::filesystem::exists(temporary_.path() / "door_20260101_000000.mcap"));
  const RecordingSummary summary = recorder.close();
  EXPECT_EQ(summary.deleted, std::vector<std::string>{"door_20260101_000000.mcap"});
  EXPECT_EQ(summary.samples, 2000u);
}

TEST_F(RecorderTest, KeepsTheBudgetWhenItCloses) {
  temporary_.write("door_20260101_000000.mcap", 1'000'000);
  RecordingInfo small = info();
  small.disk_budget_bytes = 1.05e6;
  Recorder recorder(small);
  EXPECT_TRUE(std::filesystem::exists(temporary_.path() / "door_20260101_000000.mcap"));
  for (std::uint64_t cycle = 0; cycle < 200; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
  }
  EXPECT_EQ(recorder.close().deleted, std::vector<std::string>{"door_20260101_000000.mcap"});
}

TEST_F(RecorderTest, FlushesWhenNoSamplesCome) {
  Recorder recorder(info());
  const auto path = temporary_.path() / "door_20270115_080000.partial.mcap";
  const std::uintmax_t head = std::filesystem::file_size(path);
  recorder.push(example_sample(0, kRate_Hz));
  constexpr int kPatience = 3000;
  for (int i = 0; i < kPatience && std::filesystem::file_size(path) == head; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_GT(std::filesystem::file_size(path), head);
}

TEST_F(RecorderTest, DeletesAtTheStartWhatIsTooMuchAlready) {
  temporary_.write("door_20260101_000000.mcap", 2'000'000);
  RecordingInfo small = info();
  small.disk_budget_bytes = 1e6;
  Recorder recorder(small);
  EXPECT_FALSE(std::filesystem::exists(temporary_.path() / "door_20260101_000000.mcap"));
}

TEST_F(RecorderTest, EndsWithACompleteFileWhenItAloneFillsTheBudget) {
  RecordingInfo small = info();
  small.disk_budget_bytes = 1e6;
  Recorder recorder(small);
  for (std::uint64_t cycle = 0; cycle < 10'000; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
  }
  recorder.event(10.0, "late", "there is no file to write it to");
  testing::internal::CaptureStderr();
  const RecordingSummary summary = recorder.close();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(summary.error.find("disk budget of 1e+06 bytes"), std::string::npos) << summary.error;
  EXPECT_EQ(recorder.error(), summary.error);
  EXPECT_EQ(summary.file.filename(), "door_20270115_080000.mcap");
  EXPECT_EQ(summary.samples + summary.dropped, 10'000u);
  EXPECT_GT(summary.samples, 500u);
  EXPECT_GT(summary.dropped, 5000u);
  EXPECT_LT(summary.bytes, 1.5e6);
}

TEST_F(RecorderTest, OutlivesAFullDisk) {
  Recorder recorder(info());
  RecordingSummary summary;
  {
    const FileSizeLimit limit(1'000'000);
    for (std::uint64_t cycle = 0; cycle < 10'000; ++cycle) {
      recorder.push_waiting(example_sample(cycle, kRate_Hz));
    }
    summary = recorder.close();
  }
  EXPECT_NE(summary.error.find("File too large"), std::string::npos) << summary.error;
  EXPECT_EQ(recorder.error(), summary.error);
  EXPECT_EQ(summary.file.filename(), "door_20270115_080000.partial.mcap");
  EXPECT_EQ(summary.samples + summary.dropped, 10'000u);
  EXPECT_GT(summary.samples, 0u);
  EXPECT_LT(summary.samples, 2000u);  // about 760 bytes each
  EXPECT_LE(std::filesystem::file_size(summary.file), 1'000'000u);
}

// what a run reports when `harm` is done to its file in the middle
RecordingSummary harmed(const RecordingInfo& info, bool pauses,
                        const std::function<void(const std::filesystem::path&)>& harm) {
  Recorder recorder(info);
  const auto path = info.folder / "door_20270115_080000.partial.mcap";
  const std::uintmax_t head = std::filesystem::file_size(path);
  for (std::uint64_t cycle = 0; cycle < 1000; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
  }
  constexpr int kPatience = 3000;
  for (int i = 0; i < kPatience && std::filesystem::file_size(path) == head; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  harm(path);
  for (int i = 0; pauses && i < kPatience && recorder.error().empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_TRUE(!pauses || !recorder.error().empty()) << "while no samples come";
  for (std::uint64_t cycle = 1000; cycle < 3000; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
  }
  return recorder.close();
}

TEST_F(RecorderTest, AFileThatIsDeletedMovedReplacedOrChangedIsLost) {
  namespace fs = std::filesystem;
  const std::vector<std::function<void(const fs::path&)>> gone = {
      [](const fs::path& file) { fs::remove(file); },
      [](const fs::path& file) { fs::rename(file, file.string() + ".moved"); },
      [](const fs::path& file) {
        fs::remove(file);
        std::ofstream(file) << "another";
      }};
  for (const bool pauses : {false, true}) {
    for (const auto& harm : gone) {
      const RecordingSummary summary = harmed(info(), pauses, harm);
      EXPECT_EQ(summary.error, "the file was deleted, moved or replaced");
      EXPECT_EQ(summary.file, "");
      EXPECT_EQ(summary.samples, 0u);
      EXPECT_EQ(summary.dropped, 3000u);
      for (const auto& entry : fs::directory_iterator(temporary_.path())) fs::remove(entry);
    }
    for (const std::uintmax_t bytes : {0U, 5000U}) {
      const RecordingSummary summary =
          harmed(info(), pauses, [=](const fs::path& file) { fs::resize_file(file, bytes); });
      EXPECT_TRUE(summary.error.starts_with("the file was changed: it had ")) << summary.error;
      EXPECT_EQ(summary.file.filename(), "door_20270115_080000.partial.mcap");
      EXPECT_EQ(fs::file_size(summary.file), bytes);  // no hole behind it
      EXPECT_EQ(summary.samples, 0u);
      EXPECT_EQ(summary.dropped, 3000u);
      for (const auto& entry : fs::directory_iterator(temporary_.path())) fs::remove(entry);
    }
  }
}

TEST_F(RecorderTest, ReportsAtOnceThatTheDiskIsFull) {
  std::string message;
  {
    const FileSizeLimit limit(0);
    message = refusal(info());
  }
  const std::string file = (temporary_.path() / "door_20270115_080000.partial.mcap").string();
  EXPECT_NE(message.find(file), std::string::npos) << message;
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_TRUE(temporary_.names().empty());
}

TEST_F(RecorderTest, ReportsWhichFolderCannotBeWritten) {
  RecordingInfo bad = info();
  temporary_.write("file", 1);
  bad.folder = temporary_.path() / "file";
  const std::string message = refusal(bad);
  EXPECT_NE(message.find(bad.folder.string()), std::string::npos) << message;
}

TEST_F(RecorderTest, RefusesARateOrBudgetThatIsNotPositive) {
  RecordingInfo bad = info();
  bad.rate_Hz = 0.0;
  EXPECT_EQ(refusal(bad), "recording rate_Hz: must be positive, got 0");
  bad = info();
  bad.disk_budget_bytes = -1.0;
  EXPECT_EQ(refusal(bad), "recording disk_budget_bytes: must be positive, got -1");
}

TEST(Recording, WithoutRustIsRefusedWithAReason) {
  if (recording_available()) GTEST_SKIP() << "built with Rust";
  EXPECT_NE(refusal(RecordingInfo{}).find("built without Rust"), std::string::npos);
}

}  // namespace
}  // namespace hg::recording
