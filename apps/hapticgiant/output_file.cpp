#include "apps/hapticgiant/output_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/version.h"

namespace hg::apps {
namespace {

// output to it follows the text printed before
bool is_standard_output(const std::string& file) {
  struct stat named {
  }, standard{};
  return stat(file.c_str(), &named) == 0 && fstat(STDOUT_FILENO, &standard) == 0 &&
         named.st_dev == standard.st_dev && named.st_ino == standard.st_ino;
}

}  // namespace

void write_output(const std::string& file, const std::string& text) {
  if (is_standard_output(file)) return print_out(text);
  write_whole_file(file, text, was_interrupted);
}

void write_json(const std::string& file, nlohmann::ordered_json json) {
  if (file.empty()) return;
  json["version"] = kVersion;
  write_output(file, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace hg::apps
