#include "hg/device/ethercat/bits.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace hg::ethercat {
namespace {

TEST(Bits, AreLittleEndianAndMayStraddleBytes) {
  std::array<std::uint8_t, 6> data = {};
  write_bits(data, 3, 32, 0xDEADBEEF);
  EXPECT_EQ(read_bits(data, 3, 32), 0xDEADBEEFu);
  EXPECT_EQ(data[0], 0x78);  // the lowest five bits, in front of three of a neighbour
  EXPECT_EQ(data[4] >> 3, 0);
  write_bits(data, 0, 3, 0b101);
  EXPECT_EQ(read_bits(data, 3, 32), 0xDEADBEEFu);
  EXPECT_EQ(read_bits(data, 0, 3), 0b101u);
  write_bits(data, 8, 16, 0x1234);
  EXPECT_EQ(data[1], 0x34);
  EXPECT_EQ(data[2], 0x12);
}

TEST(Bits, StayWithinTheData) {
  std::array<std::uint8_t, 2> data = {};
  write_bits(data, 12, 32, 0xFFFFFFFF);
  EXPECT_EQ(data[1], 0xF0);
  EXPECT_EQ(read_bits(data, 12, 32), 0xFu);
  EXPECT_EQ(read_bits(data, 40, 8), 0u);
}

TEST(Bits, HaveASignWhereAskedFor) {
  EXPECT_EQ(signed_of(0xFFFF, 16), -1);
  EXPECT_EQ(signed_of(0x7FFF, 16), 32767);
  EXPECT_EQ(signed_of(1, 1), -1);
  EXPECT_EQ(signed_of(0x80000000, 32), INT32_MIN);
}

TEST(Bits, TooLargeNumbersBecomeTheLargest) {
  EXPECT_EQ(signed_of(rounded(1e9, 16), 16), 32767);
  EXPECT_EQ(signed_of(rounded(-1e9, 16), 16), -32768);
  EXPECT_EQ(signed_of(rounded(-2.6, 16), 16), -3);
  EXPECT_EQ(signed_of(rounded(1e12, 32), 32), INT32_MAX);
}

}  // namespace
}  // namespace hg::ethercat
