#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/targets.h"

namespace hg::hqp {
namespace {

// Runs a target on the files of a folder; returns their number.
int replay(const std::filesystem::path& folder, void (*target)(std::span<const std::uint8_t>)) {
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

TEST(Fuzz, ReaderTakesItsCorpus) { EXPECT_GT(replay("tests/fuzz/corpus/reader", fuzz_reader), 10); }

TEST(Fuzz, SolverTakesItsCorpus) { EXPECT_GT(replay("tests/fuzz/corpus/solver", fuzz_solver), 10); }

}  // namespace
}  // namespace hg::hqp
