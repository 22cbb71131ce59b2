#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/targets.h"

namespace hg::fuzz {
namespace {

// Runs a target on the files of a folder; returns their number.
int replay(const std::filesystem::path& folder, void (*target)(Bytes)) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path());
    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<char> content(std::istreambuf_iterator<char>(file), {});
    const std::vector<std::uint8_t> bytes(content.begin(), content.end());
    target(bytes);
    ++count;
  }
  return count;
}

TEST(Fuzz, EveryTargetTakesItsCorpus) {
  EXPECT_GT(replay("tests/fuzz/corpus/hqp_reader", hqp_reader), 10);
  EXPECT_GT(replay("tests/fuzz/corpus/hqp_solver", hqp_solver), 10);
  EXPECT_GT(replay("tests/fuzz/corpus/config", config), 5);
  EXPECT_GT(replay("tests/fuzz/corpus/urdf", urdf), 3);
  EXPECT_GT(replay("tests/fuzz/corpus/protocol", protocol), 5);
  EXPECT_GT(replay("tests/fuzz/corpus/commands", commands), 5);
  EXPECT_GT(replay("tests/fuzz/corpus/live", live), 5);
  EXPECT_GT(replay("tests/fuzz/corpus/recording", recording), 3);
}

}  // namespace
}  // namespace hg::fuzz
