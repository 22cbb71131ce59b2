/// A session that was captured once is still understood; tests/remote/README.md says where it is
/// from.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/device/udp/agreement.h"
#include "hg/device/udp/capture.h"
#include "hg/device/udp/codec.h"

namespace hg::udp {
namespace {

const char* const kSession = "tests/remote/session.pcap";

// the datagrams of a capture
std::vector<std::vector<std::byte>> read_capture(const std::string& file) {
  constexpr std::array<std::uint32_t, 6> kHeader = {0xa1b23c4d, 2 | 4U << 16U, 0, 0, 65535, 147};
  std::istringstream in(read_file(file));
  std::array<std::uint32_t, 6> found{};
  in.read(reinterpret_cast<char*>(found.data()), sizeof found);
  EXPECT_EQ(found, kHeader);
  std::vector<std::vector<std::byte>> datagrams;
  std::array<std::uint32_t, 4> packet{};  // s, ns, captured bytes, bytes
  while (in.read(reinterpret_cast<char*>(packet.data()), sizeof packet)) {
    std::vector<std::byte>& datagram = datagrams.emplace_back(packet[2]);
    in.read(reinterpret_cast<char*>(datagram.data()), packet[2]);
    EXPECT_TRUE(in) << file << ": ends inside a packet";
  }
  return datagrams;
}

// the fields of `bytes`, and that they give the same bytes again
template <typename Message>
Message fields_of(std::span<const std::byte> bytes, const Header& header) {
  Message message;
  EXPECT_TRUE(decode(bytes, message));
  Datagram again;
  encode(header, message, again);
  EXPECT_TRUE(std::ranges::equal(again.view(), bytes));
  return message;
}

TEST(Replay, ACapturedSessionIsUnderstood) {
  Description agreed;
  std::map<MessageType, int> counts;
  std::uint64_t next = 0;
  for (const auto& bytes : read_capture(kSession)) {
    Header header;
    ASSERT_EQ(read_header(bytes, header), DatagramCheck::kGood);
    const auto type = static_cast<MessageType>(header.type);
    ++counts[type];
    if (type == MessageType::kWelcome) {
      const auto welcome = fields_of<Welcome>(bytes, header);
      agreed = welcome.actual;
      EXPECT_EQ(welcome.refusal,
                counts[type] == 1 ? ConnectionRefusal::kMismatch : ConnectionRefusal::kNone);
      EXPECT_TRUE(welcome.server.view().starts_with("hapticgiant simulate"));
    } else if (type == MessageType::kSensors) {
      const auto sensors = fields_of<SensorFrame>(bytes, header);
      EXPECT_TRUE(fits(agreed, sensors));
      EXPECT_EQ(sensors.sequence, next);
      EXPECT_NEAR(sensors.time_s, 1e-3 * static_cast<double>(next), 1e-9);
      EXPECT_NEAR(sensors.a_S.norm(), 9.8, 0.4);  // at rest
      EXPECT_NEAR(sensors.q_m[1], 1.5709, 1e-3);  // as the client printed it
    } else if (type == MessageType::kCommand) {
      const auto command = fields_of<CommandFrame>(bytes, header);
      EXPECT_TRUE(fits(agreed, command));
      EXPECT_TRUE(command.enable);
      EXPECT_EQ(command.sequence, next++);
    }
  }
  EXPECT_EQ(agreed.device.view(), "HapticGiant");
  EXPECT_EQ(agreed.interface, Interface::kTorque);
  EXPECT_EQ(counts[MessageType::kHello], 2);  // the first requests the description
  EXPECT_EQ(counts[MessageType::kReady], 1);
  EXPECT_EQ(counts[MessageType::kCommand], 20);
  EXPECT_EQ(counts[MessageType::kSensors], 21);
  EXPECT_GE(counts[MessageType::kGoodbye], 1);
}

TEST(Capture, WhatIsWrittenIsRead) {
  const std::string file = testing::TempDir() + "capture_test.pcap";
  std::array<std::byte, 3> bytes = {std::byte{1}, std::byte{2}, std::byte{3}};
  {
    Capture capture(file);
    capture.add(1'500'000'000, bytes);
    capture.add(1'600'000'000, std::span(bytes).first(1));
  }
  const auto datagrams = read_capture(file);
  ASSERT_EQ(datagrams.size(), 2U);
  EXPECT_TRUE(std::ranges::equal(datagrams[0], bytes));
  EXPECT_EQ(datagrams[1].size(), 1U);
  EXPECT_THROW(Capture("no_such_folder/file"), SetupError);
}

}  // namespace
}  // namespace hg::udp
