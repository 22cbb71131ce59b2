#include "hg/viewer_server/viewer_server.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "hg/core/error.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/viewer_server/test/raw_client.h"

namespace hg::viewer_server {
namespace {

using test::RawClient;

constexpr char kPause[] = R"({"type":"command","id":7,"command":"pause","name":"","value":0})";
constexpr char kHand[] = R"({"type":"hand","active":true,"p_B_m":[0.1,0.2,-1],"press":1})";

// Polls until `is_true`; gives up after a time that no machine needs.
bool eventually(const std::function<bool()>& is_true) {
  for (int i = 0; i < 20'000; ++i) {
    if (is_true()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

class ViewerServerTest : public ::testing::Test {
 protected:
  ViewerServerTest() : server_((write_page(), make_options()), make_scene()) {
    const std::string url = server_.url();
    const std::size_t colon = url.rfind(':');
    port_ = static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1)));
    token_ = url.substr(url.find('=') + 1);
    host_ = "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n";
    origin_ = "Origin: http://127.0.0.1:" + std::to_string(port_) + "\r\n";
    key_ = "Authorization: Bearer " + token_ + "\r\n";
    protocol_ = "Sec-WebSocket-Protocol: hapticgiant, token." + token_ + "\r\n";
  }

  // A page, and beside it a file that must stay secret.
  void write_page() const {
    folder_.write("page/index.html", "the page");
    folder_.write("page/assets/main.js", "the script");
    std::filesystem::create_symlink(folder_.write("secret.txt", "the secret"),
                                    folder_.path() / "page" / "link.txt");
  }

  ServerOptions make_options() {
    ServerOptions options;
    options.page = folder_.path() / "page";
    options.update_rate_hz = 1e6;  // tests publish faster than pages are shown
    options.desk = &desk_;
    return options;
  }

  static Scene make_scene() {
    Scene scene;
    scene.title = "Test";
    scene.commands = {CommandName::kStop,          CommandName::kPanel,       CommandName::kMode,
                      CommandName::kEmergencyStop, CommandName::kReleaseStop, CommandName::kClutch};
    scene.twin.urdf = "hg/viewer_server/test/hinge.urdf";
    scene.twin.joints = {{"hinge", JointType::kRevolute}};
    scene.box = Eigen::AlignedBox3d(Eigen::Vector3d(-1, -2, -1.4), Eigen::Vector3d(1, 2, -0.4));
    return scene;
  }

  std::string get(const std::string& target, const std::string& headers) const {
    return RawClient(port_).get(target, headers);
  }

  std::unique_ptr<RawClient> open_page(int receive_buffer = 0) {
    auto client = std::make_unique<RawClient>(port_, receive_buffer);
    const std::uint64_t before = server_.counters().clients;
    const std::string answer = client->upgrade("/ws", host_ + origin_ + protocol_);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 101")) << answer;
    EXPECT_TRUE(eventually([&] { return server_.counters().clients > before; }));
    const auto welcome = nlohmann::json::parse(client->read_message().text);
    EXPECT_EQ(welcome["type"], "welcome");
    newest_page_ = welcome["page"];
    return client;
  }

  // The next message of this type, skipping others; null when the connection ends.
  static nlohmann::json next(RawClient& client, const std::string& type) {
    for (int i = 0; i < 100'000; ++i) {
      const RawClient::Message message = client.read_message();
      if (message.opcode != 1) return {};
      auto json = nlohmann::json::parse(message.text);
      if (json["type"] == type) return json;
    }
    return {};
  }

  // A frame whose time is `time_s`, skipping older ones.
  static bool receives(RawClient& client, double time_s) {
    for (int i = 0; i < 100'000; ++i) {
      const nlohmann::json frame = next(client, "frame");
      if (frame.is_null()) return false;
      if (frame["time_s"] == time_s) return true;
    }
    return false;
  }

  void publish(double time_s) {
    View view;
    view.record.time_s = time_s;
    view.record.twin.q_a.setZero(1);
    server_.publish(std::move(view));
  }

  const TemporaryFolder folder_;
  OperatorDesk desk_;
  ViewerServer server_;
  std::uint16_t port_ = 0;
  std::string token_, host_, origin_, key_, protocol_;
  std::uint64_t newest_page_ = 0;  ///< its number
};

TEST_F(ViewerServerTest, TheLinkHasATokenOf128Bits) {
  EXPECT_EQ(server_.url(), "http://127.0.0.1:" + std::to_string(port_) + "/#token=" + token_);
  EXPECT_EQ(token_.size(), 32u);
}

TEST_F(ViewerServerTest, NothingOfTheRunIsServedWithoutTheToken) {
  std::string wrong = token_;
  wrong[0] = wrong[0] == '0' ? '1' : '0';
  const std::string paths[] = {"/scene.json", "/models/twin.urdf", "/x"};
  for (const std::string& path : paths) {
    EXPECT_TRUE(get(path, host_).starts_with("HTTP/1.1 403")) << path;
    const std::string others[] = {"Bearer ", "Bearer " + wrong, "Bearer " + token_ + "0", token_,
                                  "Basic " + token_};
    for (const std::string& other : others) {
      EXPECT_TRUE(get(path, host_ + "Authorization: " + other + "\r\n").starts_with("HTTP/1.1 403"))
          << path << " " << other;
    }
    // it is not looked for in addresses and cookies, which others see
    EXPECT_TRUE(get(path + "?token=" + token_, host_).starts_with("HTTP/1.1 403")) << path;
    const std::string cookie =
        "Cookie: hapticgiant_" + std::to_string(port_) + "=" + token_ + "\r\n";
    EXPECT_TRUE(get(path, host_ + cookie).starts_with("HTTP/1.1 403")) << path;
  }
  EXPECT_EQ(server_.counters().refused, 24u);
}

TEST_F(ViewerServerTest, ThePageNeedsNoTokenAndTheRunDoes) {
  const std::string answer = get("/", host_);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
  EXPECT_TRUE(answer.ends_with("the page"));
  EXPECT_NE(answer.find("Content-Security-Policy: default-src 'self'"), std::string::npos);
  EXPECT_EQ(answer.find("Set-Cookie"), std::string::npos);
  EXPECT_EQ(answer.find(token_), std::string::npos);
  EXPECT_TRUE(get("/assets/main.js", host_).ends_with("the script"));
  EXPECT_NE(get("/scene.json", host_ + key_).find("\"title\":\"Test\""), std::string::npos);
  EXPECT_NE(get("/models/twin.urdf", host_ + key_).find("<robot"), std::string::npos);
  EXPECT_EQ(server_.counters().refused, 0u);
}

TEST_F(ViewerServerTest, SilentConnectionsBlockNoOtherVisitor) {
  const auto page = open_page();
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(std::make_unique<RawClient>(port_));
    if (i % 2 == 0) idle.back()->send("GET / HTTP/1.1\r\nHost: ");  // half a request
  }
  const auto late = open_page();
  EXPECT_NE(get("/scene.json", host_ + key_).find("\"title\":\"Test\""), std::string::npos);
  publish(1.25);
  EXPECT_TRUE(receives(*page, 1.25));
  EXPECT_TRUE(receives(*late, 1.25));
  EXPECT_EQ(server_.counters().clients, 2u);
  EXPECT_EQ(idle.front()->read_answer(), "");  // the oldest have gone
  EXPECT_GE(server_.counters().refused, 150u);
}

TEST_F(ViewerServerTest, HalfARequestDoesNotLast) {
  RawClient slow(port_);
  const auto begin = std::chrono::steady_clock::now();
  slow.send("GET / HTTP/1.1\r\n" + host_);
  EXPECT_EQ(slow.read_answer(), "");  // patience of the client: 20 s
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

TEST_F(ViewerServerTest, AWrongHostIsRefused) {
  const std::string second = host_ + "Host: evil.example\r\n";
  for (const std::string& host : {std::string("Host: evil.example\r\n"),
                                  std::string("Host: 127.0.0.1\r\n"), second, std::string()}) {
    EXPECT_TRUE(get("/", host + key_).starts_with("HTTP/1.1 403")) << host;
    RawClient client(port_);
    EXPECT_TRUE(client.upgrade("/ws", host + origin_ + protocol_).starts_with("HTTP/1.1 403"));
  }
  EXPECT_EQ(server_.counters().refused, 8u);
}

TEST_F(ViewerServerTest, AWebSocketNeedsOwnOriginAndToken) {
  const auto answer = [&](const std::string& path, const std::string& headers) {
    return RawClient(port_).upgrade(path, host_ + headers);
  };
  const std::string none = "Sec-WebSocket-Protocol: hapticgiant\r\n";
  std::string wrong = protocol_;
  wrong[wrong.size() - 3] = wrong[wrong.size() - 3] == '0' ? '1' : '0';
  const std::string bad[] = {"Origin: http://evil.example\r\n" + protocol_,
                             protocol_,
                             origin_,
                             origin_ + none,
                             origin_ + wrong,
                             origin_ + key_};
  for (const std::string& headers : bad) {
    EXPECT_TRUE(answer("/ws", headers).starts_with("HTTP/1.1 403")) << headers;
  }
  EXPECT_TRUE(answer("/x", origin_ + protocol_).starts_with("HTTP/1.1 403"));
  EXPECT_TRUE(answer("/ws?token=" + token_, origin_).starts_with("HTTP/1.1 403"));
  EXPECT_EQ(server_.counters().refused, 8u);
  EXPECT_EQ(server_.counters().clients, 0u);
  const std::string good = answer("/ws", origin_ + protocol_);
  EXPECT_NE(good.find("Sec-WebSocket-Protocol: hapticgiant\r\n"), std::string::npos) << good;
}

TEST_F(ViewerServerTest, FilesOutsideThePageAreNotThere) {
  for (const char* path :
       {"/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt",
        "//etc/passwd", "/etc/passwd", "/link.txt", "/assets", "/models/../secret.txt", "/./"}) {
    const std::string answer = get(path, host_ + key_);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 404")) << path;
    EXPECT_EQ(answer.find("secret"), std::string::npos) << path;
  }
}

TEST_F(ViewerServerTest, OtherMethodsAndGarbageAreRefused) {
  RawClient post(port_);
  post.send("POST / HTTP/1.1\r\n" + host_ + key_ + "\r\n");
  EXPECT_TRUE(post.read_answer().starts_with("HTTP/1.1 405"));
  RawClient garbage(port_);
  garbage.send("\x16\x03\x01 not a request\r\n\r\n");
  EXPECT_EQ(garbage.read_answer(), "");
  RawClient large(port_);
  large.send("GET / HTTP/1.1\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n");
  EXPECT_EQ(large.read_answer(), "");
  EXPECT_EQ(server_.counters().refused, 3u);
}

TEST_F(ViewerServerTest, TwoPagesSeeTheNewestFrame) {
  const auto first = open_page();
  const auto second = open_page();
  publish(1.25);
  EXPECT_TRUE(receives(*first, 1.25));
  EXPECT_TRUE(receives(*second, 1.25));
  const auto late = open_page();
  EXPECT_TRUE(receives(*late, 1.25));
}

TEST_F(ViewerServerTest, EventsReachAlsoPagesThatConnectLater) {
  const auto first = open_page();
  server_.announce_event(2.5, "unlocked", "the lever is pressed");
  EXPECT_NE(first->read_message().text.find("\"unlocked\""), std::string::npos);
  const auto late = open_page();
  EXPECT_NE(late->read_message().text.find("\"unlocked\""), std::string::npos);
}

// Pages that stop and hold, while the program takes no command.
class DeskTest : public ViewerServerTest {
 protected:
  DeskTest() { desk_.open(); }

  static std::string command(const std::string& name, const std::string& argument, double value) {
    return nlohmann::json{
        {"type", "command"}, {"id", 1}, {"command", name}, {"name", argument}, {"value", value}}
        .dump();
  }
  // Why not; empty: done.
  std::string send_command(RawClient& page, const std::string& name, const std::string& argument,
                           double value = 0.0) const {
    page.send_message(command(name, argument, value));
    return next(page, "answer")["reason"];
  }
  static void hold(RawClient& page, int sequence) {
    page.send_message(R"({"type":"hold","sequence":)" + std::to_string(sequence) + "}");
  }
  static std::int64_t now_ns() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
  }
  SafetyPanel look() {
    SafetyPanel panel;
    desk_.look(now_ns(), panel);
    return panel;
  }
  // How long it is held, with `heartbeat` called every 20 ms; gives up after `most`.
  double held_s(double most, const std::function<void()>& heartbeat) {
    const std::int64_t begin = now_ns();
    while (look().override_key && 1e-9 * static_cast<double>(now_ns() - begin) < most) {
      heartbeat();
      for (int i = 0; i < 10 && look().override_key; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
    return 1e-9 * static_cast<double>(now_ns() - begin);
  }
};

TEST_F(DeskTest, StopsAreInForceWithoutTheProgram) {
  const auto page = open_page();
  EXPECT_EQ(send_command(*page, "emergency_stop", ""), "");
  EXPECT_TRUE(look().emergency_stop);
  EXPECT_EQ(send_command(*page, "panel", "operator_enable", 0.0), "");
  EXPECT_FALSE(look().operator_enable);
  EXPECT_EQ(send_command(*page, "mode", "hold"), "");
  EXPECT_EQ(desk_.holds(), 1u);
  page->send_message(command("stop", "", 0.0));  // answered by the program
  EXPECT_TRUE(eventually([&] { return desk_.end_was_asked(); }));
  EXPECT_EQ(desk_.stops(), 4u);

  const std::vector<Command> commands = server_.take_commands();
  ASSERT_EQ(commands.size(), 4u);
  EXPECT_TRUE(commands[0].is_done && commands[1].is_done && commands[2].is_done);
  EXPECT_FALSE(commands[3].is_done);
  EXPECT_EQ(commands[0].page, newest_page_);
  EXPECT_EQ(commands[1].stops, 2u);
}

TEST_F(DeskTest, AStopIsNeverOneCommandTooMany) {
  const auto page = open_page();
  for (int i = 0; i < 120; ++i) page->send_message(kPause);
  ASSERT_TRUE(eventually([&] { return server_.counters().refused > 20; }));
  page->send_message(command("emergency_stop", "", 0.0));
  EXPECT_TRUE(eventually([&] { return look().emergency_stop; }));
}

TEST_F(DeskTest, AnotherPageReleasesAStopByNameOnly) {
  const auto first = open_page();
  const auto number = static_cast<double>(newest_page_);
  const auto second = open_page();
  const auto other = static_cast<double>(newest_page_);
  EXPECT_NE(number, other);
  EXPECT_EQ(send_command(*first, "emergency_stop", ""), "");
  EXPECT_NE(send_command(*second, "release_stop", "", other), "");
  EXPECT_NE(send_command(*second, "release_stop", "", 0.0), "");
  EXPECT_NE(send_command(*second, "release_stop", "", -1.0), "");
  EXPECT_NE(send_command(*second, "release_stop", "", 0.5), "");
  EXPECT_NE(send_command(*second, "panel", "emergency_stop", 0.0), "");
  EXPECT_TRUE(look().emergency_stop);
  publish(1.0);
  const nlohmann::json safety = next(*second, "frame")["safety"];
  EXPECT_EQ(safety["stop_pressed_by"], nlohmann::json({number}));
  EXPECT_EQ(safety["emergency_stop"], true);
  first->close();
  ASSERT_TRUE(eventually([&] { return server_.counters().clients == 1; }));
  EXPECT_TRUE(look().emergency_stop);
  EXPECT_EQ(send_command(*second, "release_stop", "", number), "");
  EXPECT_FALSE(look().emergency_stop);
}

TEST_F(DeskTest, FortyEditsOfTwoPagesNeverReleaseTheStop) {
  const auto first = open_page();
  const auto second = open_page();
  EXPECT_EQ(send_command(*first, "emergency_stop", ""), "");
  for (int i = 0; i < 40; ++i) {
    const bool is_on = i % 4 < 2;
    RawClient& page = i % 2 == 0 ? *first : *second;
    EXPECT_EQ(send_command(page, "panel", "person_in_field", is_on ? 1.0 : 0.0), "");
    const SafetyPanel panel = look();
    EXPECT_TRUE(panel.emergency_stop) << i;
    EXPECT_EQ(panel.person_in_field, is_on) << i;
  }
}

TEST_F(DeskTest, WhatAPageHoldsIsLetGoWhenItIsSilent) {
  const auto page = open_page();
  int sequence = 0;
  // a page that a busy machine keeps from being heard loses what it holds, too: try again
  bool has_held = false;
  for (int i = 0; i < 50 && !has_held; ++i) {
    EXPECT_EQ(send_command(*page, "panel", "override_key", 1.0), "");
    has_held = held_s(0.5, [&] { hold(*page, ++sequence); }) > 0.45;
  }
  EXPECT_TRUE(has_held) << "heartbeats hold it beyond 100 ms";
  EXPECT_LT(held_s(60.0, [] {}), 50.0) << "silence without closing lets go";
  EXPECT_EQ(desk_.take_lost() & 2u, 2u);
}

TEST_F(DeskTest, OldSequenceNumbersHoldNothing) {
  const auto page = open_page();
  for (int sequence = 1; sequence <= 50; ++sequence) hold(*page, sequence);
  EXPECT_EQ(send_command(*page, "panel", "override_key", 1.0), "");
  const std::uint64_t refused = server_.counters().refused;
  int old = 0;
  EXPECT_LT(held_s(60.0, [&] { hold(*page, old = old % 50 + 1); }), 50.0);
  EXPECT_TRUE(eventually([&] { return server_.counters().refused > refused; }));
  EXPECT_FALSE(look().override_key);
}

TEST_F(DeskTest, OnlyThePageThatHasTheHandWorksTheClutch) {
  const auto first = open_page();
  const auto number = newest_page_;
  const auto second = open_page();
  EXPECT_EQ(send_command(*second, "clutch", "", 1.0), "") << "no page has the hand";
  EXPECT_TRUE(desk_.is_clutch_open());
  EXPECT_EQ(send_command(*second, "clutch", "", 0.5), "the clutch is 0 (closed) or 1 (open)");
  // a page that a busy machine keeps from being heard has lost the hand: try again
  std::string why_not;
  for (int i = 0; i < 50 && why_not.empty(); ++i) {
    first->send_message(kHand);
    EXPECT_EQ(send_command(*first, "clutch", "", 1.0), "");
    why_not = send_command(*second, "clutch", "", 0.0);
  }
  EXPECT_EQ(why_not, "page " + std::to_string(number) + " has the hand");
  first->send_message(kHand);
  EXPECT_EQ(send_command(*first, "clutch", "", 0.0), "");
  EXPECT_FALSE(desk_.is_clutch_open());
  desk_.close();
  EXPECT_EQ(send_command(*first, "clutch", "", 1.0), "the run is over: start it again");
}

TEST_F(DeskTest, ASwitchIsOnOrOff) {
  const auto page = open_page();
  EXPECT_EQ(send_command(*page, "panel", "override_key", 2.0), "a switch is 0 (off) or 1 (on)");
  SafetyPanel panel;
  desk_.look(0, panel);
  EXPECT_FALSE(panel.override_key);
}

TEST_F(DeskTest, AClosedPageLetsGoAtOnce) {
  const auto page = open_page();
  EXPECT_EQ(send_command(*page, "panel", "operator_enable", 1.0), "");
  page->close();
  ASSERT_TRUE(eventually([&] { return server_.counters().clients == 0; }));
  SafetyPanel panel;
  desk_.look(0, panel);  // no time has passed
  EXPECT_FALSE(panel.operator_enable);
}

TEST_F(DeskTest, BetweenRunsStopsCountForTheNextOneAndNothingElseIsTaken) {
  const auto page = open_page();
  desk_.close();
  EXPECT_NE(send_command(*page, "panel", "operator_enable", 1.0), "");
  EXPECT_EQ(desk_.stops(), 0u);
  EXPECT_EQ(send_command(*page, "panel", "operator_enable", 0.0), "");
  EXPECT_EQ(send_command(*page, "mode", "hold"), "");
  EXPECT_EQ(send_command(*page, "emergency_stop", ""), "");
  EXPECT_EQ(desk_.stops(), 3u);
  EXPECT_TRUE(look().emergency_stop);
}

TEST_F(ViewerServerTest, AHandTargetArrivesAndSilenceMakesItInactive) {
  const auto page = open_page();
  page->send_message(kHand);
  HandTarget target;
  ASSERT_TRUE(eventually([&] { return server_.take_hand_target(target); }));
  EXPECT_TRUE(target.active);
  EXPECT_EQ(target.p_B, Eigen::Vector3d(0.1, 0.2, -1.0));
  EXPECT_EQ(target.press, 1.0);
  ASSERT_TRUE(eventually([&] { return server_.take_hand_target(target); }));
  EXPECT_FALSE(target.active);
}

TEST_F(ViewerServerTest, AClosedPageLetsGo) {
  const auto page = open_page();
  page->send_message(kHand);
  HandTarget target;
  ASSERT_TRUE(eventually([&] { return server_.take_hand_target(target); }));
  page->close();
  ASSERT_TRUE(eventually([&] { return server_.counters().clients == 0; }));
  ASSERT_TRUE(server_.take_hand_target(target));
  EXPECT_FALSE(target.active);
}

TEST_F(ViewerServerTest, ACommandArrivesAndOnlyItsPageGetsTheAnswer) {
  const auto page = open_page();
  const auto other = open_page();
  page->send_message(kPause);
  std::vector<Command> commands;
  ASSERT_TRUE(eventually([&] { return !(commands = server_.take_commands()).empty(); }));
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].name, CommandName::kPause);
  EXPECT_TRUE(server_.take_commands().empty());

  server_.answer(commands[0], "");
  server_.answer(commands[0], "not now");
  const nlohmann::json accepted = next(*page, "answer");
  EXPECT_EQ(accepted["id"], 7);
  EXPECT_EQ(accepted["is_accepted"], true);
  EXPECT_EQ(next(*page, "answer")["reason"], "not now");
  server_.announce_event(1.0, "end", "");
  const nlohmann::json first = nlohmann::json::parse(other->read_message().text);
  EXPECT_EQ(first["type"], "event");
}

TEST_F(ViewerServerTest, TooManyCommandsAreRefusedWithAnAnswer) {
  const auto page = open_page();
  for (int i = 0; i < 120; ++i) page->send_message(kPause);
  EXPECT_TRUE(eventually([&] { return server_.counters().refused > 20; }));
  EXPECT_EQ(next(*page, "answer")["reason"], "too many commands");
  EXPECT_LE(server_.take_commands().size(), 64u);
}

TEST_F(ViewerServerTest, ARefusedMessageIsAnsweredWithItsReason) {
  const auto page = open_page();
  page->send_message("{");
  const nlohmann::json answer = next(*page, "answer");
  EXPECT_EQ(answer["id"], -1);
  EXPECT_EQ(answer["is_accepted"], false);
  EXPECT_NE(answer["reason"], "");
}

TEST_F(ViewerServerTest, ANewSceneReplacesTheOldOneAndItsEvents) {
  const auto page = open_page();
  server_.announce_event(1.0, "of the first run", "");
  EXPECT_EQ(next(*page, "event")["run"], 1);
  Scene scene = make_scene();
  scene.run = 2;
  scene.title = "Second";
  scene.twin.urdf.clear();
  server_.set_scene(scene);
  View view;
  view.run = 2;
  server_.publish(view);
  EXPECT_EQ(next(*page, "frame")["run"], 2);
  EXPECT_NE(get("/scene.json", host_ + key_).find("\"title\":\"Second\""), std::string::npos);
  EXPECT_TRUE(get("/models/twin.urdf", host_ + key_).starts_with("HTTP/1.1 404"));
  server_.announce_event(1.0, "of the second run", "");
  const auto late = open_page();
  EXPECT_EQ(next(*late, "event")["name"], "of the second run");

  scene.twin.urdf = "nowhere.urdf";
  EXPECT_THROW(server_.set_scene(scene), SetupError);
  EXPECT_NE(get("/scene.json", host_ + key_).find("Second"), std::string::npos);
}

TEST_F(ViewerServerTest, ValuesReachAllPagesAlsoLaterOnes) {
  const auto page = open_page();
  server_.set_values({1.5});
  EXPECT_EQ(next(*page, "values")["values"], nlohmann::json({1.5}));
  const auto late = open_page();
  EXPECT_EQ(next(*late, "values")["values"], nlohmann::json({1.5}));
}

TEST_F(ViewerServerTest, FourPagesSeeOneFrameAndHowManyTheyAre) {
  std::vector<std::unique_ptr<RawClient>> pages;
  for (int i = 0; i < 4; ++i) pages.push_back(open_page());
  publish(1.25);
  for (const auto& page : pages) EXPECT_EQ(next(*page, "frame")["clients"], 4);
}

TEST_F(ViewerServerTest, MalformedMessagesAreCountedAndTheConnectionLives) {
  const auto page = open_page();
  for (const char* text : {"", "{", "[1,2]", R"({"type":"hand"})", "\"quote"}) {
    page->send_message(text);
  }
  page->send_message(kHand, 2);  // binary
  EXPECT_TRUE(eventually([&] { return server_.counters().refused == 6; }));
  page->send_message(kHand);
  HandTarget target;
  EXPECT_TRUE(eventually([&] { return server_.take_hand_target(target); }));
  EXPECT_EQ(server_.counters().refused, 6u);
}

TEST_F(ViewerServerTest, MeasuresTheWayToTheSlowestPageAndBack) {
  EXPECT_TRUE(std::isnan(server_.counters().round_trip_s));
  const auto page = open_page();
  const auto silent = open_page();
  publish(1.5);
  RawClient::Message ping;
  while (ping.opcode != 9) ping = page->read_message(true);
  page->send_message("", 10);  // an answer to nothing
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  page->send_message(ping.text, 10);
  EXPECT_TRUE(eventually([&] { return !std::isnan(server_.counters().round_trip_s); }));
  EXPECT_GE(server_.counters().round_trip_s, 0.1);
  EXPECT_LT(server_.counters().round_trip_s, 10.0);
  page->close();
  EXPECT_TRUE(eventually([&] { return std::isnan(server_.counters().round_trip_s); }));
}

TEST_F(ViewerServerTest, AnOversizedMessageClosesThatConnectionOnly) {
  const auto page = open_page();
  const auto other = open_page();
  page->send_message(std::string(5000, ' '));
  const RawClient::Message message = page->read_message();
  ASSERT_EQ(message.opcode, 8);
  EXPECT_EQ(message.text.substr(0, 2), "\x03\xf1");  // 1009, message too big
  EXPECT_TRUE(eventually([&] { return server_.counters().clients == 1; }));
  EXPECT_EQ(server_.counters().refused, 1u);
  publish(3.5);
  EXPECT_TRUE(receives(*other, 3.5));
}

TEST_F(ViewerServerTest, AFloodIsRefusedAndTheConnectionLives) {
  const auto page = open_page();
  for (int i = 0; i < 5000; ++i) page->send_message(kHand);
  EXPECT_TRUE(eventually([&] { return server_.counters().refused > 0; }));
  publish(4.5);
  EXPECT_TRUE(receives(*page, 4.5));
}

TEST_F(ViewerServerTest, APageThatNeverReadsLosesFramesAndDelaysNoOther) {
  const auto slow = open_page(4096);
  double time_s = 0.0;
  EXPECT_TRUE(eventually([&] {
    for (int i = 0; i < 100; ++i) publish(time_s += 1e-3);
    return server_.counters().dropped > 1000;
  }));
  const auto other = open_page();
  publish(1e6);
  EXPECT_TRUE(receives(*other, 1e6));
}

TEST_F(ViewerServerTest, OnlyPagesThatAreNamedMayShowThePage) {
  EXPECT_NE(get("/", host_).find("frame-ancestors 'none'\r\n"), std::string::npos);
  ServerOptions options = make_options();
  options.embedders = {"http://127.0.0.1:8123"};
  const ViewerServer server(options, make_scene());
  const std::string url = server.url();
  const std::string host = url.substr(7, url.find("/#") - 7);
  const auto port = static_cast<std::uint16_t>(std::stoi(host.substr(host.find(':') + 1)));
  EXPECT_NE(RawClient(port)
                .get("/", "Host: " + host + "\r\n")
                .find("frame-ancestors http://127.0.0.1:8123\r\n"),
            std::string::npos);
}

TEST_F(ViewerServerTest, ATakenPortIsNamed) {
  ServerOptions options = make_options();
  options.port = port_;
  try {
    const ViewerServer second(options, make_scene());
    FAIL() << "no SetupError";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("port " + std::to_string(port_) + " is taken"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(ViewerServerTest, SetUpErrorsNameTheItem) {
  const auto message = [](const ServerOptions& options, const Scene& scene) -> std::string {
    try {
      const ViewerServer server(options, scene);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "no error";
  };
  ServerOptions options = make_options();
  options.page = folder_.path() / "nowhere";
  EXPECT_NE(message(options, make_scene()).find("index.html"), std::string::npos);
  Scene scene = make_scene();
  scene.twin.urdf = "nowhere.urdf";
  EXPECT_NE(message(make_options(), scene).find("twin URDF must be a file, got nowhere.urdf"),
            std::string::npos);
  scene = make_scene();
  scene.box.setEmpty();
  EXPECT_NE(message(make_options(), scene).find("box"), std::string::npos);
  options = make_options();
  options.update_rate_hz = 0.0;
  EXPECT_NE(message(options, make_scene()).find("update_rate_hz"), std::string::npos);
  options = make_options();
  options.address = "not an address";
  EXPECT_NE(message(options, make_scene()).find("not an address"), std::string::npos);
  options = make_options();
  options.address = "192.0.2.7";  // for documentation: no host has it
  EXPECT_NE(message(options, make_scene()).find("192.0.2.7"), std::string::npos);
  options = make_options();
  options.token = "not a token";
  EXPECT_NE(message(options, make_scene()).find("hexadecimal"), std::string::npos);
}

TEST_F(ViewerServerTest, FramesAreThinnedToTheUpdateRate) {
  ServerOptions options = make_options();
  options.update_rate_hz = 1e-3;  // one frame, and the next after 1000 s
  ViewerServer server(options, make_scene());
  RawClient page(static_cast<std::uint16_t>(std::stoi(server.url().substr(17))));
  const std::string own = "127.0.0.1:" + server.url().substr(17, server.url().find("/#") - 17);
  const std::string token = server.url().substr(server.url().find('=') + 1);
  page.upgrade("/ws", "Host: " + own + "\r\nOrigin: http://" + own +
                          "\r\nSec-WebSocket-Protocol: hapticgiant, token." + token + "\r\n");
  View view;
  for (view.record.time_s = 1.0; view.record.time_s < 100.0; view.record.time_s += 1.0) {
    server.publish(view);
  }
  server.announce_event(0.0, "end", "");
  page.read_message();  // the welcome
  const std::string first = page.read_message().text;
  const std::string second = page.read_message().text;
  EXPECT_NE((first + second).find("\"time_s\":1,"), std::string::npos) << first << second;
  EXPECT_NE((first + second).find("\"end\""), std::string::npos);
  EXPECT_EQ(server.counters().sent, 1u);
}

}  // namespace
}  // namespace hg::viewer_server
