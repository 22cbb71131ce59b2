// Triangles from STL files, and the search for those near a way.

#include "hg/controller/rendering/surfaces/mesh.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <set>
#include <string>

#include "hg/controller/rendering/surfaces/test/solids.h"
#include "hg/core/error.h"
#include "hg/core/test/message_of.h"

namespace hg::surfaces {
namespace {

constexpr const char* kText =
    "solid two\n"
    "  facet normal 0 0 1\n    outer loop\n"
    "      vertex 0 0 0\n      vertex 1e3 0 0\n      vertex 0 +1000.0 0\n"
    "    endloop\n  endfacet\n"
    "  facet normal 0 0 1\n    outer loop\n"
    "      vertex 1000 0 0\n      vertex 1000 1000 0\n      vertex 0 1000 0\n"
    "    endloop\n  endfacet\n"
    "endsolid two\n";

std::string binary(const std::vector<std::array<float, 9>>& triangles) {
  std::string content(80, 's');  // some programs begin it with "solid", too
  content.replace(0, 5, "solid");
  const auto append = [&](const void* data, std::size_t size) {
    content.append(static_cast<const char*>(data), size);
  };
  const auto count = static_cast<std::uint32_t>(triangles.size());
  append(&count, sizeof(count));
  for (const auto& corners : triangles) {
    content.append(12, '\0');  // normal
    append(corners.data(), sizeof(corners));
    content.append(2, '\0');
  }
  return content;
}

TEST(ReadStl, TakesTextAndBinaryFiles) {
  for (const std::string& content :
       {std::string(kText),
        binary({{0, 0, 0, 1000, 0, 0, 0, 1000, 0}, {1000, 0, 0, 1000, 1000, 0, 0, 1000, 0}})}) {
    const Mesh mesh = read_stl(content, "plate.stl", 0.001);
    ASSERT_EQ(mesh.triangles().size(), 2U);
    EXPECT_EQ(mesh.triangles()[0].normal, Vector3d::UnitZ());
    EXPECT_LT((mesh.triangles()[1].corners[1] - Vector3d(1, 1, 0)).norm(), 1e-12);
  }
}

TEST(ReadStl, ReportsWhatIsWrong) {
  const auto message = [](const std::string& content) {
    return message_of([&] { read_stl(content, "plate.stl", 1.0); });
  };
  EXPECT_EQ(message(""),
            "plate.stl: no STL file: it neither begins with 'solid' nor has the length that its "
            "count of triangles demands");
  EXPECT_EQ(message(binary({{}}).substr(1)),
            "plate.stl: no STL file: it neither begins with 'solid' nor has the length that its "
            "count of triangles demands");
  std::string text = kText;
  EXPECT_EQ(message(text.replace(text.find("1e3"), 3, "l00")),
            "plate.stl:5: a number is expected after 'vertex', got 'l00'");
  EXPECT_EQ(message("solid x\nvertex 0 0 0\nvertex 1 0"),
            "plate.stl:3: a number is expected after 'vertex', got ''");
  EXPECT_EQ(message("solid x\nvertex 0 0 0\nendsolid"),
            "plate.stl: three vertices a facet are expected, got 1 in all");
  EXPECT_EQ(message("solid x\nendsolid"), "plate.stl: 1 .. 20000 triangles with an area, got 0");
  EXPECT_EQ(message("solid x\nvertex 0 0 0\nvertex 1 0 nan\nvertex 0 1 0"),
            "plate.stl: corners of triangles must be finite");
}

TEST(ReadStl, SurvivesDamagedFiles) {
  const std::string good = binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, 0}});
  for (unsigned seed = 0; seed < 2000; ++seed) {
    std::mt19937 random(seed);
    std::string content = seed % 2 == 0 ? good : kText;
    for (int i = 0; i < 3; ++i) content[random() % content.size()] = static_cast<char>(random());
    if (seed % 3 == 0) content.resize(random() % content.size());
    try {
      read_stl(content, "damaged.stl", 1.0);
    } catch (const SetupError&) {
    }
  }
}

TEST(Mesh, DetectsWhetherItIsClosedAndWhatIsInside) {
  const Mesh box = box_mesh({0.2, 0.1, 0.3});
  EXPECT_TRUE(box.is_closed());
  EXPECT_TRUE(box.encloses({0.09, -0.04, 0.14}));
  EXPECT_FALSE(box.encloses({0.11, 0.0, 0.0}));
  EXPECT_TRUE(ball_mesh(2).is_closed());
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const Triangle& triangle : box.triangles()) triangles.push_back(triangle.corners);
  std::swap(triangles[3][0], triangles[3][1]);
  EXPECT_FALSE(Mesh(triangles).is_closed());  // one is turned round
  triangles.erase(triangles.begin() + 3);
  EXPECT_FALSE(Mesh(triangles).is_closed());
}

TEST(Mesh, NumbersWhatHangsTogether) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const double x : {0.0, 0.5}) {
    const Mesh one = box_mesh({0.1, 0.1, 0.1});
    for (Triangle triangle : one.triangles()) {
      for (Vector3d& corner : triangle.corners) corner.x() += x;
      triangles.push_back(triangle.corners);
    }
  }
  const Mesh two(triangles);
  for (std::size_t i = 0; i < 24; ++i) {
    EXPECT_EQ(two.triangles()[i].solid == two.triangles()[0].solid, i < 12) << i;
  }
}

TEST(Mesh, FindsAllTrianglesNearAWay) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::vector<std::array<Vector3d, 3>> triangles;
    for (int i = 0; i < 200; ++i) {
      const Vector3d p = random_in(random, 1.0);
      triangles.push_back({p, p + random_in(random, 0.1), p + random_in(random, 0.1)});
    }
    const Mesh mesh(triangles);
    for (int k = 0; k < 100; ++k) {
      const Vector3d a = random_in(random, 1.2), b = random_in(random, 1.2);
      std::set<const Triangle*> found;
      mesh.for_each_near(a, b, 1e-6,
                         [&](const Triangle& t) { ASSERT_TRUE(found.insert(&t).second); });
      for (const Triangle& t : mesh.triangles()) {
        // every triangle that the way crosses
        const double from = t.normal.dot(a - t.corners[0]), to = t.normal.dot(b - t.corners[0]);
        if (from * to > 0.0) continue;
        const Vector3d x = a + from / (from - to) * (b - a);
        bool is_over = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vector3d edge = t.corners[(i + 1) % 3] - t.corners[i];
          is_over = is_over && edge.cross(x - t.corners[i]).dot(t.normal) >= 0.0;
        }
        ASSERT_TRUE(!is_over || found.contains(&t)) << k;
      }
      EXPECT_LT(found.size(), mesh.triangles().size() / 2);
    }
  }
}

}  // namespace
}  // namespace hg::surfaces
