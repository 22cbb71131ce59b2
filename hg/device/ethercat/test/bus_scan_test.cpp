#include "hg/device/ethercat/bus_scan.h"

#include <gtest/gtest.h>

#include "hg/core/error.h"

namespace hg::ethercat {
namespace {

// a bus with slaves: tests/ethercat
TEST(BusScan, NamesTheInterfaceThatIsMissing) {
  try {
    scan_bus("nowhere0");
    FAIL() << "there is no such interface";
  } catch (const SetupError& error) {
    const std::string words = error.what();
    EXPECT_TRUE(words.starts_with("nowhere0: ") || words.starts_with("EtherCAT is off: ")) << words;
  }
}

TEST(BusScan, NamesStatesAsTheStandardDoes) {
  EXPECT_EQ(state_name(0x01), "INIT");
  EXPECT_EQ(state_name(0x02), "PRE-OP");
  EXPECT_EQ(state_name(0x14), "SAFE-OP + error");
  EXPECT_EQ(state_name(0x08), "OP");
  EXPECT_EQ(state_name(0x06), "state 6");
}

}  // namespace
}  // namespace hg::ethercat
