#include "tools/pages/configuration_page.h"

#include <gtest/gtest.h>

#include <string>

namespace hg::pages {
namespace {

TEST(ConfigurationPage, HasKeysWithUnitDefaultAndMeaning) {
  const std::string page = configuration_page();
  EXPECT_NE(
      page.find("| `prepositioning.k_ppu_1_per_s` | 4 | 1e-06 .. 1e+05 1/s | gain, eq. (27) |"),
      std::string::npos);
  EXPECT_NE(page.find("| `joints.NAME.damping_Nms_per_rad` or `damping_Ns_per_m` | 0 | "
                      "0 .. 1e+09 Nms/rad; 0 .. 1e+09 Ns/m | viscous |"),
            std::string::npos);
  EXPECT_NE(page.find("| `urdf` | **required** | a file |"), std::string::npos);
}

}  // namespace
}  // namespace hg::pages
