#include "hg/viewer_server/json_writer.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/core/visible.h"

namespace hg::viewer_server {

void JsonWriter::number(double value) {
  constexpr double kLargestRounded = 1e9;  // beyond it 1e-5 is less than the last bit, or nearly so
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  if (std::abs(value) < kLargestRounded) value = std::round(value * 1e5) / 1e5 + 0.0;
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

void JsonWriter::quoted(std::string_view words) { text += nlohmann::json(visible(words)).dump(); }

}  // namespace hg::viewer_server
