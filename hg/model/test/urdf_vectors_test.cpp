#include "hg/model/urdf_vectors.h"

#include <gtest/gtest.h>

namespace hg::model {
namespace {

TEST(UrdfVectors, AreThoseOfAllLinksAndJointsAsTheyAreWritten) {
  const UrdfVectors found = urdf_vectors(R"(<robot name="r">
<link name="a"><visual><origin rpy="0 0 90"/>
<geometry><mesh filename="m.stl" scale="0.001 0.001"/></geometry></visual></link>
<joint name="j" type="fixed"><origin rpy=" 0 +1.5 -2 " xyz="1 2 3"/></joint></robot>)");
  ASSERT_EQ(found.turns.size(), 2u);
  EXPECT_EQ(found.turns[0].kind + found.turns[0].name, "linka");
  EXPECT_EQ(found.turns[0].line, 2);
  EXPECT_EQ(found.turns[0].values, Eigen::Vector3d(0, 0, 90));
  EXPECT_EQ(found.turns[1].kind + found.turns[1].name, "jointj");
  EXPECT_EQ(found.turns[1].values, Eigen::Vector3d(0, 1.5, -2));
  ASSERT_EQ(found.scales.size(), 1u);
  EXPECT_EQ(found.scales[0].line, 3);
  EXPECT_EQ(found.scales[0].text, "0.001 0.001");
  EXPECT_FALSE(found.scales[0].values.has_value());
}

TEST(UrdfVectors, AreThreeFiniteNumbers) {
  EXPECT_EQ(vector3_of("1 -1 1e-3"), Eigen::Vector3d(1, -1, 1e-3));
  for (const char* text : {"", " ", "1 1", "1 1 1 1", "a b c", "nan 1 1", "1 inf 1", "1,1,1"}) {
    EXPECT_FALSE(vector3_of(text).has_value()) << text;
  }
}

TEST(UrdfVectors, OfATextThatIsNoXmlAreNone) { EXPECT_TRUE(urdf_vectors("<robot").turns.empty()); }

}  // namespace
}  // namespace hg::model
