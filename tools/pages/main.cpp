/// hg_pages [--check]: writes what is generated from the code, from the root of the repository:
/// reference pages, tables in pages, and the TypeScript types of the viewer's messages.
///
/// With --check it writes nothing, prints what would change, and exits with 1 if anything would.
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <string_view>

#include "hg/core/open_file.h"
#include "tools/pages/configuration_page.h"
#include "tools/pages/datagram_tables.h"
#include "tools/pages/safety_tables.h"
#include "tools/pages/typescript.h"

namespace hg::pages {
namespace {

struct Page {
  const char* file;
  std::string (*text)(std::string committed);  ///< what the file should be
};

constexpr std::array kPages{
    Page{"docs/reference/configuration.md", [](std::string) { return configuration_page(); }},
    Page{"docs/reference/device_protocol.md", with_datagram_tables},
    Page{"docs/concepts/safety.md", with_safety_tables},
    Page{"viewer/src/messages.ts", [](std::string) { return typescript_text(); }},
};

// Prints the lines in which a file differs from `text`.
void print_difference(const std::string& file, const std::string& text) {
  std::fflush(stdout);
  std::FILE* diff = popen(("diff -u " + file + " -").c_str(), "w");
  if (diff == nullptr) return;
  std::fputs(text.c_str(), diff);
  pclose(diff);
}

int run(bool is_check) {
  int changed = 0;
  for (const Page& page : kPages) {
    const std::string committed = read_file(page.file);
    const std::string text = page.text(committed);
    if (text == committed) continue;
    ++changed;
    if (is_check) print_difference(page.file, text);
    if (!is_check) std::ofstream(page.file) << text;
  }
  std::printf("pages: %d of %zu %s\n", changed, kPages.size(),
              is_check ? "out of date" : "written");
  return is_check && changed > 0 ? 1 : 0;
}

}  // namespace
}  // namespace hg::pages

int main(int count, char** words) {
  try {
    return hg::pages::run(count > 1 && std::string_view(words[1]) == "--check");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
