/// Client and server over 127.0.0.1. Time-outs are generous: no test passes or fails by the clock.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "hg/core/allocation_counter.h"
#include "hg/device/udp/test/bad_link.h"
#include "hg/device/udp/test/example_messages.h"
#include "hg/device/udp/test/peers.h"

namespace hg::udp {
namespace {

// all frames of a run, as bits
std::vector<Datagram> play(device::Device& device, int periods) {
  std::vector<Datagram> frames;
  SensorFrame sensors;
  for (int i = 0; i < periods; ++i) {
    device.read(sensors);
    encode({}, sensors, frames.emplace_back());
    device.write(answer(sensors));
  }
  return frames;
}

void expect_same(const std::vector<Datagram>& a, const std::vector<Datagram>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(std::ranges::equal(a[i].view(), b[i].view())) << "frame " << i;
  }
}

TEST(Connection, InLockStepADeviceBehavesAsIfItWereHere) {
  TestDevice here;
  const std::vector<Datagram> expected = play(here, 2000);
  Serving serving(true);
  RemoteDevice there(serving.address(), client(true));
  EXPECT_EQ(there.welcome().server.view(), "test server");
  expect_same(play(there, 2000), expected);
  there.close(FaultCode::kNone);
  serving.await_sessions(1);
  const SessionReport& report = serving.reports[0];
  EXPECT_EQ(report.end, SessionEnd::kClientLeft);
  EXPECT_EQ(report.farewell, "done");
  EXPECT_EQ(report.periods, 2000U);
  EXPECT_TRUE(report.client.starts_with("test client at 127.0.0.1:")) << report.client;
  EXPECT_TRUE(serving.was_enabled && serving.ends_off);
}

TEST(Connection, ABadNetworkChangesNothingInLockStep) {
  TestDevice here;
  const std::vector<Datagram> expected = play(here, 300);
  for (unsigned seed = 0; seed < 3; ++seed) {
    SCOPED_TRACE(seed);
    Serving serving(true);
    const BadLink link(
        serving.address(),
        {.loses = 0.03, .doubles = 0.1, .swaps = 0.05, .cuts = 0.02, .corrupts = 0.02}, seed);
    RemoteDevice there(link.address(), client(true));
    expect_same(play(there, 300), expected);
    const LinkCounts counts = there.counts();
    EXPECT_GT(counts.repeated, 0U);
    EXPECT_GT(counts.lost, 0U);
    EXPECT_GT(counts.duplicate, 0U);
    EXPECT_GT(counts.corrupted + counts.truncated, 0U);
    EXPECT_EQ(counts.held, 0U);
  }
}

TEST(Connection, ASilentClientSwitchesTheDrivesOffAndIsInformed) {
  Serving serving(false, 0.05);
  RemoteDevice there(serving.address(), client(false));
  SensorFrame sensors;
  there.read(sensors);
  there.write(answer(sensors));
  serving.await_sessions(1);  // without another command
  EXPECT_EQ(serving.reports[0].end, SessionEnd::kClientSilent);
  EXPECT_TRUE(serving.was_enabled && serving.ends_off);
  for (int i = 0; i < 10000 && sensors.driver_fault == FaultCode::kNone; ++i) there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kCommandsLost);
  EXPECT_EQ(there.farewell(), "no command came in time: drives off, brakes closed");
}

TEST(Connection, ADeviceReportsHowLateCommandsComeEvenIfTooLateToBeFollowed) {
  Serving serving(false, 0.02);
  RemoteDevice there(serving.address(), client(false));
  SensorFrame sensors;
  there.read(sensors);
  EXPECT_TRUE(std::isnan(there.round_trip_s()));
  const CommandFrame command = answer(sensors);
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  there.write(command);
  while (sensors.driver_fault == FaultCode::kNone && std::isnan(there.round_trip_s())) {
    there.read(sensors);
  }
  EXPECT_GE(there.round_trip_s(), 0.06);
  EXPECT_LT(there.round_trip_s(), 0.5);
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].end, SessionEnd::kClientSilent);
  EXPECT_FALSE(serving.was_enabled);
}

TEST(Connection, ASilentClientEndsALockStepSessionToo) {
  Serving serving(true, 0.05);
  RemoteDevice there(serving.address(), client(true));
  SensorFrame sensors;
  there.read(sensors);
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].end, SessionEnd::kClientSilent);
  EXPECT_TRUE(serving.ends_off);
}

TEST(Connection, CommandsThatAreNotFiniteDoNotCount) {
  Serving serving(true, 0.2);
  RemoteDevice there(serving.address(), client(true));
  SensorFrame sensors;
  there.read(sensors);
  CommandFrame command = answer(sensors);
  command.tau_m[2] = std::numeric_limits<double>::quiet_NaN();
  there.write(command);
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].end, SessionEnd::kClientSilent);
  EXPECT_EQ(serving.reports[0].link.malformed, 1U);
  EXPECT_FALSE(serving.was_enabled);
}

TEST(Connection, AStoppedServerIsAFaultWithItsWords) {
  auto serving = std::make_unique<Serving>(true);
  RemoteDevice there(serving->address(), client(true));
  SensorFrame sensors;
  there.read(sensors);
  there.write(answer(sensors));
  serving->stop();
  EXPECT_EQ(serving->reports[0].end, SessionEnd::kStopped);
  for (int i = 0; i < 3 && sensors.driver_fault == FaultCode::kNone; ++i) there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kDeviceGone);
  EXPECT_EQ(there.farewell(), "the server was stopped");
}

TEST(Connection, ASilentDeviceIsAFaultAndNothingIsReadFromItAnyMore) {
  Script server;
  std::mt19937 random(1);
  SensorFrame frame = example_sensors(random, 5);
  frame.driver_fault = FaultCode::kNone;
  frame.q_p.conservativeResize(1);
  std::thread thread([&] {
    server.welcome(description(false));
    server.await(MessageType::kReady);
    server.send(frame, {.session = 7, .number = 2});
  });
  ClientConfig config = client(false);
  config.frame_timeout_s = 0.02;
  RemoteDevice there(server.address(), config);
  SensorFrame sensors;
  there.read(sensors);
  thread.join();
  EXPECT_EQ(sensors.driver_fault, FaultCode::kNone);
  const VectorM q_m = sensors.q_m;
  there.write(answer(sensors));  // enabled: nothing excuses a gap
  there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kDeviceSilent);
  EXPECT_EQ(sensors.sequence, 6U);
  EXPECT_EQ(sensors.q_m, q_m);
  frame.sequence = 6;
  server.send(frame, {.session = 7, .number = 3});
  there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kDeviceSilent);
}

TEST(Connection, ADeviceThatNeverSendsAFrameIsSilentWithVectorsOfTheRightSize) {
  Script server;
  std::thread thread([&] { server.welcome(description(false)); });
  ClientConfig config = client(false);
  config.first_timeout_s = 0.02;
  RemoteDevice there(server.address(), config);
  thread.join();
  SensorFrame sensors;
  there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kDeviceSilent);
  EXPECT_EQ(sensors.q_m.size(), 6);
  EXPECT_EQ(sensors.q_p.size(), 1);
}

TEST(Connection, WhatDoesNotBelongIsCountedAndIgnored) {
  Script server;
  std::mt19937 random(1);
  SensorFrame good = example_sensors(random, 5);
  good.driver_fault = FaultCode::kNone;
  good.q_p.conservativeResize(1);
  std::thread thread([&] {
    server.welcome(description(false));
    server.await(MessageType::kReady);
    const SensorFrame wrong_size = example_sensors(random, 5);  // two gantry axes
    server.send(wrong_size, {.session = 7, .number = 2});
    server.send(good, {.session = 8, .number = 3});
    server.send(good, {.version = kVersion + 1, .session = 7, .number = 4});
    server.send(good, {.magic = 1, .session = 7, .number = 5});
    server.send(Ready{}, {.session = 7, .number = 6});
    Datagram bytes;
    encode({.session = 7, .number = 7}, good, bytes);
    server.send_raw(bytes.view().first(50));
    bytes.bytes[60] ^= std::byte{1};
    server.send_raw(bytes.view());
    server.send(good, {.session = 7, .number = 8});
  });
  RemoteDevice there(server.address(), client(false));
  SensorFrame sensors;
  there.read(sensors);
  thread.join();
  EXPECT_TRUE(same_bits(sensors, good));
  const LinkCounts counts = there.counts();
  EXPECT_EQ(counts.malformed, 1U);
  EXPECT_EQ(counts.wrong_session, 1U);
  EXPECT_EQ(counts.wrong_version, 1U);
  EXPECT_EQ(counts.foreign, 2U);  // another magic, and a message that only clients send
  EXPECT_EQ(counts.truncated, 1U);
  EXPECT_EQ(counts.corrupted, 1U);
}

TEST(Connection, ASecondClientLearnsWhoHasTheDevice) {
  Serving serving(true);
  RemoteDevice first(serving.address(), client(true));
  SensorFrame sensors;
  first.read(sensors);
  const std::string message =
      message_of([&] { RemoteDevice second(serving.address(), client(true)); });
  EXPECT_NE(message.find("the device refuses: test client at 127.0.0.1:"), std::string::npos)
      << message;
  first.write(answer(sensors));  // and the first is not disturbed
  first.read(sensors);
  EXPECT_EQ(sensors.sequence, 1U);
  first.close(FaultCode::kNone);
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].link.refused, 1U);
  const RemoteDevice third(serving.address(), client(true));  // free again
}

TEST(Connection, AnotherDeviceRateOrTimeIsRefusedByItsName) {
  Serving serving(true);
  ClientConfig config = client(true);
  config.expected.n_m = 7;
  EXPECT_NE(message_of([&] {
              RemoteDevice there(serving.address(), config);
            }).find("the device refuses: joints: 6, expected 7"),
            std::string::npos);
  config = client(false);
  EXPECT_NE(message_of([&] {
              RemoteDevice there(serving.address(), config);
            }).find("time: lock-step (--fast), expected real time"),
            std::string::npos);
}

TEST(Connection, AServerThatWelcomesAllIsCheckedAllTheSame) {
  Script server;
  Description other = description(true);
  other.rate_Hz = 1000.0;
  std::thread thread([&] { server.welcome(other); });
  const std::string message =
      message_of([&] { RemoteDevice there(server.address(), client(true)); });
  thread.join();
  EXPECT_NE(message.find("does not fit: rate: 1000 Hz, expected 200 Hz"), std::string::npos)
      << message;
}

// The welcome that a server sends next.
Welcome next_welcome(UdpSocket& from_server) {
  Datagram datagram;
  Peer from;
  while (!from_server.receive(datagram, from)) from_server.wait(now_ns() + 1'000'000'000);
  Welcome welcome;
  EXPECT_TRUE(decode(datagram.view(), welcome));
  return welcome;
}

TEST(Connection, AnotherVersionIsNamedOnBothSides) {
  Script server;
  std::thread thread([&] {
    server.await(MessageType::kHello);
    server.send(Welcome{}, {.version = 9});
  });
  const std::string message =
      message_of([&] { RemoteDevice there(server.address(), client(true)); });
  thread.join();
  EXPECT_NE(message.find("speaks version 9 of the protocol, this program 2"), std::string::npos);

  Serving serving(true);
  UdpSocket old = UdpSocket::talking_to(serving.address());
  Datagram datagram;
  encode({.version = 9}, Hello{}, datagram);
  old.send(datagram.view());
  const Welcome welcome = next_welcome(old);
  EXPECT_EQ(welcome.refusal, ConnectionRefusal::kProtocol);
  EXPECT_EQ(welcome.reason.view(), "protocol: version 2, expected 9");
}

// Whoever forges the address of a sender must not make the server send more than that sender could.
TEST(Connection, AnswersHaveAtMostTwiceTheBytesOfTheQuestion) {
  constexpr std::size_t kNetwork = 28 + 4;  // headers of IPv4 and UDP, and the checksum
  EXPECT_LE(size_of<Welcome>() + size_of<Header>() + kNetwork,
            2 * (size_of<Hello>() + size_of<Header>() + kNetwork));
  Serving serving(true);
  UdpSocket other = UdpSocket::talking_to(serving.address());
  Datagram datagram;
  encode({.version = 9}, Ready{}, datagram);  // as short as can be, and made a hello
  const auto hello = static_cast<std::uint16_t>(MessageType::kHello);
  std::memcpy(datagram.bytes.data() + 6, &hello, sizeof hello);
  const std::uint32_t crc = checksum(datagram.view().first(datagram.size - sizeof crc));
  std::memcpy(datagram.bytes.data() + datagram.size - sizeof crc, &crc, sizeof crc);
  other.send(datagram.view());
  encode({.version = 8}, Hello{}, datagram);
  other.send(datagram.view());
  EXPECT_EQ(next_welcome(other).reason.view(), "protocol: version 2, expected 8")
      << "none to the first";
}

TEST(Connection, AMissingDeviceIsOneClearSentence) {
  std::string address;
  {
    const UdpSocket free = UdpSocket::listening_at({"127.0.0.1", "0"});
    address = to_string(free.own_address());
  }
  ClientConfig config = client(true);
  config.answer_timeout_s = 0.05;
  const std::string message =
      message_of([&] { RemoteDevice there(parse_address("test", address), config); });
  EXPECT_EQ(message, address +
                         ": no device answers there within 0.05 s; is its server running "
                         "(hapticgiant simulate --listen " +
                         address + ")?");
}

TEST(Connection, APortInUseIsNamed) {
  const UdpSocket first = UdpSocket::listening_at({"127.0.0.1", "0"});
  const std::string address = to_string(first.own_address());
  EXPECT_EQ(message_of([&] { UdpSocket::listening_at(parse_address("test", address)); }),
            address + ": cannot listen there: Address already in use");
}

TEST(ParseAddress, ReportsWhatItExpects) {
  EXPECT_EQ(parse_address("--listen", "[::1]:80").host, "::1");
  EXPECT_EQ(parse_address("--listen", "localhost:0").port, "0");
  for (const char* text :
       {"", ":", "host", "host:", ":80", "host:x", "::1:80", "host:-1", "[]:1"}) {
    EXPECT_EQ(message_of([&] { parse_address("--listen", text); }),
              "--listen: expected HOST:PORT, for example 127.0.0.1:4810, got '" +
                  std::string(text) + "'");
  }
  EXPECT_EQ(message_of([&] { parse_address("--listen", "host:65536"); }),
            "--listen: a port is at most 65535, got 'host:65536'");
}

TEST(Connection, ReadAndWriteAllocateNothing) {
  Serving serving(true);
  RemoteDevice there(serving.address(), client(true));
  SensorFrame sensors;
  there.read(sensors);
  CommandFrame command = answer(sensors);
  const AllocationCounter allocations;
  for (int i = 0; i < 200; ++i) {
    there.write(command);
    there.read(sensors);
    command.sequence = sensors.sequence;
  }
  EXPECT_EQ(allocations.count(), 0U);
}

}  // namespace
}  // namespace hg::udp
