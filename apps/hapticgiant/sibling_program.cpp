#include "apps/hapticgiant/sibling_program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "hg/core/error.h"

namespace hg::apps {

namespace fs = std::filesystem;

void become_sibling(const std::string& name, const std::vector<std::string>& arguments,
                    const std::string& missing, const std::string& source) {
  std::error_code error;
  const fs::path own = fs::read_symlink("/proc/self/exe", error);
  const fs::path program = own.parent_path() / ("hapticgiant-" + name);
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(program.c_str(), pointers.data());
  if (errno != ENOENT) throw SetupError(program.string() + ": " + std::strerror(errno));
  throw SetupError(fmt::format("{}, since {} is missing: {}", missing, program.string(), source));
}

}  // namespace hg::apps
