#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "hg/core/test/temporary_folder.h"
#include "hg/live/channels.h"
#include "hg/live/frame.h"
#include "hg/viewer_server/test/raw_client.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::viewer_server {
namespace {

using Json = nlohmann::json;
using test::RawClient;

constexpr std::size_t kWrench = static_cast<std::size_t>(live::Topic::kUserWrench);
constexpr char kSdk[] = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n";

// Polls until `is_true`; gives up after a time that no machine needs.
bool eventually(const std::function<bool()>& is_true) {
  for (int i = 0; i < 20'000; ++i) {
    if (is_true()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

class LiveClientTest : public ::testing::Test {
 protected:
  LiveClientTest() : server_((write_page(), make_options()), make_scene()) {
    desk_.open();
    const std::string url = server_.url();
    const std::string port = url.substr(url.rfind(':') + 1);
    port_ = static_cast<std::uint16_t>(std::stoi(port));
    host_ = "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n";
    path_ = "/live?token=" + url.substr(url.find('=') + 1);
  }

  void write_page() const { folder_.write("page/index.html", "the page"); }

  ServerOptions make_options() {
    ServerOptions options;
    options.page = folder_.path() / "page";
    options.desk = &desk_;
    return options;
  }

  static Scene make_scene() {
    Scene scene;
    scene.title = "Test";
    scene.commands = {CommandName::kMode, CommandName::kSet, CommandName::kMark};
    scene.twin.urdf = "hg/viewer_server/test/hinge.urdf";
    scene.twin.joints = {{"hinge", JointType::kRevolute}};
    scene.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -2, -1.4), Eigen::Vector3d(1, 2, -0.4));
    Setting damping;
    damping.name = "hinge.damping";
    damping.max = 50.0;
    damping.value = 2.0;
    scene.settings = {damping};
    return scene;
  }

  std::string answer(const std::string& path, const std::string& headers) const {
    return RawClient(port_).upgrade(path, host_ + headers);
  }

  // After the greeting.
  std::unique_ptr<RawClient> open(int receive_buffer = 0) {
    auto client = std::make_unique<RawClient>(port_, receive_buffer);
    const std::string head = client->upgrade(path_, host_ + kSdk);
    EXPECT_TRUE(head.starts_with("HTTP/1.1 101")) << head;
    for (const char* op : {"serverInfo", "advertise", "advertiseServices"}) {
      EXPECT_EQ(Json::parse(client->read_message().text)["op"], op);
    }
    return client;
  }

  // Returns once the server has it: it answers in order.
  static void subscribe(RawClient& client, std::size_t channel) {
    const Json json = {{"op", "subscribe"},
                       {"subscriptions", {{{"id", 7}, {"channelId", channel + 1}}}}};
    client.send_message(json.dump());
    client.send_message(R"({"op":"getParameters","id":"subscribed"})");
    EXPECT_EQ(next(client, "parameterValues")["id"], "subscribed");
  }

  static std::string call(std::size_t service) {
    std::string frame("\x02", 1);
    live::append(frame, static_cast<std::uint32_t>(service + 1));
    live::append(frame, std::uint32_t{5});
    live::append(frame, std::uint32_t{3});
    return frame + "cdr";
  }

  // The next text with this operation, skipping others; null when the connection ends.
  static Json next(RawClient& client, const std::string& op) {
    for (int i = 0; i < 100'000; ++i) {
      const RawClient::Message message = client.read_message();
      if (message.opcode != 1 && message.opcode != 2) return {};
      if (message.opcode != 1) continue;
      Json json = Json::parse(message.text);
      if (json["op"] == op) return json;
    }
    return {};
  }

  const TemporaryFolder folder_;
  OperatorDesk desk_;
  ViewerServer server_;
  std::uint16_t port_ = 0;
  std::string host_, path_;
};

TEST_F(LiveClientTest, NeedsTheTokenAndASubprotocolAndNoOrigin) {
  EXPECT_TRUE(answer(path_, kSdk).starts_with("HTTP/1.1 101"));
  EXPECT_NE(answer(path_, "Sec-WebSocket-Protocol: x, foxglove.websocket.v1\r\n")
                .find("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"),
            std::string::npos);
  // a viewer that another server has delivered, or a file: the token decides
  EXPECT_TRUE(answer(path_, std::string("Origin: file://\r\n") + kSdk).starts_with("HTTP/1.1 101"));

  std::string wrong = path_;
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  EXPECT_TRUE(answer(wrong, kSdk).starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(answer("/live", kSdk).starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(answer(path_, "").starts_with("HTTP/1.1 400"));
  EXPECT_TRUE(RawClient(port_)
                  .upgrade(path_, std::string("Host: evil.example\r\n") + kSdk)
                  .starts_with("HTTP/1.1 403"));
}

TEST_F(LiveClientTest, GetsTheMessagesOfItsSubscriptions) {
  const auto client = open();
  subscribe(*client, kWrench);
  EXPECT_EQ(server_.live_wanted().count(), 1u);
  server_.publish_live(
      {.time_ns = 258,
       .messages = {{0, 258, live::to_bytes("other")}, {kWrench, 258, live::to_bytes("payload")}}});
  EXPECT_EQ(client->read_message().text, std::string("\x02\x02\x01\0\0\0\0\0\0", 9));  // the time
  EXPECT_EQ(client->read_message().text,
            std::string("\x01\x07\0\0\0\x02\x01\0\0\0\0\0\0payload", 20));
  client->close();
  EXPECT_TRUE(eventually([&] { return server_.live_wanted().none(); }));
  EXPECT_EQ(server_.counters().live, 0u);
}

TEST_F(LiveClientTest, AStopIsInForceWithoutTheProgram) {
  const auto client = open();
  client->send_message(call(3), 2);
  EXPECT_EQ(client->read_message().text[0], '\x03');
  EXPECT_EQ(desk_.holds(), 1u);
  const std::vector<Command> commands = server_.take_commands();
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_TRUE(commands[0].is_done);
}

TEST_F(LiveClientTest, OtherServicesAreAnsweredByTheProgram) {
  const auto client = open();
  client->send_message(call(1), 2);
  std::vector<Command> commands;
  ASSERT_TRUE(eventually([&] { return !(commands = server_.take_commands()).empty(); }));
  EXPECT_EQ(commands[0].name, CommandName::kMode);
  EXPECT_EQ(commands[0].argument, "arm");
  server_.answer(commands[0], "it is not ready");
  EXPECT_NE(client->read_message().text.find("it is not ready"), std::string::npos);
}

TEST_F(LiveClientTest, ChangesOfParametersReachThoseWhoWatch) {
  const auto client = open();
  client->send_message(R"({"op":"subscribeParameterUpdates","parameterNames":["hinge.damping"]})");
  client->send_message(
      R"({"op":"setParameters","parameters":[{"name":"hinge.damping","value":3}]})");
  std::vector<Command> commands;
  ASSERT_TRUE(eventually([&] { return !(commands = server_.take_commands()).empty(); }));
  EXPECT_EQ(commands[0].name, CommandName::kSet);
  EXPECT_EQ(commands[0].value, 3.0);
  server_.answer(commands[0], "");
  server_.set_values({3.0});
  const Json values = next(*client, "parameterValues");
  EXPECT_EQ(values["parameters"][0]["value"], 3.0);
}

TEST_F(LiveClientTest, TheUrdfIsAnAsset) {
  const auto client = open();
  client->send_message(
      R"({"op":"fetchAsset","uri":"package://hapticgiant/twin.urdf","requestId":1})");
  const std::string asset = client->read_message().text;
  EXPECT_EQ(asset.substr(0, 10), std::string("\x04\x01\0\0\0\0\0\0\0\0", 10));
  EXPECT_NE(asset.find("<robot"), std::string::npos);
}

TEST_F(LiveClientTest, ASlowClientLosesMessagesAndIsWarned) {
  const auto slow = open(4096);
  const auto quick = open();
  subscribe(*slow, kWrench);
  subscribe(*quick, kWrench);
  const auto bytes = live::to_bytes(std::string(50'000, 'x'));
  std::uint64_t number = 0;
  while (server_.counters().dropped < 10 && number < 10'000) {
    server_.publish_live({.time_ns = 0, .messages = {{kWrench, ++number, bytes}}});
    EXPECT_EQ(quick->read_message().opcode, 2);  // the slow one costs it nothing
  }
  EXPECT_GE(server_.counters().dropped, 10u);
  const std::string status = next(*slow, "status")["message"];
  EXPECT_NE(status.find("messages were dropped"), std::string::npos);
}

TEST_F(LiveClientTest, TheReferenceWrenchEndsWithItsClient) {
  auto client = open();
  client->send_message(
      R"({"op":"advertise","channels":[{"id":1,"topic":"/reference_wrench","encoding":"cdr"}]})");
  std::string frame("\x01\x01\0\0\0\0\x01\0\0", 9);  // message, channel 1, head of CDR
  frame += std::string(8, '\0');                     // stamp
  frame += std::string("\x05\0\0\0base\0", 9);
  frame += std::string(7, '\0');  // up to a multiple of 8 behind the head: 24
  for (const double value : {3.0, 0.0, 0.0, 0.0, 0.0, 0.0}) {
    frame.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  client->send_message(frame, 2);
  Vector6 w;
  std::uint64_t number = 0;
  ASSERT_TRUE(eventually([&] { return server_.take_reference_wrench(w, number); }));
  EXPECT_EQ(w[0], 3.0);
  EXPECT_NE(number, 0u);
  client->close();
  ASSERT_TRUE(eventually([&] { return server_.take_reference_wrench(w, number); }));
  EXPECT_TRUE(w.isZero(0.0));
  EXPECT_EQ(number, 0u);
}

TEST_F(LiveClientTest, ThereIsALimitOfClients) {
  std::vector<std::unique_ptr<RawClient>> clients;
  for (int i = 0; i < 16; ++i) clients.push_back(open());
  EXPECT_TRUE(answer(path_, kSdk).starts_with("HTTP/1.1 503"));
  clients.pop_back();
  EXPECT_TRUE(eventually([&] { return server_.counters().live == 15; }));
  EXPECT_TRUE(answer(path_, kSdk).starts_with("HTTP/1.1 101"));
}

TEST_F(LiveClientTest, RandomFramesDoNoHarm) {
  std::mt19937 random(2);
  const auto other = open();
  for (int client = 0; client < 5; ++client) {
    const auto noisy = open();
    for (int i = 0; i < 100; ++i) {
      std::string frame(random() % 200, '\0');
      for (char& byte : frame) byte = static_cast<char>(random());
      noisy->send_message(frame, random() % 2 == 0 ? 1 : 2);
    }
    noisy->send("\xff\xff\xff garbage in place of frames");
  }
  other->send_message(R"({"op":"getParameters","id":"x"})");
  EXPECT_EQ(next(*other, "parameterValues")["parameters"].size(), 1u);
}

}  // namespace
}  // namespace hg::viewer_server
