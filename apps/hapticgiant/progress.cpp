#include "apps/hapticgiant/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include "apps/command_line/output.h"

namespace hg::apps {

Progress progress_of(const std::string& what) {
  if (isatty(STDERR_FILENO) == 0) return {};
  return [what](std::size_t done, std::size_t total) {
    draw_error(done < total ? fmt::format("{}: {} of {}", what, done, total) : "");
  };
}

}  // namespace hg::apps
