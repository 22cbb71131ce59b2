#include "hg/core/unit.h"

#include <gtest/gtest.h>

#include "hg/core/test/unit_words.h"

namespace hg {
namespace {

TEST(Unit, TextSaysWhichUnitsANumberMayHave) {
  EXPECT_EQ(unit::kNone.text(), "");
  EXPECT_EQ(unit::kNsPerM.text(), "Ns/m");
  EXPECT_EQ(unit::kJointSpeed.text(), "rad/s or m/s");
  EXPECT_EQ(unit::kWrench.text(), "N, Nm");
}

TEST(Unit, StandsBeforeTheNote) {
  EXPECT_EQ(with_unit("gantry positions", unit::kJointPosition), "[rad or m] gantry positions");
  EXPECT_EQ(with_unit("share of the peak", unit::kNone), "share of the peak");
  EXPECT_EQ(with_unit("", unit::kS), "[s]");
}

TEST(UnitWordIn, FindsUnitsInWordsAndBrackets) {
  EXPECT_EQ(unit_word_in("link-side velocities, rad/s"), "rad/s");
  EXPECT_EQ(unit_word_in("wrench in S: force N, torque Nm"), "N");
  EXPECT_EQ(unit_word_in("time of the device's clock (s)"), "s");
  EXPECT_EQ(unit_word_in("motor temperatures, degrees Celsius; empty = none"), "degrees");
  EXPECT_EQ(unit_word_in("time of the device's clock; 0 = none yet"), "");
}

}  // namespace
}  // namespace hg
