/// The layout of the messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <type_traits>

#include "hg/core/test/unit_words.h"
#include "hg/device/udp/codec.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/teleoperation_messages.h"

namespace hg::udp {
namespace {

/// Archive that expects each field at a multiple of its size, 8 bytes at most.
class Alignment {
 public:
  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const char* name, const T&, const char*, const Unit& = unit::kNone) {
    field(std::is_enum_v<T> || std::same_as<T, bool> ? 4 : sizeof(T), name);
  }
  template <std::size_t kSize>
  void operator()(const char* name, const Text<kSize>&, const char*, const Unit& = unit::kNone) {
    field(kSize, name);
  }
  template <int kRows, int kOptions, int kMaxRows>
  void operator()(const char* name, const Eigen::Matrix<double, kRows, 1, kOptions, kMaxRows, 1>&,
                  const char*, const Unit& = unit::kNone) {
    if constexpr (kRows == Eigen::Dynamic) {
      field(4, "count");
      zeros("zero");
    }
    field(8 * kMaxRows, name);
  }
  void zeros(const char* name) { field(4, name); }

  std::size_t offset = 0;

 private:
  void field(std::size_t size, const char* name) {
    EXPECT_EQ(offset % std::min<std::size_t>(size, 8), 0U) << name << " is not aligned";
    offset += size;
  }
};

TEST(Layout, EveryFieldIsAligned) {
  Alignment header;
  const Header fields_of_header{};
  layout(header, fields_of_header);
  EXPECT_EQ(header.offset, size_of<Header>());
  const auto expect_aligned = [&](const auto& message) {
    Alignment alignment{header};
    layout(alignment, message);
    EXPECT_EQ(alignment.offset % 4, 0U);
  };
  expect_aligned(Hello{});
  expect_aligned(Welcome{});
  expect_aligned(Ready{});
  expect_aligned(SensorFrame{});
  expect_aligned(CommandFrame{});
  expect_aligned(Goodbye{});
  expect_aligned(RoundTrip{});
  expect_aligned(Terms{});
  expect_aligned(LeaderMessage{});
  expect_aligned(RemoteMessage{});
}

TEST(Layout, EveryMessageFitsIntoADatagramThatNoNetworkDivides) {
  for (const std::size_t size :
       {size_of<Hello>(), size_of<Welcome>(), size_of<SensorFrame>(), size_of<CommandFrame>(),
        size_of<Goodbye>(), size_of<LeaderMessage>(), size_of<RemoteMessage>()}) {
    EXPECT_LE(size_of<Header>() + size + 4, kLargestDatagram);
  }
}

// What an archive with texts gets of each member that a frame sends.
struct Texts {
  std::set<std::string> names;
  template <typename T>
  void operator()(const char* name, const T&, const char* note, const Unit& = unit::kNone) {
    EXPECT_EQ(unit_word_in(note), "") << name;
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

TEST(Layout, TakesNamesAndNotesFromTheFieldsOfTheFrames) {
  const auto sensors = sent_names<SensorFrame>(), command = sent_names<CommandFrame>();
  EXPECT_EQ(sensors.size(), 20U);
  EXPECT_TRUE(sensors.contains("safety.override_key"));
  EXPECT_TRUE(sensors.contains("w_s"));
  EXPECT_EQ(command.size(), 15U);
  EXPECT_TRUE(command.contains("hand_target.p_b"));
  EXPECT_TRUE(command.contains("panel.reset"));
}

}  // namespace
}  // namespace hg::udp
