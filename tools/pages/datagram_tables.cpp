#include "tools/pages/datagram_tables.h"

#include <fmt/format.h>

#include <type_traits>

#include "hg/device/udp/codec.h"
#include "tools/pages/marks.h"

namespace hg::pages {
namespace {

using namespace udp;

// The archive that writes one row per field.
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
    text += fmt::format("| {} | {} | {} | {} |\n", offset_, type, name, note);
    offset_ += size;
  }
  std::size_t offset_;
};

template <typename Message>
std::string section(const char* title) {
  Table table(size_of<Header>());
  const Message message{};
  layout(table, message);
  return fmt::format("\n### {} (type {}, {} bytes)\n\n{}| {} | u32 | checksum | |\n", title,
                     static_cast<int>(kTypeOf<Message>), table.end() + 4, table.text, table.end());
}

}  // namespace

std::string with_datagram_tables(std::string page) {
  Table header(0);
  const Header fields_of_header{};
  layout(header, fields_of_header);
  replace_marked(page, "messages",
                 "### Header\n\n" + header.text + section<Hello>("Hello") +
                     section<Welcome>("Welcome") + section<Ready>("Ready") +
                     section<SensorFrame>("Sensors") + section<CommandFrame>("Command") +
                     section<Goodbye>("Goodbye"));
  return page;
}

}  // namespace hg::pages
