#include "hg/core/input_fault.h"

#include <gtest/gtest.h>

namespace hg {
namespace {

TEST(InputFault, TextHasWhatIsGiven) {
  InputFault fault = {.what = "must be > 0, got 0"};
  EXPECT_EQ(to_text(fault), "must be > 0, got 0");
  fault.item = "joints.m1";
  EXPECT_EQ(to_text(fault), "joints.m1: must be > 0, got 0");
  fault.file = "a/b.yaml";
  EXPECT_EQ(to_text(fault), "a/b.yaml: joints.m1: must be > 0, got 0");
  fault.line = 3;
  EXPECT_EQ(to_text(fault), "a/b.yaml:3: joints.m1: must be > 0, got 0");
  fault.column = 7;
  EXPECT_EQ(to_text(fault), "a/b.yaml:3:7: joints.m1: must be > 0, got 0");
  EXPECT_EQ(text_without_place(fault), "joints.m1: must be > 0, got 0");
}

TEST(InputError, MessageHasALineForEachFault) {
  const InputError error({{.file = "a.yaml", .line = 3, .item = "x", .what = "wrong"},
                          {.file = "b.urdf", .what = "no such file"}});
  EXPECT_STREQ(error.what(), "a.yaml:3: x: wrong\nb.urdf: no such file");
}

TEST(InputError, FaultsSurviveBeingCaughtAsSetupError) {
  try {
    throw InputError(InputFault{.file = "a:12: b.yaml", .line = 3, .item = "x: y", .what = "w: z"});
  } catch (const SetupError& error) {
    const std::vector<InputFault> faults = faults_of(error);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].file, "a:12: b.yaml");
    EXPECT_EQ(faults[0].item, "x: y");
    EXPECT_EQ(faults[0].what, "w: z");
  }
}

TEST(InputError, MessageOfAnErrorWithoutDataIsAFaultOfNoFile) {
  const std::vector<InputFault> faults = faults_of(SetupError("a.yaml:3: x: wrong"));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].file + faults[0].item, "");
  EXPECT_EQ(faults[0].what, "a.yaml:3: x: wrong");
}

}  // namespace
}  // namespace hg
