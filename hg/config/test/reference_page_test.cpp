#include "hg/config/reference_page.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace hg::config {
namespace {

constexpr const char* kPage = "docs/reference/configuration.md";

// HG_UPDATE_DOCS=1 in the environment writes the page instead of comparing it
TEST(ReferencePage, CommittedPageIsCurrent) {
  if (std::getenv("HG_UPDATE_DOCS") != nullptr) std::ofstream(kPage) << reference_page();
  std::ifstream stream(kPage);
  const std::string committed{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(committed, reference_page())
      << "run config_test with HG_UPDATE_DOCS=1 and commit " << kPage;
}

TEST(ReferencePage, HasKeysWithUnitDefaultAndMeaning) {
  const std::string page = reference_page();
  EXPECT_NE(
      page.find("| `prepositioning.k_ppu_1_per_s` | 4 | 1e-06 .. 1e+05 1/s | gain, eq. (27) |"),
      std::string::npos);
  EXPECT_NE(page.find("| `joints.NAME.damping_Nms_per_rad` or `damping_Ns_per_m` | 0 | "
                      "0 .. 1e+09 Nms/rad; 0 .. 1e+09 Ns/m | viscous |"),
            std::string::npos);
  EXPECT_NE(page.find("| `urdf` | **required** | a file |"), std::string::npos);
}

}  // namespace
}  // namespace hg::config
