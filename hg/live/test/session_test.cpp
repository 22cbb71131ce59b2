#include "hg/live/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "hg/messages/cdr_reader.h"
#include "hg/messages/cdr_writer.h"
#include "hg/messages/ros_messages.h"

namespace hg::live {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kWrench = static_cast<std::size_t>(Topic::kUserWrench);
constexpr std::size_t kDescription = static_cast<std::size_t>(Topic::kDeviceDescription);

std::string text(const Json& json) { return json.dump(); }

template <HasFields Struct>
std::string message(std::uint32_t channel, const Struct& content) {
  std::string frame(1, '\x01');
  append(frame, channel);
  messages::CdrWriter cdr;
  const auto bytes = cdr.encode(content);
  return frame.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

class SessionTest : public ::testing::Test {
 protected:
  SessionTest() {
    board_.session = "1234";
    board_.parameters = {{"hinge.damping", "Nms/rad", 2.0, 0.0, 50.0},
                         {"hinge.lower", "rad", -INFINITY, -1.0, 1.0}};
    board_.find_asset = [this](std::string_view name) {
      return name == "package://hapticgiant/device.urdf" ? urdf_ : nullptr;
    };
  }

  Reaction take(const Json& json) { return session_.take(text(json), true); }
  static Json json_of(const Frame& frame) {
    EXPECT_TRUE(frame.is_text);
    return Json::parse(frame.head);
  }
  // The only frame of a reaction.
  static Json only(const Reaction& reaction) {
    EXPECT_EQ(reaction.frames.size(), 1u);
    return reaction.frames.empty() ? Json() : json_of(reaction.frames.front());
  }
  // A reaction that consists of one status message with `part` in it.
  static void expect_refused(const Reaction& reaction, const std::string& part) {
    EXPECT_TRUE(reaction.is_refused);
    EXPECT_TRUE(reaction.orders.empty());
    const Json status = only(reaction);
    EXPECT_EQ(status["op"], "status");
    EXPECT_EQ(status["level"], 1);
    EXPECT_NE(status["message"].get<std::string>().find(part), std::string::npos) << status;
  }
  Reaction set(const Json& value, const std::string& name = "hinge.damping") {
    return take({{"op", "setParameters"},
                 {"id", "s"},
                 {"parameters", {{{"name", name}, {"value", value}}}}});
  }
  void publish(std::string_view topic, std::uint32_t id) {
    const Reaction reaction =
        take({{"op", "advertise"},
              {"channels",
               {{{"id", id}, {"topic", topic}, {"encoding", "cdr"}, {"schemaName", "any"}}}}});
    EXPECT_FALSE(reaction.is_refused);
  }

  const Bytes urdf_ = to_bytes("<robot/>");
  Board board_;
  Session session_{board_};
};

TEST(ChosenProtocol, IsTheFirstKnownOne) {
  EXPECT_EQ(chosen_protocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(chosen_protocol("other, foxglove.sdk.v1 ,foxglove.websocket.v1"), "foxglove.sdk.v1");
  EXPECT_EQ(chosen_protocol("foxglove.sdk.v2"), "");
  EXPECT_EQ(chosen_protocol(""), "");
  EXPECT_EQ(chosen_protocol(",, ,"), "");
}

TEST_F(SessionTest, GreetsWithWhatItOffers) {
  const std::vector<Frame> greeting = session_.greeting();
  ASSERT_EQ(greeting.size(), 3u);
  const Json info = json_of(greeting[0]);
  EXPECT_EQ(info["op"], "serverInfo");
  EXPECT_EQ(info["sessionId"], "1234");
  EXPECT_EQ(info["supportedEncodings"], Json::array({"cdr"}));
  const Json offers = json_of(greeting[1])["channels"];
  EXPECT_EQ(offers.size(), kTopicCount);
  EXPECT_EQ(offers[kWrench]["topic"], "/user_wrench");
  EXPECT_EQ(offers[kWrench]["schemaName"], "geometry_msgs/msg/WrenchStamped");
  EXPECT_EQ(offers[static_cast<std::size_t>(Topic::kSample)]["topic"], "/hapticgiant/sample");
  EXPECT_EQ(offers[static_cast<std::size_t>(Topic::kTwinDescription)]["topic"],
            "/twin/robot_description");
  EXPECT_EQ(json_of(greeting[2])["services"][0]["name"], "/hapticgiant/tare");
}

TEST_F(SessionTest, SendsTheMessagesOfASubscriptionUntilItEnds) {
  EXPECT_FALSE(session_.wants(kWrench));
  take({{"op", "subscribe"}, {"subscriptions", {{{"id", 0}, {"channelId", kWrench + 1}}}}});
  ASSERT_TRUE(session_.wants(kWrench));
  const Frame frame = session_.frame_of({kWrench, 0x0102030405060708, to_bytes("payload")});
  EXPECT_FALSE(frame.is_text);
  EXPECT_EQ(frame.head, std::string("\x01\0\0\0\0\x08\x07\x06\x05\x04\x03\x02\x01", 13));
  EXPECT_EQ(*frame.payload, "payload");
  take({{"op", "unsubscribe"}, {"subscriptionIds", {0}}});
  EXPECT_FALSE(session_.wants(kWrench));
}

TEST_F(SessionTest, RefusesASecondSubscriptionToAChannelOrWithAnId) {
  const auto subscribe = [&](int id, int channel) {
    return take({{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}});
  };
  EXPECT_FALSE(subscribe(7, 1).is_refused);
  expect_refused(subscribe(8, 1), "channel 1");
  expect_refused(subscribe(7, 2), "subscription 7");
  expect_refused(subscribe(9, 0), "channelId");
  expect_refused(subscribe(9, kTopicCount + 1), "channelId");
  expect_refused(take({{"op", "unsubscribe"}, {"subscriptionIds", {99}}}), "no such subscription");
}

TEST_F(SessionTest, ANewSubscriberGetsTheLatchedMessage) {
  board_.latched[kDescription] = Message{kDescription, 5, to_bytes("text")};
  const Reaction reaction = take(
      {{"op", "subscribe"}, {"subscriptions", {{{"id", 3}, {"channelId", kDescription + 1}}}}});
  ASSERT_EQ(reaction.frames.size(), 1u);
  EXPECT_EQ(*reaction.frames[0].payload, "text");
}

TEST_F(SessionTest, ReadsParameters) {
  const Json all = only(take({{"op", "getParameters"}, {"parameterNames", Json::array()}}));
  EXPECT_EQ(all["parameters"].size(), 2u);
  EXPECT_EQ(all["parameters"][0]["value"], 2.0);
  EXPECT_EQ(all["parameters"][1]["value"], "unlimited");
  const Json one =
      only(take({{"op", "getParameters"}, {"parameterNames", {"hinge.damping"}}, {"id", "x"}}));
  EXPECT_EQ(one["parameters"].size(), 1u);
  EXPECT_EQ(one["id"], "x");
}

TEST_F(SessionTest, OrdersAChangeAndAnswersIt) {
  const Reaction reaction = set(3.5);
  EXPECT_TRUE(reaction.frames.empty());
  ASSERT_EQ(reaction.orders.size(), 1u);
  EXPECT_EQ(reaction.orders[0].name, "hinge.damping");
  EXPECT_EQ(reaction.orders[0].value, 3.5);
  const Json values = only(session_.answer(reaction.orders[0].id, ""));
  EXPECT_EQ(values["id"], "s");
  EXPECT_EQ(values["parameters"][0]["value"], 3.5);
  EXPECT_TRUE(session_.answer(reaction.orders[0].id, "").frames.empty());  // only once
}

TEST_F(SessionTest, AnswersARefusedChangeWithThePresentValue) {
  const double order = set(3.5).orders.at(0).id;
  const Reaction reaction = session_.answer(order, "the run is over");
  ASSERT_EQ(reaction.frames.size(), 2u);
  EXPECT_EQ(json_of(reaction.frames[0])["message"], "hinge.damping: the run is over");
  EXPECT_EQ(json_of(reaction.frames[1])["parameters"][0]["value"], 2.0);
}

TEST_F(SessionTest, RefusesValuesOutOfRangeWithTheRange) {
  for (const Json& value : {Json(50.5), Json(-0.1), Json("3"), Json(true), Json(), Json::array()}) {
    const Reaction reaction = set(value);
    EXPECT_TRUE(reaction.orders.empty()) << value;
    ASSERT_EQ(reaction.frames.size(), 2u) << value;
    const std::string status = json_of(reaction.frames[0])["message"];
    EXPECT_NE(status.find("0 .. 50 Nms/rad"), std::string::npos) << status;
    EXPECT_EQ(json_of(reaction.frames[1])["parameters"][0]["value"], 2.0);
  }
  const Reaction reaction = set(1.0, "hinge.dampng");
  ASSERT_EQ(reaction.frames.size(), 2u);
  const std::string status = json_of(reaction.frames[0])["message"];
  EXPECT_NE(status.find("'hinge.damping'"), std::string::npos) << status;
}

TEST_F(SessionTest, SendsAParameterToThoseWhoWatchIt) {
  EXPECT_TRUE(session_.changed_parameters({"hinge.damping"}).empty());
  const Json names = {"hinge.damping"};
  take({{"op", "subscribeParameterUpdates"}, {"parameterNames", names}});
  EXPECT_EQ(session_.changed_parameters({"hinge.damping", "hinge.lower"}).size(), 1u);
  take({{"op", "unsubscribeParameterUpdates"}, {"parameterNames", names}});
  EXPECT_TRUE(session_.changed_parameters({"hinge.damping"}).empty());
}

TEST_F(SessionTest, CallsAServiceAndAnswersIt) {
  std::string request("\x02", 1);
  append(request, std::uint32_t{2});   // arm
  append(request, std::uint32_t{77});  // call
  append(request, std::uint32_t{3});
  request += "cdr";
  request.append("\0\1\0\0\0", 5);
  const Reaction reaction = session_.take(request, false);
  ASSERT_EQ(reaction.orders.size(), 1u);
  EXPECT_EQ(reaction.orders[0].name, "arm");
  const Reaction answer = session_.answer(reaction.orders[0].id, "the sensor needs a tare");
  ASSERT_EQ(answer.frames.size(), 1u);
  const std::string& head = answer.frames[0].head;
  EXPECT_EQ(head.substr(0, 16), std::string("\x03\x02\0\0\0\x4d\0\0\0\x03\0\0\0cdr", 16));
  messages::TriggerResponse response;
  const std::string_view payload = std::string_view(head).substr(16);
  ASSERT_TRUE(messages::CdrReader(std::as_bytes(std::span(payload.data(), payload.size())))
                  .decode(response));
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message, "the sensor needs a tare");
}

TEST_F(SessionTest, TakesAStopHoweverManyRequestsWait) {
  const auto call = [&](std::size_t service) {
    std::string frame(1, '\x02');
    append(frame, static_cast<std::uint32_t>(service + 1));
    append(frame, std::uint32_t{7});
    append(frame, std::uint32_t{3});
    return session_.take(frame + "cdr", false);
  };
  const auto number = [](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(kServices, name) - kServices.begin());
  };
  int taken = 0;
  while (!call(number("tare")).orders.empty()) ASSERT_LT(++taken, 1000);
  const Reaction stop = call(number("stop"));
  ASSERT_EQ(stop.orders.size(), 1u);
  EXPECT_EQ(stop.orders.front().name, "stop");
}

TEST_F(SessionTest, ReportsTheFirstRefusalsOfAFrameOnly) {
  Json parameters = Json::array();
  for (int i = 0; i < 1000; ++i) {
    parameters.push_back({{"name", "unknown" + std::to_string(i)}, {"value", 1.0}});
  }
  const Reaction reaction = take({{"op", "setParameters"}, {"parameters", parameters}});
  EXPECT_TRUE(reaction.is_refused);
  EXPECT_EQ(reaction.refusals, 1000u);
  EXPECT_EQ(reaction.frames.size(), 11u);
}

TEST_F(SessionTest, AnswersAServiceThatDoesNotExist) {
  std::string request("\x02", 1);
  for (const std::uint32_t number : {99u, 5u, 3u}) append(request, number);
  request += "cdr";
  const Json failure = only(session_.take(request, false));
  EXPECT_EQ(failure["op"], "serviceCallFailure");
  EXPECT_EQ(failure["callId"], 5);
}

TEST_F(SessionTest, TakesAHandTargetInTheBaseOnly) {
  publish("/hand_target", 1);
  messages::PoseStamped pose;
  pose.header.frame_id = "base";
  pose.pose.position = {0.1, 0.2, -1.0};
  const Reaction reaction = session_.take(message(1, pose), false);
  ASSERT_TRUE(reaction.hand);
  EXPECT_TRUE(reaction.hand->active);
  EXPECT_TRUE(reaction.hand->turns);
  EXPECT_EQ(reaction.hand->p_B, Eigen::Vector3d(0.1, 0.2, -1.0));
  pose.pose.orientation.w = 0.0;
  EXPECT_FALSE(session_.take(message(1, pose), false).hand->turns);

  pose.header.frame_id = "map";
  expect_refused(session_.take(message(1, pose), false), "'map'");
  pose.header.frame_id = "base";
  pose.pose.position.x = NAN;
  expect_refused(session_.take(message(1, pose), false), "position");
  expect_refused(session_.take(message(1, messages::TextMessage{"no pose"}), false), "PoseStamped");
  expect_refused(session_.take(message(2, pose), false), "not advertised");

  const Reaction end = take({{"op", "unadvertise"}, {"channelIds", {1}}});
  ASSERT_TRUE(end.hand);
  EXPECT_FALSE(end.hand->active);
}

TEST_F(SessionTest, TakesAReferenceWrench) {
  publish("/reference_wrench", 4);
  messages::WrenchStamped wrench;
  wrench.wrench.force = {1.0, 2.0, 3.0};
  wrench.wrench.torque.z = 4.0;
  const Reaction reaction = session_.take(message(4, wrench), false);
  ASSERT_TRUE(reaction.wrench);
  EXPECT_EQ(*reaction.wrench, (Vector6() << 1, 2, 3, 0, 0, 4).finished());
  wrench.wrench.force.x = INFINITY;
  expect_refused(session_.take(message(4, wrench), false), "finite");
  EXPECT_TRUE(take({{"op", "unadvertise"}, {"channelIds", {4}}}).wrench->isZero(0.0));
}

TEST_F(SessionTest, RefusesToTakeOtherTopicsAndEncodings) {
  const auto advertise = [&](const char* topic, const char* encoding) {
    return take({{"op", "advertise"},
                 {"channels", {{{"id", 1}, {"topic", topic}, {"encoding", encoding}}}}});
  };
  expect_refused(advertise("/hand_targt", "cdr"), "'/hand_target'");
  expect_refused(advertise("/hand_target", "json"), "'json'");
}

TEST_F(SessionTest, SendsAssetsOfTheTableOnly) {
  const auto fetch = [&](const char* uri) {
    return take({{"op", "fetchAsset"}, {"requestId", 9}, {"uri", uri}});
  };
  const Reaction found = fetch("package://hapticgiant/device.urdf");
  ASSERT_EQ(found.frames.size(), 1u);
  EXPECT_EQ(found.frames[0].head, std::string("\x04\x09\0\0\0\0\0\0\0\0", 10));
  EXPECT_EQ(*found.frames[0].payload, *urdf_);
  const Reaction none = fetch("/etc/passwd");
  EXPECT_EQ(none.frames[0].head[5], '\x01');
  EXPECT_EQ(none.frames[0].payload, nullptr);
}

TEST_F(SessionTest, AnswersFramesThatMakeNoSense) {
  for (const char* frame : {"", "x", "[]", "3", "{\"op\":", "\xff\xfe", "{\"op\":7}", "{}"}) {
    const Reaction reaction = session_.take(frame, true);
    EXPECT_TRUE(reaction.is_refused) << frame;
    EXPECT_EQ(reaction.frames.size(), 1u) << frame;
  }
  expect_refused(take({{"op", "fly"}}), "'fly'");
  expect_refused(session_.take(std::string(60'000, '['), true), "JSON");
  expect_refused(session_.take("", false), "empty");
  expect_refused(session_.take("\x09", false), "got 9");
  expect_refused(session_.take(std::string("\x02\x01\0", 3), false), "too short");
}

// Whatever comes: nothing is thrown, every frame that is sent is well formed, and the session still
// works afterwards. Frames are random bytes, and right ones with random bytes in them.
TEST_F(SessionTest, SurvivesRandomFrames) {
  std::mt19937 random(1);
  const std::vector<std::string> right = {
      text({{"op", "subscribe"}, {"subscriptions", {{{"id", 1}, {"channelId", 3}}}}}),
      text({{"op", "unsubscribe"}, {"subscriptionIds", {1}}}),
      text({{"op", "advertise"},
            {"channels", {{{"id", 1}, {"topic", "/hand_target"}, {"encoding", "cdr"}}}}}),
      text({{"op", "setParameters"},
            {"id", "x"},
            {"parameters", {{{"name", "hinge.damping"}, {"value", 1.0}}}}}),
      text({{"op", "getParameters"}, {"parameterNames", {"hinge.damping"}}, {"id", "y"}}),
      text({{"op", "fetchAsset"}, {"uri", "package://x"}, {"requestId", 1}}),
      message(1, messages::PoseStamped{.header = {{}, "base"}}),
      message(1, messages::WrenchStamped{}),
      std::string("\x02\x01\0\0\0\x01\0\0\0\x03\0\0\0cdr\0\1\0\0\0", 21),
  };
  for (int i = 0; i < 20'000; ++i) {
    std::string frame;
    if (random() % 8 == 0) {
      frame.resize(random() % 64);
      for (char& byte : frame) byte = static_cast<char>(random());
    } else {
      frame = right[random() % right.size()];
      for (unsigned n = random() % 4; n > 0 && !frame.empty(); --n) {
        frame[random() % frame.size()] = static_cast<char>(random());
      }
      if (random() % 8 == 0) frame.resize(random() % (frame.size() + 1));
    }
    const Reaction reaction = session_.take(frame, random() % 2 == 0);
    for (const Frame& answer : reaction.frames) {
      EXPECT_TRUE(!answer.is_text || Json::accept(answer.head));
    }
    EXPECT_TRUE(!reaction.hand || reaction.hand->p_B.allFinite());
    EXPECT_TRUE(!reaction.hand || reaction.hand->R_B.allFinite());
    EXPECT_TRUE(!reaction.wrench || reaction.wrench->allFinite());
    for (const Order& order : reaction.orders) session_.answer(order.id, i % 2 == 0 ? "" : "no");
  }
  EXPECT_EQ(only(take({{"op", "getParameters"}, {"id", "z"}}))["id"], "z");
}

}  // namespace
}  // namespace hg::live
