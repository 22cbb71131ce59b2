#include "hg/core/enumerators.h"

#include <gtest/gtest.h>

namespace hg {
namespace {

enum class Colour : unsigned char { kRed = 1, kDarkBlue = 7, kSs2 = 63 };

TEST(Enumerators, AreAllOfThemInOrder) {
  constexpr auto all = enumerators<Colour>();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].value, Colour::kRed);
  EXPECT_EQ(all[0].name, "kRed");
  EXPECT_EQ(all[1].name, "kDarkBlue");
  EXPECT_EQ(all[2].value, Colour::kSs2);
}

TEST(Enumerators, OnesBeyondTheEndAreNotSeen) { EXPECT_EQ((enumerators<Colour, 7>().size()), 1u); }

TEST(Enumerators, HaveNamesAndNumbers) {
  EXPECT_EQ(numbers_of<Colour>(), "1 red, 7 dark blue, 63 ss2");
}

TEST(Enumerators, HaveTheNamesOfConstants) {
  EXPECT_EQ(constant_name("kRed"), "RED");
  EXPECT_EQ(constant_name("kDarkBlue"), "DARK_BLUE");
  EXPECT_EQ(constant_name("kSs2"), "SS2");
}

}  // namespace
}  // namespace hg
