#include "hg/viewer_server/meshes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "hg/core/error.h"

namespace hg::viewer_server {
namespace {

namespace fs = std::filesystem;

// Meshes are found where the URDFs of robots mean them; nothing else gets into the table.
class Meshes : public ::testing::Test {
 protected:
  Meshes() : root_(fs::temp_directory_path() / ("hg_meshes_" + std::to_string(getpid()))) {
    write("robots/arm/meshes/base.stl", "base");
    write("robots/arm/meshes/link.dae", "link");
    write("robots/arm/meshes/secret.txt", "secret");
  }
  ~Meshes() override { fs::remove_all(root_); }

  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  std::string serve(const std::string& urdf) {
    write("robots/arm/urdf/arm.urdf", urdf);
    return with_meshes(root_ / "robots/arm/urdf/arm.urdf", "/models/device/", assets_);
  }

  fs::path root_;
  AssetTable assets_;
};

TEST_F(Meshes, OfAPackageAboveTheUrdfGetAddresses) {
  const std::string text =
      serve(R"(<mesh filename="package://arm/meshes/base.stl" scale="1 1 1"/>)");
  ASSERT_EQ(assets_.size(), 1u);
  EXPECT_EQ(text, "<mesh filename=\"" + assets_.begin()->first + "\" scale=\"1 1 1\"/>");
  EXPECT_TRUE(assets_.begin()->first.starts_with("/models/device/"));
  EXPECT_TRUE(assets_.begin()->first.ends_with(".stl"));
  EXPECT_EQ(assets_.begin()->second.content, "base");
}

TEST_F(Meshes, BesideTheUrdfAndTwiceAreServedOnce) {
  const std::string mesh = "<mesh filename='../meshes/link.dae'/>";
  const std::string text = serve(mesh + mesh);
  ASSERT_EQ(assets_.size(), 1u);
  EXPECT_EQ(assets_.begin()->second.content, "link");
  const std::string served = "<mesh filename='" + assets_.begin()->first + "'/>";
  EXPECT_EQ(text, served + served);
}

TEST_F(Meshes, ThatAreMissingOrNoMeshesKeepTheirNames) {
  const std::string urdf =
      R"(<mesh filename="package://arm/meshes/none.stl"/><mesh filename="../meshes/secret.txt"/>)"
      R"(<mesh scale="1 1 1"/><box size="1 1 1" filename="../meshes/base.stl"/><mesh filename=")";
  EXPECT_EQ(serve(urdf), urdf);
  EXPECT_TRUE(assets_.empty());
}

TEST_F(Meshes, OfAUrdfThatIsNotThereAreRefused) {
  EXPECT_THROW(with_meshes(root_ / "none.urdf", "/models/device/", assets_), SetupError);
}

}  // namespace
}  // namespace hg::viewer_server
