#include "hg/scenario/run/json_lines.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "hg/core/test/message_of.h"

namespace hg::scenario {
namespace {

using Json = nlohmann::ordered_json;

struct Pipe {
  Pipe() { EXPECT_EQ(pipe(ends.data()), 0); }
  ~Pipe() { close(ends[0]); }
  std::string read_all() const {
    std::string text(1 << 22, ' ');
    std::size_t size = 0;
    for (ssize_t n = 0; (n = read(ends[0], text.data() + size, text.size() - size)) > 0;) size += n;
    return text.substr(0, size);
  }
  std::array<int, 2> ends{};
};

TEST(LineWriter, WritesEachLine) {
  const Pipe pipe;
  {
    LineWriter writer(pipe.ends[1]);
    for (int i = 0; i < 100; ++i) writer.push("{}\n", Worth::kReport);
  }
  EXPECT_EQ(pipe.read_all().size(), 300U);
}

TEST(LineWriter, AReaderThatStallsHoldsNothingUpAndLearnsWhatIsLost) {
  const Pipe pipe;
  const std::string line = std::string(9999, 'x') + "\n";
  const auto start = std::chrono::steady_clock::now();
  std::string text;
  std::thread reader;
  {
    LineWriter writer(pipe.ends[1]);
    for (int i = 0; i < 300; ++i) writer.push(line, Worth::kReport);  // 3 MB
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
    reader = std::thread([&] { text = pipe.read_all(); });
  }
  reader.join();
  std::istringstream lines(text);
  int whole = 0, lost = 0;
  for (std::string each; std::getline(lines, each);) {
    if (each.size() == 9999) ++whole;
    if (each.starts_with("{\"lost\"")) lost += Json::parse(each)["lost"].get<int>();
  }
  EXPECT_GT(lost, 100);
  EXPECT_EQ(whole + lost, 300);
}

TEST(LineWriter, WithoutAReaderAtTheEndItGivesUp) {
  const Pipe pipe;
  const auto start = std::chrono::steady_clock::now();
  {
    LineWriter writer(pipe.ends[1]);
    for (int i = 0; i < 100; ++i) writer.push(std::string(9999, 'x') + "\n", Worth::kReport);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(LineWriter, AClosedReaderEndsNothing) {
  std::signal(SIGPIPE, SIG_DFL);  // would end this program
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  close(ends[0]);
  LineWriter writer(ends[1]);
  for (int i = 0; i < 10; ++i) {
    writer.push("{}\n", Worth::kReport);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(LineWriter, WhatIsNotOpenForWritingIsRefused) {
  const Pipe pipe;
  for (const int file : {-1, 1, 2, 999, pipe.ends[0]}) {
    EXPECT_NE(message_of([&] { LineWriter writer(file); }).find("--report-to: expected"),
              std::string::npos)
        << file;
  }
  close(pipe.ends[1]);
}

TEST(JsonObserver, EachReportIsAnObjectThatItsFirstKeyNames) {
  std::vector<std::string> lines;
  JsonObserver observer([&](const Json& report, Worth) { lines.push_back(to_line(report)); });
  observer.link("http://a");
  observer.phase(RunPhase::kMoving, 1.5, "turn the key");
  observer.event(2.0, "open", "it is \xff open");
  observer.fault({.time_s = 3.0, .fault = {.code = FaultCode::kEmergencyStop}, .figures = "f"});
  observer.note("stop", "Ctrl-C");
  observer.problem("no disk");
  observer.refused("bad");
  const Json summary = {{"state_hash", "1"}};
  observer.summary({.json = summary, .exit_code = 1});
  const std::vector<std::string> expected = {
      R"({"link":"http://a"})",
      R"({"phase":"moving","time_s":1.5,"wanted":"turn the key"})",
      "{\"event\":\"open\",\"time_s\":2.0,\"text\":\"it is \xef\xbf\xbd open\"}",
      R"({"fault":"emergency stop","code":)" +
          std::to_string(static_cast<int>(FaultCode::kEmergencyStop)) +
          R"(,"time_s":3.0,"figures":"f"})",
      R"({"note":"Ctrl-C","label":"stop"})",
      R"({"problem":"no disk"})",
      R"({"refused":"bad"})",
      R"({"summary":{"state_hash":"1"},"exit_code":1})"};
  ASSERT_EQ(lines.size(), expected.size());
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i], expected[i] + "\n");
}

}  // namespace
}  // namespace hg::scenario
