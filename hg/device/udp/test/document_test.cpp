/// docs/device_protocol.md shows the fields of the code, byte by byte.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <type_traits>

#include "hg/device/udp/codec.h"

namespace hg::udp {
namespace {

/// Archive that writes a table.
class Table {
 public:
  explicit Table(std::size_t offset) : offset_(offset) {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const char* name, const T&, const char* note) {
    if constexpr (std::is_enum_v<T> || std::same_as<T, bool>) {
      row(4, "u32", name, note);
    } else {
      row(sizeof(T), std::is_floating_point_v<T> ? "f64" : fmt::format("u{}", 8 * sizeof(T)), name,
          note);
    }
  }
  template <std::size_t kSize>
  void operator()(const char* name, const Text<kSize>&, const char* note) {
    row(kSize, fmt::format("char[{}]", kSize), name, note);
  }
  template <int kRows, int kOptions, int kMaxRows>
  void operator()(const char* name, const Eigen::Matrix<double, kRows, 1, kOptions, kMaxRows, 1>&,
                  const char* note) {
    if constexpr (kRows == Eigen::Dynamic) {
      row(4, "u32", fmt::format("count of {}", name), fmt::format("0..{}", kMaxRows));
      zeros("zero");
    }
    row(8 * kMaxRows, fmt::format("f64[{}]", kMaxRows), name, note);
  }
  void zeros(const char* name) { row(4, "u32", name, ""); }

  std::string text = "| offset | type | field | |\n| ---: | --- | --- | --- |\n";
  std::size_t end() const { return offset_; }

 private:
  void row(std::size_t size, const std::string& type, const std::string& name,
           const std::string& note) {
    EXPECT_EQ(offset_ % std::min<std::size_t>(size, 8), 0U) << name << " is not aligned";
    text += fmt::format("| {} | {} | {} | {} |\n", offset_, type, name, note);
    offset_ += size;
  }
  std::size_t offset_;
};

template <typename Message>
std::string section(const char* title) {
  Table table(std::same_as<Message, Header> ? 0 : size_of<Header>());
  const Message message{};
  layout(table, message);
  if constexpr (std::same_as<Message, Header>) {
    return fmt::format("### Header\n\n{}", table.text);
  } else {
    return fmt::format("### {} (type {}, {} bytes)\n\n{}| {} | u32 | checksum | |\n", title,
                       static_cast<int>(kTypeOf<Message>), table.end() + 4, table.text,
                       table.end());
  }
}

TEST(Document, ShowsEveryMessageByteByByte) {
  std::ifstream file("docs/device_protocol.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  for (const std::string& table :
       {section<Header>("Header"), section<Hello>("Hello"), section<Welcome>("Welcome"),
        section<Ready>("Ready"), section<SensorFrame>("Sensors"), section<CommandFrame>("Command"),
        section<Goodbye>("Goodbye")}) {
    EXPECT_NE(document.find(table), std::string::npos) << "should stand there:\n\n" << table;
  }
}

// What an archive with texts gets of each member that a frame sends.
struct Texts {
  std::set<std::string> names;
  template <typename T>
  void operator()(const char* name, const T&, const char* note) {
    EXPECT_TRUE(names.insert(name).second) << name << " is sent twice";
    EXPECT_STRNE(note, "") << name;
  }
  void zeros(const char*) {}
};

template <typename Frame>
std::set<std::string> sent_names() {
  Texts texts;
  const Frame frame{};
  layout(texts, frame);
  return texts.names;
}

TEST(Document, TakesNamesAndNotesFromTheFieldsOfTheFrames) {
  const auto sensors = sent_names<SensorFrame>(), command = sent_names<CommandFrame>();
  EXPECT_EQ(sensors.size(), 20U);
  EXPECT_TRUE(sensors.contains("safety.override_key"));
  EXPECT_TRUE(sensors.contains("w_s"));
  EXPECT_EQ(command.size(), 15U);
  EXPECT_TRUE(command.contains("hand_target.p_b"));
  EXPECT_TRUE(command.contains("panel.reset"));
}

TEST(Document, EveryMessageFitsIntoADatagramThatNoNetworkDivides) {
  for (const std::size_t size : {size_of<Hello>(), size_of<Welcome>(), size_of<SensorFrame>(),
                                 size_of<CommandFrame>(), size_of<Goodbye>()}) {
    EXPECT_LE(size_of<Header>() + size + 4, kLargestDatagram);
  }
}

}  // namespace
}  // namespace hg::udp
