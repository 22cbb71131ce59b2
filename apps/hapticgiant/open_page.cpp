#include "apps/hapticgiant/open_page.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>

#include "apps/command_line/output.h"
#include "hg/page/built_page.h"

namespace hg::apps {
namespace {

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

std::string find_page() {
  std::string page = page::built_page();
  if (page.empty()) print_out("page        {}\n", page::kNoPage);
  return page;
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
