#include "hg/core/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace hg {
namespace {

const std::vector<std::string> kJoints = {"ppu1", "m1", "m2", "elbow", "handle"};

TEST(NearestName, FindsOneWrongMissingOrExtraLetter) {
  EXPECT_EQ(nearest_name("hendle", kJoints), "handle");
  EXPECT_EQ(nearest_name("elbw", kJoints), "elbow");
  EXPECT_EQ(nearest_name("ppuu1", kJoints), "ppu1");
}

TEST(NearestName, FindsSwappedLetters) {
  EXPECT_EQ(nearest_name("hadnle", kJoints), "handle");
  EXPECT_EQ(nearest_name("handel", std::vector<std::string>{"panel", "handle"}), "handle");
}

TEST(NearestName, WrongMissingAndExtraLettersWeighTheSame) {
  EXPECT_EQ(nearest_name("ax", std::vector<std::string>{"axyz", "ay"}), "ay");
  EXPECT_EQ(nearest_name("ppuu1", std::vector<std::string>{"qpuu2", "ppu1"}), "ppu1");
  EXPECT_EQ(nearest_name("ppu1", std::vector<std::string>{"qpu2", "ppuu1"}), "ppuu1");
}

TEST(NearestName, IgnoresCase) { EXPECT_EQ(nearest_name("ELBOW", kJoints), "elbow"); }

TEST(NearestName, TakesTheFirstOfEquals) { EXPECT_EQ(nearest_name("m3", kJoints), "m1"); }

TEST(NearestName, AnswersEmptyNamesAndListsWithoutFailing) {
  EXPECT_EQ(nearest_name("", kJoints), "m1");
  EXPECT_EQ(nearest_name("handle", {}), "");
}

TEST(MisspeltName, IsOneLetterOrTwoOfSixAwayOrInAnotherCase) {
  EXPECT_EQ(misspelt_name("hendel", kJoints), "handle");
  EXPECT_EQ(misspelt_name("elbw", kJoints), "elbow");
  EXPECT_EQ(misspelt_name("Elbow", kJoints), "elbow");
  EXPECT_EQ(misspelt_name("elw", kJoints), "");
  EXPECT_EQ(misspelt_name("trunk", kJoints), "");
  EXPECT_EQ(misspelt_name("m1", kJoints), "");  // a name itself, though "m2" is near
  EXPECT_EQ(misspelt_name("m1", {}), "");
}

// A megabyte without a separator is no name.
TEST(NearestName, IsNoneOfWhatIsTooLongForAName) {
  const std::string line(1'000'000, 'a');
  EXPECT_EQ(nearest_name("a_x", std::vector<std::string>{line, "b_y"}), "b_y");
  EXPECT_EQ(nearest_name("a_x", std::vector<std::string>{line}), "");
  EXPECT_EQ(misspelt_name(line, std::vector<std::string>{"a_x"}), "");
}

}  // namespace
}  // namespace hg
