#include "apps/hapticgiant/progress.h"

#include <fmt/format.h>
#include <unistd.h>

namespace hg::apps {

experiments::Progress progress_of(const std::string& what) {
  if (isatty(STDERR_FILENO) == 0) return {};
  return [what](std::size_t done, std::size_t total) {
    fmt::print(stderr, "{}: {} of {}{}", what, done, total, done < total ? " \r" : "\r\033[K");
  };
}

}  // namespace hg::apps
