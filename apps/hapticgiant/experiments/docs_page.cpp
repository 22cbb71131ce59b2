#include "apps/hapticgiant/experiments/docs_page.h"

#include <string_view>

#include "apps/hapticgiant/output_file.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = "<!-- figures: begin -->\n", kEnd = "<!-- figures: end -->";

}  // namespace

void refresh_page(const fs::path& docs, const std::string& name, const std::string& text,
                  const fs::path& svg) {
  const fs::path page = docs / (name + ".md");
  std::string content = read_file(page);
  const std::size_t begin = content.find(kBegin), end = content.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw SetupError(page.string() +
                     ": must have the lines '<!-- figures: begin -->' and '<!-- figures: end -->'");
  }
  const std::size_t from = begin + kBegin.size();
  content.replace(from, end - from, "\n" + text + "\n");
  write_output(page.string(), content);
  std::error_code error;
  if (fs::exists(svg, error)) {
    fs::copy_file(svg, docs / (name + ".svg"), fs::copy_options::overwrite_existing);
  }
}

}  // namespace hg::apps
