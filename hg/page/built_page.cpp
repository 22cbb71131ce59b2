#include "hg/page/built_page.h"

#include <filesystem>
#include <system_error>

#include "hg/config/shipped_files.h"

namespace hg::page {

namespace fs = std::filesystem;

std::string page_folder() { return (config::installation_root() / "viewer" / "dist").string(); }

std::string built_page() {
  const fs::path page = page_folder();
  std::error_code error;
  return fs::is_regular_file(page / "index.html", error) ? page.string() : std::string();
}

}  // namespace hg::page
