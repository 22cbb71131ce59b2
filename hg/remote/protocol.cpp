#include "hg/remote/protocol.h"

namespace hg::remote {

std::string printable(std::string_view text) {
  std::string result(text);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto byte = static_cast<unsigned char>(result[i]);
    const auto before = i > 0 ? static_cast<unsigned char>(result[i - 1]) : 0U;
    // U+0080..U+009F, in UTF-8 behind C2 or as single bytes, are control characters of terminals
    const bool is_behind = before >= 0x80U && before != 0xC2U;  // inside of another character
    const bool is_upper_control = byte >= 0x80U && byte < 0xA0U && !is_behind;
    if (byte >= 0x20U && byte != 0x7FU && !is_upper_control) continue;
    result[i] = '?';
    if (is_upper_control && before == 0xC2U) result[i - 1] = '?';
  }
  return result;
}

}  // namespace hg::remote
