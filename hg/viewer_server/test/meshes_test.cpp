#include "hg/viewer_server/meshes.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/core/test/temporary_folder.h"

namespace hg::viewer_server {
namespace {

// Meshes are found where the URDFs of robots mean them; nothing else gets into the table.
class Meshes : public ::testing::Test {
 protected:
  Meshes() {
    folder_.write("robots/arm/meshes/base.stl", "base");
    folder_.write("robots/arm/meshes/link.dae", "link");
    folder_.write("robots/arm/meshes/secret.txt", "secret");
  }

  std::string serve(const std::string& urdf) {
    const std::filesystem::path file = folder_.write("robots/arm/urdf/arm.urdf", urdf);
    return with_meshes(file, urdf, "/models/device/", assets_, addresses_);
  }

  const TemporaryFolder folder_;
  AssetTable assets_;
  MeshAddresses addresses_;
};

TEST_F(Meshes, OfAPackageAboveTheUrdfGetAddresses) {
  const std::string text =
      serve(R"(<mesh filename="package://arm/meshes/base.stl" scale="1 1 1"/>)");
  ASSERT_EQ(assets_.size(), 1u);
  EXPECT_EQ(text, "<mesh filename=\"" + assets_.begin()->first + "\" scale=\"1 1 1\"/>");
  EXPECT_TRUE(assets_.begin()->first.starts_with("/models/device/"));
  EXPECT_TRUE(assets_.begin()->first.ends_with(".stl"));
  EXPECT_EQ(*assets_.begin()->second.content, "base");
}

TEST_F(Meshes, BesideTheUrdfAndTwiceAreServedOnce) {
  const std::string mesh = "<mesh filename='../meshes/link.dae'/>";
  const std::string text = serve(mesh + mesh);
  ASSERT_EQ(assets_.size(), 1u);
  EXPECT_EQ(*assets_.begin()->second.content, "link");
  const std::string served = "<mesh filename='" + assets_.begin()->first + "'/>";
  EXPECT_EQ(text, served + served);
}

TEST_F(Meshes, ThatAreMissingOrNoMeshesKeepTheirNames) {
  const std::string urdf =
      R"(<mesh filename="package://arm/meshes/none.stl"/><mesh filename="../meshes/secret.txt"/>)"
      R"(<mesh scale="1 1 1"/><box size="1 1 1" filename="../meshes/base.stl"/><mesh filename=")";
  EXPECT_EQ(serve(urdf), urdf);
  EXPECT_TRUE(assets_.empty());
  const std::vector<std::string> missing = {"package://arm/meshes/none.stl",
                                            "../meshes/secret.txt"};
  const std::string twice = R"(<mesh filename="package://arm/meshes/none.stl"/>)" + urdf;
  EXPECT_EQ(missing_meshes(folder_.path() / "robots/arm/urdf/arm.urdf", twice), missing);
}

TEST_F(Meshes, OfAUrdfThatIsNotThereAreRefused) {
  EXPECT_THROW(read_file(folder_.path() / "none.urdf"), SetupError);
}

}  // namespace
}  // namespace hg::viewer_server
