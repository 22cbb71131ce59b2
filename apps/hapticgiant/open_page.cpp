#include "apps/hapticgiant/open_page.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "apps/command_line/output.h"
#include "hg/config/shipped_files.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

bool has_display() {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

// does not wait for it; no effect without xdg-open
void open_browser(const std::string& url) {
  std::string program = "xdg-open", link = url;
  char* const arguments[] = {program.data(), link.data(), nullptr};
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&silent, descriptor, "/dev/null", O_RDWR, 0);
  }
  pid_t process = 0;
  posix_spawnp(&process, program.c_str(), &silent, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&silent);
}

}  // namespace

std::string page_folder() { return (config::installation_root() / "viewer" / "dist").string(); }

std::string find_page() {
  const fs::path page = page_folder();
  std::error_code error;
  if (fs::is_regular_file(page / "index.html", error)) return page.string();
  print_out(
      "page        not built, running without it; with node 18 or newer:\n"
      "            cd viewer && npm ci && npm run build\n");
  return {};
}

void present_page(const std::string& url, const std::string& address, bool opens_browser) {
  print_out("page        " + url + "\n");
  if (!address.starts_with("127.") && address != "::1") {
    print_out("            WARNING: listening at " + address +
              ": whoever reaches it and has the link can move the hand; it is not encrypted\n");
  }
  if (opens_browser && has_display() && isatty(STDOUT_FILENO) == 1) open_browser(url);
}

}  // namespace hg::apps
