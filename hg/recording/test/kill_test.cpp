// A program that is killed at any moment leaves a recording that ends at most a second before.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <random>
#include <thread>

#include "hg/core/test/temporary_folder.h"
#include "hg/recording/recording_reader.h"
#include "hg/recording/test/example_run.h"

namespace hg::recording {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_Hz = 1000.0;
constexpr int kKills = 12;
constexpr double kMostLost_s = 1.0;  // docs/reference/recording.md; in the ring, or not flushed yet

// Records until it is killed; `pushed` counts in memory that outlives it.
[[noreturn]] void record_for_ever(const fs::path& folder, std::atomic<std::uint64_t>& pushed) {
  Recorder recorder(example_info(folder));
  for (std::uint64_t cycle = 0;; ++cycle) {
    recorder.push_waiting(example_sample(cycle, kRate_Hz));
    pushed.store(cycle + 1);
    if (cycle % 20 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

struct Counter final : RecordingListener {
  void configuration(const NamedText&) override {}
  void event(const Event&) override {}
  void sample(const Sample& sample) override {
    EXPECT_EQ(sample.record.cycle, samples);
    ++samples;
  }
  std::uint64_t samples = 0;
};

TEST(Recorder, LeavesAReadableFileWheneverItIsKilled) {
  if (!recording_available()) GTEST_SKIP() << "built without Rust";
  void* page = mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(page, MAP_FAILED);
  auto& pushed = *new (page) std::atomic<std::uint64_t>(0);
  const unsigned seed = std::random_device{}();
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  std::uint64_t most_lost = 0;
  for (int kill_number = 0; kill_number < kKills; ++kill_number) {
    const TemporaryFolder temporary;
    // at random among what is recorded, not in time
    const std::uint64_t moment = 1 + random() % 4000;
    pushed.store(0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) record_for_ever(temporary.path(), pushed);
    while (pushed.load() < moment) {
      ASSERT_EQ(waitpid(child, nullptr, WNOHANG), 0) << "it died too early at " << pushed.load();
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    ASSERT_EQ(kill(child, SIGKILL), 0);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);

    const std::uint64_t count = pushed.load();
    Counter counter;
    try {
      EXPECT_FALSE(read_recording(temporary.path() / "latest.mcap", counter).is_complete);
    } catch (const std::exception& error) {
      EXPECT_EQ(counter.samples, 0u) << error.what();
    }
    // what was pushed and not counted yet may be in the file
    const std::uint64_t lost = count - std::min(count, counter.samples);
    most_lost = std::max(most_lost, lost);
    EXPECT_LE(static_cast<double>(lost), kMostLost_s * kRate_Hz) << "killed at " << count;
  }
  std::printf("at most %llu samples lost\n", static_cast<unsigned long long>(most_lost));
}

}  // namespace
}  // namespace hg::recording
