#include "apps/hapticgiant/paths.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::apps {
namespace fs = std::filesystem;

fs::path data_root() {
  std::error_code error;
  fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (fs::is_directory("models/scenarios", error)) return ".";
  for (fs::path folder = program.parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    if (fs::is_directory(folder / "models" / "scenarios", error)) return folder;
  }
  throw SetupError("models/scenarios: not found in the working directory or above the program");
}

fs::path find_scenario(const std::string& name) {
  std::error_code error;  // a name may be longer than the system takes
  if (fs::is_regular_file(name, error)) return name;
  const fs::path folder = data_root() / "models" / "scenarios";
  const fs::path known = folder / (name + ".yaml");
  if (fs::is_regular_file(known, error)) return known;

  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  throw SetupError(fmt::format("{}: no such scenario file, did you mean '{}'? Shipped are {}", name,
                               nearest_name(fs::path(name).stem().string(), names),
                               fmt::join(names, ", ")));
}

}  // namespace hg::apps
