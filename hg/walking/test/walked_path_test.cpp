#include "hg/walking/walked_path.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "hg/core/input_fault.h"
#include "hg/core/scratch_folder.h"

namespace hg::walking {
namespace {

class WalkedPathFile : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string file = folder_.path() + "/way.csv";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  std::string fault_of(const std::string& text) {
    try {
      read_walked_path(write(text));
    } catch (const InputError& error) {
      const std::string words = error.what();
      return words.substr(words.find("way.csv"));
    }
    return "none";
  }

  ScratchFolder folder_;
};

TEST_F(WalkedPathFile, IsReadAndResampled) {
  std::string text = "interval_s,x_m,y_m\r\n";
  for (int i = 0; i <= 100; ++i) text += "0.04," + std::to_string(0.04 * i) + ",2\r\n";
  const WalkedPath path = read_walked_path(write(text));
  EXPECT_EQ(path.name, "way");
  EXPECT_NEAR(static_cast<double>(path.samples.size()), 4.0 / kWalkPeriod, 2.0);
  EXPECT_NEAR(path.samples.back().p.x(), 4.0, 0.02);
  EXPECT_NEAR(path.samples.back().v.x(), 1.0, 1e-3);
  EXPECT_NEAR(path.samples.back().heading, 0.0, 1e-9);
  EXPECT_NEAR(path.spaces[0].lower.y(), 1.5, 1e-9);
}

TEST_F(WalkedPathFile, IsRefusedWithItsLine) {
  const std::string head = "interval_s,x_m,y_m\n0.03,0,0\n";
  EXPECT_EQ(fault_of("t,x,y\n0,0,0\n"),
            "way.csv:1: columns interval_s,x_m,y_m expected, got 't,x,y'");
  EXPECT_EQ(fault_of(head + "0.03,0.1\n"),
            "way.csv:3: three numbers expected, interval_s,x_m,y_m, got '0.03,0.1'");
  EXPECT_EQ(fault_of(head + "0.03,0.1,nan\n"),
            "way.csv:3: three numbers expected, interval_s,x_m,y_m, got '0.03,0.1,nan'");
  EXPECT_EQ(fault_of(head + "0.03,4,0\n"),
            "way.csv:3: a person of 133 m/s: x_m and y_m are in meters");
  EXPECT_EQ(fault_of(head + "0,0,0\n"),
            "way.csv:3: interval_s must be above 0 and at most 10, got 0");
  EXPECT_EQ(fault_of(head), "way.csv: at least two positions expected");
}

}  // namespace
}  // namespace hg::walking
