#include "tools/pages/marks.h"

#include "hg/core/error.h"

namespace hg::pages {

void replace_marked(std::string& page, std::string_view name, std::string_view text) {
  const std::string mark = "<!-- " + std::string(name) + " -->\n";
  const std::size_t begin = page.find(mark);
  const std::size_t end = page.find("<!-- end -->", begin);
  if (begin == std::string::npos || end == std::string::npos) {
    throw SetupError("page: expected the marks <!-- " + std::string(name) +
                     " --> and <!-- end -->");
  }
  const std::size_t first = begin + mark.size();
  page.replace(first, end - first, "\n" + std::string(text) + "\n");
}

}  // namespace hg::pages
