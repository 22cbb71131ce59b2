#include "hg/device/udp/text.h"

#include "hg/core/visible.h"

namespace hg::udp {

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t bytes = text[0] == '\n' || text[0] == '\t' ? 0 : shown_bytes(text);
    result += bytes == 0 ? "?" : text.substr(0, bytes);
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  return result;
}

}  // namespace hg::udp
