#include "hg/recording/problem_dumps.h"

#include <gtest/gtest.h>

#include <future>
#include <string>

#include "hg/hqp/problem_capture.h"
#include "hg/hqp/text.h"

namespace hg::recording {
namespace {

TEST(ProblemDumps, ADiskThatHangsCostsProblemsNotTheRun) {
  const hqp::Problem problem = hqp::parse_problems("hqp 1 1\nlevel 1 0\n1 2\nend\n", "one")[0];
  const hqp::Capacity capacity = hqp::capacity_for(std::vector<hqp::Problem>{problem});
  hqp::ProblemCapture kept(capacity);
  hqp::Solution solution(capacity);
  for (const std::uint64_t cycle : {1U, 2U, 3U}) kept.capture(problem, {}, {}, solution, cycle);
  ASSERT_EQ(kept.size(), 3U);

  std::promise<void> never;
  const auto hangs = [disk = never.get_future().share()](const std::filesystem::path& file,
                                                         const std::string&) {
    if (file.filename() == "run_hqp_2.hqp") disk.wait();
    return true;
  };
  ProblemDumps dumps({.folder = "disk", .stem = "run", .origin = "a test", .program = "x"}, hangs);
  const std::string text = dumps.finish(kept);
  EXPECT_NE(text.find("cycle 1"), std::string::npos) << text;
  EXPECT_NE(text.find("2 problems NOT written: disk has not taken them in 2 s"), std::string::npos)
      << text;
  EXPECT_EQ(dumps.finish(kept), "");
  never.set_value();
}

}  // namespace
}  // namespace hg::recording
