#include "hg/config/yaml_numbers.h"

#include <gtest/gtest.h>

namespace hg::config {
namespace {

TEST(YamlNumbers, HaveThePathsOfTheirKeysAndTheirPlaces) {
  const std::vector<YamlNumber> found = numbers_in(
      "name: 'x'\njoints:\n  m1: {q_max_rad: 2.5}\ncom_m: [1, -2e-3]\nlist:\n  - a: 7\n");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].item, "joints.m1.q_max_rad");
  EXPECT_EQ(found[0].key, "q_max_rad");
  EXPECT_EQ(found[0].value, 2.5);
  EXPECT_EQ(found[0].place.line, 3);
  EXPECT_EQ(found[0].place.column, 19);
  EXPECT_EQ(found[2].item, "com_m[1]");
  EXPECT_EQ(found[2].key, "com_m");
  EXPECT_EQ(found[2].value, -2e-3);
  EXPECT_EQ(found[3].item, "list[0].a");
}

TEST(YamlNumbers, AreOnlyThoseThatAreFiniteAndWithoutQuotes) {
  EXPECT_TRUE(numbers_in("a: .inf\nb: '7'\nc: \"7\"\nd: true\ne: 7 m\nf:\ng: .nan\n").empty());
  EXPECT_TRUE(numbers_in("a: [").empty());
}

}  // namespace
}  // namespace hg::config
