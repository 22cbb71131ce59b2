#include "hg/start_test/memory.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"

namespace hg::start_test {
namespace {

constexpr std::time_t kThen = 1'795'000'000;

Result good() {
  return {.device = "arm",
          .address = "there:1",
          .version = "1",
          .files_sha256 = "00",
          .ended = kThen,
          .has_passed = true,
          .items = {{.name = "emergency stop", .outcome = Outcome::kPassed},
                    {.name = "brake m6", .outcome = Outcome::kUntested}}};
}

std::string objection(const Result& result, double later_h = 1.0) {
  return judge(to_json(result), {.device = "arm",
                                 .files_sha256 = "00",
                                 .now = kThen + static_cast<std::time_t>(3600.0 * later_h)})
      .objection;
}

TEST(StartTestResult, CountsForItsDeviceItsFilesAndADay) {
  EXPECT_EQ(objection(good()), "");
  EXPECT_EQ(objection(good(), 23.9), "");
  EXPECT_EQ(objection(good(), 24.5), "it is 24.5 h old, and counts for 24 h");
  EXPECT_NE(objection(good(), -1.0).find("of the future"), std::string::npos);

  Result other = good();
  other.device = "leg";
  EXPECT_EQ(objection(other), "it is of another device");
  other = good();
  other.files_sha256 = "01";
  EXPECT_EQ(objection(other), "the files of the device have changed since");
  other = good();
  other.is_simulated = true;
  EXPECT_EQ(objection(other), "it is of a simulation");
  other = good();
  other.has_passed = false;
  EXPECT_EQ(objection(other), "it did not come to its end");
  other = good();
  other.items[0].outcome = Outcome::kFailed;
  EXPECT_EQ(objection(other), "failed: emergency stop");
}

TEST(StartTestResult, ThatIsDamagedDoesNotCount) {
  const std::string whole = to_json(good());
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    EXPECT_EQ(judge(whole.substr(0, size), {}).objection, "it cannot be read");
  }
  EXPECT_EQ(judge("[1]", {}).objection, "it cannot be read");
}

TEST(StartTestResult, TellsWhatWasLeftOut) {
  const Verdict verdict =
      judge(to_json(good()), {.device = "arm", .files_sha256 = "00", .now = kThen});
  EXPECT_EQ(verdict.untested, std::vector<std::string>{"brake m6"});
}

TEST(Sha256, IsThatOfFips180) {
  const std::string_view parts[] = {"a", "bc"};
  EXPECT_EQ(sha256(parts), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(FileOf, HasNoPathInTheNameOfADevice) {
  EXPECT_EQ(file_of("recordings", "posture", "../My arm 2"), "recordings/posture____My_arm_2.json");
}

std::vector<Position> posture(double slide, double joint, double endless) {
  return {{"ppu1", slide, true, false}, {"m2", joint, false, false}, {"m1", endless, false, true}};
}

TEST(Posture, ElsewhereByMoreThanTwoDegreesOrTwoCentimetresIsNamed) {
  const std::string kept = posture_to_json("arm", kThen, posture(0.5, 1.0, 3.1));
  EXPECT_TRUE(compare_posture(kept, posture(0.515, 1.03, -3.17), {}).empty());  // a turn is none
  const std::vector<Moved> moved = compare_posture(kept, posture(0.8, 1.05, 3.1), {});
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(moved[0].words, "ppu1: 0.800 m, the last run has left it at 0.500 m");
  EXPECT_EQ(moved[1].words, "m2: 1.050 rad, the last run has left it at 1.000 rad");
}

TEST(Posture, AJointThatWasNotKeptIsNamedAndADamagedFileIsAnError) {
  const std::string kept = posture_to_json("arm", kThen, {{"ppu1", 0.5, true, false}});
  EXPECT_EQ(compare_posture(kept, posture(0.5, 0.0, 0.0), {}).size(), 2U);
  for (const std::string damaged : {"", "{}", "[3]", R"({"positions": 3})",
                                    R"({"positions": [{"name": "ppu1", "value": null}]})"}) {
    EXPECT_THROW(compare_posture(damaged, posture(0.5, 0.0, 0.0), {}), SetupError) << damaged;
  }
}

}  // namespace
}  // namespace hg::start_test
