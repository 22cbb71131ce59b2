#include "hg/device/franka/session.h"

#include <gtest/gtest.h>

#include <functional>

#include "hg/core/error.h"
#include "hg/device/franka/test/fake_robot.h"
#include "hg/device/franka/words.h"

namespace hg::franka {
namespace {

constexpr Timeouts kShort = {.connect_s = 10.0, .answer_s = 0.05, .first_state_s = 0.05};
constexpr Timeouts kLong = {.connect_s = 60.0, .answer_s = 60.0, .first_state_s = 60.0};

std::string refusal(const udp::Address& address, const Timeouts& timeouts) {
  try {
    const Session session(address, timeouts);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(Session, ConnectsAndGetsStates) {
  const FakeRobot robot;
  Session session(robot.address(), kLong);
  RobotState state;
  while (!session.receive(state)) session.wait(now_ns() + 1'000'000);
  EXPECT_EQ(state.robot_mode, RobotMode::kIdle);
  EXPECT_EQ(session.foreign(), 0U);
  EXPECT_FALSE(session.is_closed());
}

TEST(Session, NamesTheOtherVersion) {
  const FakeRobot robot({.version = 9});
  expect_says(refusal(robot.address(), kLong), "speaks version 9 of FCI, 10 is needed");
}

TEST(Session, TheRobotDecidesWhetherVersionsFit) {
  // franky-sim accepts and puts its version elsewhere; libfranka takes it as well
  const FakeRobot robot({.version = 2560, .accepts_any_version = true});
  EXPECT_EQ(refusal(robot.address(), kLong), "");
}

TEST(Session, NamesAClosedPort) {
  FakeRobot robot;
  const udp::Address address = robot.address();
  robot.stop();
  expect_says(refusal(address, kLong), "refuses the connection: activate FCI in Desk");
}

TEST(Session, NamesAnUnknownHost) {
  expect_says(refusal({"no.such.host.invalid", "1337"}, kLong), "no such host");
}

TEST(Session, NamesARobotThatDoesNotAnswer) {
  const FakeRobot robot({.answers = false});
  expect_says(refusal(robot.address(), kShort), "no answer to Connect within 0.05 s");
}

TEST(Session, NamesARobotWithoutStates) {
  const FakeRobot robot({.sends_states = false});
  Timeouts timeouts = kLong;
  timeouts.first_state_s = 0.05;
  expect_says(refusal(robot.address(), timeouts), "no state has come by UDP");
}

TEST(Session, ASecondClientIsRefused) {
  const FakeRobot robot;
  const Session first(robot.address(), kLong);
  expect_says(refusal(robot.address(), kShort), "does another program control the robot?");
}

TEST(Session, DatagramsThatAreNoStatesAreCounted) {
  FakeRobot robot({.sends_nonsense = true});
  Session session(robot.address(), kLong);
  RobotState state;
  while (session.foreign() == 0) {
    session.wait(now_ns() + 1'000'000);
    session.receive(state);
  }
  EXPECT_FALSE(session.is_closed());
}

TEST(Session, AnAnswerThatIsRefusedNamesWhatWasAsked) {
  EXPECT_EQ(answer_words(Command::kSetLoad, 2), "invalid argument");
  EXPECT_EQ(answer_words(Command::kAutomaticErrorRecovery, 3), "must be done by hand in Desk");
  EXPECT_EQ(answer_words(Command::kSetLoad, 9), "unknown status 9");
}

TEST(Words, NamesErrorsByTheirBits) {
  RobotState state{};
  EXPECT_EQ(to_string(errors_of(state)), "");
  state.errors[32] = 1;
  state.reflex_reason[kCommunicationError] = 1;
  EXPECT_EQ(to_string(errors_of(state)),
            "communication_constraints_violation, controller_torque_discontinuity");
  EXPECT_EQ(error_name(kErrors - 1), "base_acceleration_invalid_reading");
}

}  // namespace
}  // namespace hg::franka
