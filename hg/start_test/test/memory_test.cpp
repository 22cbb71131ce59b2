#include "hg/start_test/memory.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"

namespace hg::start_test {
namespace {

constexpr std::time_t kThen = 1'795'000'000;

StartTestResult good() {
  return {.device = "arm",
          .address = "there:1",
          .version = "1",
          .files_sha256 = "00",
          .ended = kThen,
          .has_passed = true,
          .items = {{.name = "emergency stop", .outcome = Outcome::kPassed},
                    {.name = "brake m6", .outcome = Outcome::kUntested}}};
}

std::string objection(const StartTestResult& result, double later_h = 1.0) {
  return check_validity(to_json(result),
                        {.device = "arm",
                         .address = "there:1",
                         .files_sha256 = "00",
                         .now = kThen + static_cast<std::time_t>(3600.0 * later_h)})
      .objection;
}

TEST(StartTestResult, CountsForItsDeviceItsFilesAndADay) {
  EXPECT_EQ(objection(good()), "");
  EXPECT_EQ(objection(good(), 23.9), "");
  EXPECT_EQ(objection(good(), 24.5), "it is 24.5 h old, and counts for 24 h");
  EXPECT_NE(objection(good(), -1.0).find("of the future"), std::string::npos);

  StartTestResult other = good();
  other.device = "leg";
  EXPECT_EQ(objection(other), "it is of another device");
  other = good();
  other.address = "there:2";
  EXPECT_EQ(objection(other), "it is of the device at there:2");
  other = good();
  other.files_sha256 = "01";
  EXPECT_EQ(objection(other), "the files of the device have changed since");
  other = good();
  other.is_simulated = true;
  EXPECT_EQ(objection(other), "it is of a simulation");
  other = good();
  other.has_passed = false;
  EXPECT_EQ(objection(other), "it did not finish");
  other = good();
  other.items[0].outcome = Outcome::kFailed;
  EXPECT_EQ(objection(other), "failed: emergency stop");
}

TEST(StartTestResult, SaysWhatWasLetPassOfTheComputer) {
  EXPECT_EQ(to_json(good()).find("computer"), std::string::npos);
  StartTestResult result = good();
  result.computer = "driven despite lateness, max 900 us";
  EXPECT_NE(to_json(result).find("\"computer\": \"driven despite lateness, max 900 us\""),
            std::string::npos);
  EXPECT_EQ(objection(result), "");
}

TEST(StartTestResult, ThatIsDamagedDoesNotCount) {
  const std::string whole = to_json(good());
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    EXPECT_EQ(check_validity(whole.substr(0, size), {}).objection, "it cannot be read");
  }
  EXPECT_EQ(check_validity("[1]", {}).objection, "it cannot be read");

  const std::string number = std::to_string(kThen);
  for (const char* silly : {"-1", "1e300", "1795000000.5", "true", "\"1795000000\"",
                            "-9223372036854775808", "18446744073709551615", "1e9999"}) {
    std::string damaged = whole;
    damaged.replace(damaged.find(number), number.size(), silly);
    EXPECT_EQ(check_validity(damaged, {.now = kThen}).objection, "it cannot be read") << silly;
  }
  std::string late = whole;
  late.replace(late.find(number), number.size(), "9223372036854775807");
  EXPECT_NE(check_validity(late, {.now = kThen}).objection.find("of the future"),
            std::string::npos);
}

TEST(StartTestResult, OfANameThatIsNoUtf8Counts) {
  StartTestResult result = good();
  result.device = "arm \xff";
  result.items[0].name = "brake \xff";
  EXPECT_EQ(objection(result), "it is of another device");
  const Requirements required = {
      .device = result.device, .address = "there:1", .files_sha256 = "00", .now = kThen};
  EXPECT_EQ(check_validity(to_json(result), required).objection, "");
  const std::vector<Position> stands = {{"m\xff", 0.1, false, false}};
  const std::string kept = posture_to_json("arm \xff", "there:1", kThen, stands);
  EXPECT_TRUE(compare_posture(kept, "there:1", stands, {}).empty());
}

TEST(StartTestResult, ReportsWhatWasLeftOut) {
  const Validity validity = check_validity(
      to_json(good()), {.device = "arm", .address = "there:1", .files_sha256 = "00", .now = kThen});
  EXPECT_EQ(validity.untested, std::vector<std::string>{"brake m6"});
}

TEST(Sha256, IsThatOfFips180) {
  const std::string_view parts[] = {"a", "bc"};
  EXPECT_EQ(sha256(parts), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(FileOf, HasNoPathInTheNameOfADevice) {
  EXPECT_EQ(file_of("recordings", "posture", "../My arm 2", "192.168.1.20:4810"),
            "recordings/posture____My_arm_2_192_168_1_20_4810.json");
}

std::vector<Position> posture(double slide, double joint, double endless) {
  return {{"ppu1", slide, true, false}, {"m2", joint, false, false}, {"m1", endless, false, true}};
}

TEST(Posture, ElsewhereByMoreThanTwoDegreesOrTwoCentimetresIsNamed) {
  const std::string kept = posture_to_json("arm", "there:1", kThen, posture(0.5, 1.0, 3.1));
  EXPECT_TRUE(
      compare_posture(kept, "there:1", posture(0.515, 1.03, -3.17), {}).empty());  // a turn is none
  const std::vector<Moved> moved = compare_posture(kept, "there:1", posture(0.8, 1.05, 3.1), {});
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_EQ(moved[0].words, "ppu1: 0.800 m, the last run has left it at 0.500 m");
  EXPECT_EQ(moved[1].words, "m2: 1.050 rad, the last run has left it at 1.000 rad");
}

TEST(Posture, AJointThatWasNotKeptIsNamedAndADamagedFileIsAnError) {
  const std::string kept = posture_to_json("arm", "there:1", kThen, {{"ppu1", 0.5, true, false}});
  EXPECT_EQ(compare_posture(kept, "there:1", posture(0.5, 0.0, 0.0), {}).size(), 2U);
  EXPECT_THROW(compare_posture(kept, "there:2", posture(0.5, 0.0, 0.0), {}), SetupError);
  for (const std::string damaged :
       {"", "{}", "[3]", R"({"address": "there:1", "positions": 3})",
        R"({"address": "there:1", "positions": [{"name": "ppu1", "value": null}]})"}) {
    EXPECT_THROW(compare_posture(damaged, "there:1", posture(0.5, 0.0, 0.0), {}), SetupError)
        << damaged;
  }
}

}  // namespace
}  // namespace hg::start_test
