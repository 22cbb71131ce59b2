/// What either side makes of a peer that is not as it should be. No test passes or fails by the
/// clock.

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "hg/core/monotonic_clock.h"
#include "hg/device/udp/test/example_messages.h"
#include "hg/device/udp/test/peers.h"

namespace hg::udp {
namespace {

// In real time, with periods so long that no busy computer is late.
ClientConfig slow() {
  ClientConfig config = client(false);
  config.expected.rate_Hz = 2.0;
  return config;
}

TEST(Session, InRealTimeLostFramesAreFilledInAndNumbersContinue) {
  Script server;
  std::thread thread([&] { server.welcome(slow().expected); });
  RemoteDevice there(server.address(), slow());
  thread.join();
  std::mt19937 random(1);
  SensorFrame frame = example_sensors(random, 5);
  frame.driver_fault = FaultCode::kNone;
  frame.q_p.conservativeResize(1);
  // lost 7, 10, 11; swapped 8 and 9; doubled 12; they wait before the client looks for them
  std::uint64_t number = 1;
  for (const std::uint64_t sequence : {5U, 6U, 9U, 8U, 12U, 12U}) {
    frame.sequence = sequence;
    server.send(frame, {.session = 7, .number = ++number});
  }
  SensorFrame sensors;
  for (std::uint64_t sequence = 5; sequence <= 12; ++sequence) {
    there.read(sensors);
    ASSERT_EQ(sensors.driver_fault, FaultCode::kNone);
    ASSERT_EQ(sensors.sequence, sequence);
  }
  EXPECT_EQ(there.counts().held, 3U);
  EXPECT_EQ(there.counts().late, 1U);  // the second 12
}

// Frames at the times of a test.
class SlowLink : public testing::Test {
 protected:
  static constexpr std::chrono::milliseconds kPeriod{500};

  SlowLink() {
    std::thread thread([&] { server_.welcome(config_.expected); });
    there_ = std::make_unique<RemoteDevice>(server_.address(), config_);
    thread.join();
  }
  void send(std::uint64_t sequence) {
    frame_.sequence = sequence;
    server_.send(frame_, {.session = 7, .number = sequence});
  }
  void read(std::uint64_t sequence) {
    there_->read(sensors_);
    ASSERT_EQ(sensors_.driver_fault, FaultCode::kNone);
    ASSERT_EQ(sensors_.sequence, sequence);
  }

  std::unique_ptr<RemoteDevice> there_;

 private:
  static SensorFrame some_frame() {
    std::mt19937 random(1);
    SensorFrame frame = example_sensors(random, 5);
    frame.driver_fault = FaultCode::kNone;
    frame.q_p.conservativeResize(1);
    return frame;
  }

  const ClientConfig config_ = slow();
  Script server_;
  SensorFrame frame_ = some_frame(), sensors_;
};

TEST_F(SlowLink, ADelayOfTheDeviceIsNoneOfThisComputer) {
  send(2);
  read(2);
  std::this_thread::sleep_for(5 * kPeriod / 2);
  send(3);
  read(3);
  EXPECT_EQ(there_->counts().late, 1U);
  EXPECT_LT(there_->late_ns(), std::chrono::nanoseconds(kPeriod).count());
}

TEST_F(SlowLink, ADelayOfThisComputerIsNoneOfTheDevice) {
  send(2);
  read(2);
  send(3);
  send(4);
  std::this_thread::sleep_for(5 * kPeriod / 2);  // a cycle that takes long
  read(3);
  read(4);
  EXPECT_EQ(there_->counts().late, 0U);
  EXPECT_LT(there_->late_ns(), std::chrono::nanoseconds(kPeriod).count());
}

// As a thread that is not woken up: the frame is there, and read() does not return.
TEST_F(SlowLink, AReadThatReturnsLateIsLateHere) {
  send(2);
  read(2);
  std::thread device([&] {
    std::this_thread::sleep_for(kPeriod / 10);
    send(3);
  });
  const std::int64_t begin = now_ns();
  read(3);
  device.join();
  const std::int64_t most = now_ns() - begin - std::chrono::nanoseconds(kPeriod / 10).count();
  EXPECT_GE(there_->late_ns(), 0);
  EXPECT_LE(there_->late_ns(), most);  // not from the call of read()
  EXPECT_EQ(there_->counts().late, 0U);
}

TEST(Session, InRealTimeTheDeviceKeepsTheLastCommandAndIgnoresOldOnes) {
  Serving serving(false, kLong, 100);
  Voice voice(serving.address(), 1);
  voice.hello(false);
  voice.send(Ready{});
  const std::uint64_t first = voice.await<SensorFrame>().sequence;
  const Header newer{.session = voice.session, .number = 9};
  const Header overtaken{.session = voice.session, .number = 8};
  voice.send(command_for(first), newer);
  voice.send(command_for(first), overtaken);
  while (voice.await<SensorFrame>().answered_sequence != first) {
  }
  voice.await<SensorFrame>();  // the period before this one had no command of its own
  voice.send(Goodbye{}, {.session = voice.session, .number = 10});
  serving.await_sessions(1);
  EXPECT_GE(serving.reports[0].link.held, 1U);
  EXPECT_EQ(serving.reports[0].link.late, 1U);
}

TEST(Session, ACommandThatAnswersAFrameFromLongAgoIsLate) {
  constexpr double kTimeout = 60.0;  // 12000 periods
  constexpr std::uint64_t kFirst = 100'000;
  Serving serving(false, kTimeout, kFirst);
  Voice voice(serving.address(), 1);
  voice.hello(false);
  voice.send(Ready{});
  for (int i = 0; i < 3; ++i) voice.send(command_for(kFirst - 12'001));
  voice.send(Goodbye{});
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].end, SessionEnd::kClientLeft);
  EXPECT_EQ(serving.reports[0].link.late, 3U);
  EXPECT_FALSE(serving.was_enabled);
}

TEST(Session, AClientThatWorksThroughOldFramesIsSilent) {
  Serving serving(false, 0.05);
  Voice voice(serving.address(), 1);
  voice.hello(false);
  voice.send(Ready{});
  const std::uint64_t first = voice.await<SensorFrame>().sequence;
  for (int i = 0; i < 2000 && serving.sessions.load() == 0; ++i) {
    voice.send(command_for(first));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  voice.send(Goodbye{});
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].end, SessionEnd::kClientSilent);
}

TEST(Session, NothingThatIsSentFromElsewhereCounts) {
  Serving serving(false, kLong, 100);
  Voice voice(serving.address(), 1), other(serving.address(), 2);
  voice.hello(false);
  voice.send(Ready{});
  const std::uint64_t first = voice.await<SensorFrame>().sequence;
  other.session = voice.session;  // overheard
  for (std::uint64_t number = 50; number < 53; ++number) {
    other.send(command_for(first), {.session = other.session, .number = number});
  }
  other.send(Goodbye{}, {.session = other.session, .number = 60});
  voice.await<SensorFrame>();
  EXPECT_EQ(other.hello(false).refusal,
            ConnectionRefusal::kBusy);  // so that all before has been read
  voice.send(Goodbye{.reason = "of the client"});
  serving.await_sessions(1);
  const SessionReport& report = serving.reports[0];
  EXPECT_EQ(report.farewell, "of the client");
  EXPECT_EQ(report.link.from_others, 4U);
  EXPECT_EQ(report.link.duplicate, 0U);  // nor do their numbers count
  EXPECT_TRUE(report.other.starts_with("127.0.0.1:")) << report.other;
  EXPECT_FALSE(serving.was_enabled);
}

TEST(Session, ACommandThatAnswersAFrameOfTheFutureIsMalformed) {
  Serving serving(false, kLong, 100);
  Voice voice(serving.address(), 1);
  voice.hello(false);
  voice.send(Ready{});
  const std::uint64_t first = voice.await<SensorFrame>().sequence;
  voice.send(command_for(first + 1'000'000'000));
  voice.send(command_for(~std::uint64_t{0}));
  voice.send(Goodbye{});
  serving.await_sessions(1);
  EXPECT_EQ(serving.reports[0].link.malformed, 2U);
  EXPECT_FALSE(serving.was_enabled);
}

TEST(Session, HalfAHandshakeBlocksNoOtherClient) {
  Serving serving(true);
  std::vector<std::unique_ptr<Voice>> silent;
  for (std::uint64_t i = 0; i < 40; ++i) {
    silent.push_back(std::make_unique<Voice>(serving.address(), i));
    EXPECT_EQ(silent.back()->hello(true).refusal, ConnectionRefusal::kNone);
  }
  RemoteDevice there(serving.address(), client(true));
  SensorFrame sensors;
  there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kNone);
  EXPECT_EQ(silent.back()->await<Goodbye>().reason.view(), "test client has the device");
}

// an attacker without key replays recorded hellos; one who needs no key forges them
TEST(Session, AFloodOfHellosAfterTheWelcomeBlocksNoOtherClient) {
  const std::vector<std::byte> secret(32, std::byte{'k'});
  for (const Key& key : {Key(), Key(secret)}) {
    for (const bool is_replay : {false, true}) {
      Serving serving(true, kLong, 0, key);
      Voice client(serving.address(), 1'000, key);
      EXPECT_EQ(client.hello(true, "the client").refusal, ConnectionRefusal::kNone);
      std::vector<std::unique_ptr<Voice>> flood;
      for (std::uint64_t i = 0; i < 100; ++i) {
        flood.push_back(
            std::make_unique<Voice>(serving.address(), is_replay ? 1'000 : 2'000 + i, key));
        EXPECT_EQ(flood.back()->hello(true).refusal, ConnectionRefusal::kNone);
      }
      EXPECT_TRUE(client.begins());
      client.send(Goodbye{});
      serving.await_sessions(1);
      EXPECT_TRUE(serving.reports[0].client.starts_with("a client at 127.0.0.1:"));
    }
  }
}

TEST(Session, ANumberIsForOneAddress) {
  Serving serving(true);
  Voice client(serving.address(), 1), thief(serving.address(), 2);
  client.hello(true);
  thief.session = client.session;
  thief.send(Ready{});
  thief.hello(true);
  EXPECT_NE(thief.session, client.session);
  EXPECT_TRUE(client.begins());
}

TEST(Session, NothingBeginsWithoutAHello) {
  Serving serving(false);
  Voice voice(serving.address(), 1);
  voice.session = 0;  // of no session
  voice.send(Ready{});
  voice.send(command_for(0));
  EXPECT_EQ(voice.hello(false).refusal, ConnectionRefusal::kNone);  // not busy
  voice.send(Goodbye{});
  serving.stop();
  EXPECT_TRUE(serving.reports.empty());
}

TEST(Session, AReadyOfAnEndedSessionBeginsNothing) {
  Serving serving(false);
  Voice old(serving.address(), 1), young(serving.address(), 2), third(serving.address(), 3);
  old.hello(false, "old");
  old.send(Ready{});
  old.await<SensorFrame>();
  old.send(Goodbye{});
  serving.await_sessions(1);
  old.send(Ready{});
  EXPECT_EQ(young.hello(false, "young").refusal, ConnectionRefusal::kNone);
  old.send(Ready{});  // nor does it stand for the one of the next client
  EXPECT_EQ(third.hello(false).refusal, ConnectionRefusal::kNone);  // not even half a session
  young.send(Ready{});
  young.await<SensorFrame>();
  EXPECT_EQ(third.await<Goodbye>().reason.view(), "young has the device");
  EXPECT_EQ(third.hello(false).refusal, ConnectionRefusal::kBusy);
  young.send(Goodbye{});
  serving.await_sessions(2);
  serving.stop();
  ASSERT_EQ(serving.reports.size(), 2U);
  EXPECT_TRUE(serving.reports[1].client.starts_with("young at ")) << serving.reports[1].client;
}

TEST(Session, WordsFromTheNetworkCannotCommandATerminal) {
  Serving serving(false);
  Voice voice(serving.address(), 1), second(serving.address(), 2);
  voice.hello(false, "\x1B[2Jvoice");
  voice.send(Ready{});
  voice.await<SensorFrame>();
  EXPECT_TRUE(second.hello(false).reason.view().starts_with("?[2Jvoice at "));
  voice.send(Goodbye{.reason = "bye\r\x07"});
  serving.await_sessions(1);
  EXPECT_TRUE(serving.reports[0].client.starts_with("?[2Jvoice at ")) << serving.reports[0].client;
  EXPECT_EQ(serving.reports[0].farewell, "bye??");

  Script server;
  std::thread thread([&] {
    server.await(MessageType::kHello);
    Hello hello;
    (void)decode(server.datagram.view(), hello);
    server.send(Welcome{.nonce = hello.nonce,
                        .refusal = ConnectionRefusal::kMismatch,
                        .reason = "no\x1B]0;title"},
                {});
  });
  const std::string message =
      message_of([&] { RemoteDevice there(server.address(), client(true)); });
  thread.join();
  EXPECT_NE(message.find("the device refuses: no?]0;title"), std::string::npos) << message;

  Script other;  // the first may have another hello of the client that it refused
  std::thread again([&] { other.welcome(description(true)); });
  RemoteDevice there(other.address(), client(true));
  again.join();
  other.send(Goodbye{.reason = "\x1B[31mgone"}, {.session = 7, .number = 2});
  SensorFrame sensors;
  there.read(sensors);
  EXPECT_EQ(sensors.driver_fault, FaultCode::kDeviceGone);
  EXPECT_EQ(there.farewell(), "?[31mgone");
}

}  // namespace
}  // namespace hg::udp
