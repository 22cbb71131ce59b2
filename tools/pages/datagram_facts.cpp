#include "tools/pages/datagram_facts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <type_traits>

#include "hg/device/udp/codec.h"
#include "hg/device/udp/round_trip.h"
#include "hg/device/udp/teleoperation_messages.h"

namespace hg::pages {
namespace {

using namespace udp;

using Json = nlohmann::ordered_json;

// The archive that makes one row per field.
class Table {
 public:
  explicit Table(std::size_t offset) : offset_(offset) {}

  template <typename T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const char* name, const T&, const char* note, const Unit& unit = unit::kNone) {
    if constexpr (std::is_enum_v<T> || std::same_as<T, bool>) {
      row(4, "u32", name, note, unit);
    } else {
      row(sizeof(T), std::is_floating_point_v<T> ? "f64" : fmt::format("u{}", 8 * sizeof(T)), name,
          note, unit);
    }
  }
  template <std::size_t kSize>
  void operator()(const char* name, const Text<kSize>&, const char* note,
                  const Unit& unit = unit::kNone) {
    row(kSize, fmt::format("char[{}]", kSize), name, note, unit);
  }
  template <int kRows, int kOptions, int kMaxRows>
  void operator()(const char* name, const Eigen::Matrix<double, kRows, 1, kOptions, kMaxRows, 1>&,
                  const char* note, const Unit& unit = unit::kNone) {
    if constexpr (kRows == Eigen::Dynamic) {
      row(4, "u32", fmt::format("count of {}", name), fmt::format("0..{}", kMaxRows));
      zeros("zero");
    }
    row(8 * kMaxRows, fmt::format("f64[{}]", kMaxRows), name, note, unit);
  }
  void zeros(const char* name) { row(4, "u32", name, ""); }

  Json rows = Json::array();
  std::size_t end() const { return offset_; }

 private:
  void row(std::size_t size, const std::string& type, const std::string& name,
           const std::string& note, const Unit& unit = unit::kNone) {
    rows.push_back({offset_, type, name, unit.text(), note});
    offset_ += size;
  }
  std::size_t offset_;
};

template <typename Message>
Json message(const char* title) {
  Table table(size_of<Header>());
  const Message blank{};
  layout(table, blank);
  table.rows.push_back({table.end(), "u32", "checksum", "", ""});
  return {{"title", title},
          {"type", static_cast<int>(kTypeOf<Message>)},
          {"bytes", table.end() + 4},
          {"rows", table.rows}};
}

}  // namespace

Json datagram_facts() {
  Table header(0);
  const Header blank{};
  layout(header, blank);
  return {{{"title", "Header"}, {"rows", header.rows}},
          message<Hello>("Hello"),
          message<Welcome>("Welcome"),
          message<Ready>("Ready"),
          message<SensorFrame>("Sensors"),
          message<CommandFrame>("Command"),
          message<Goodbye>("Goodbye"),
          message<RoundTrip>("Round trip"),
          message<Terms>("Terms"),
          message<LeaderMessage>("Leader"),
          message<RemoteMessage>("Remote")};
}

}  // namespace hg::pages
