#include "hg/teleoperation/link_meter.h"

#include <gtest/gtest.h>

#include "hg/teleoperation/channel.h"

namespace hg::teleoperation {
namespace {

struct Packet {
  std::uint64_t sequence = 0;
  double sent_s = 0.0, answered_s = 0.0;
};

// Packets of another side whose clock shows `clock_s` more, sent once per millisecond.
LinkMeter measured(const ChannelConfig& link, double duration_s, double clock_s = 0.0) {
  constexpr double kPeriod = 1e-3;
  Channel<Packet> there(link, 0, kPeriod), back(link, 1, kPeriod);
  LinkMeter meter;
  Packet packet;
  double heard_s = 0.0;
  for (std::uint64_t k = 1; static_cast<double>(k) * kPeriod < duration_s; ++k) {
    const double now_s = static_cast<double>(k) * kPeriod;
    there.send({k, now_s, 0.0}, now_s);
    while (there.receive(now_s, packet)) heard_s = std::max(heard_s, packet.sent_s);
    back.send({k, now_s + clock_s, heard_s}, now_s);
    while (back.receive(now_s, packet)) {
      meter.receive(packet.sequence, packet.sent_s, packet.answered_s, now_s);
    }
    meter.step(now_s);
  }
  return meter;
}

TEST(LinkMeter, FindsTheDelayThereAndBack) {
  EXPECT_NEAR(measured({.delay = 0.1}, 3.0).round_trip(), 0.2, 2e-3);
  EXPECT_EQ(measured({.delay = 0.1}, 3.0).loss(), 0.0);
  EXPECT_NEAR(measured({.delay = 0.1}, 3.0).jitter(), 0.0, 1e-6);
}

TEST(LinkMeter, DoesNotNeedTheClockOfTheOther) {
  const LinkMeter meter = measured({.delay = 0.1, .jitter = 0.02}, 3.0, 1234.5);
  EXPECT_NEAR(meter.round_trip(), 0.21, 0.01);
  EXPECT_NEAR(meter.jitter(), 0.02 / 3.0, 0.005);
}

TEST(LinkMeter, FindsTheLossThoughPacketsOvertakeEachOther) {
  EXPECT_NEAR(measured({.delay = 0.05, .jitter = 0.02, .loss = 0.1}, 4.0).loss(), 0.1, 0.03);
}

TEST(LinkMeter, OfASilentLinkSaysThatAllIsLost) {
  const ChannelConfig silent = {.delay = 0.01, .outages = {{2.0, 9.0}}};
  EXPECT_EQ(measured(silent, 5.0).loss(), 1.0);
  EXPECT_LT(measured(silent, 1.9).loss(), 0.05);
}

}  // namespace
}  // namespace hg::teleoperation
