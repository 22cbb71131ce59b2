#include "hg/config/shipped_files.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace hg::config {
namespace fs = std::filesystem;

namespace {

// Of the YAML files in a folder whose stem begins with `prefix`, what follows it; sorted.
std::vector<std::string> names_in(const fs::path& folder, std::string_view prefix) {
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() != ".yaml" || !stem.starts_with(prefix)) continue;
    names.push_back(stem.substr(prefix.size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

// Names of the folders in a folder that hold this file; sorted.
std::vector<std::string> folders_with(const std::string& file, const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (fs::exists(entry.path() / file, error)) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void refuse_folder(const std::string& name, std::string_view kind) {
  std::error_code error;
  if (!fs::is_directory(name, error)) return;
  throw SetupError(fmt::format("{}: is a folder, expected a {} file", name, kind));
}

// Keys at the beginning of a line, one of which files of a kind have.
using Keys = std::initializer_list<const char*>;
constexpr Keys kOfScenarios = {"title"};
constexpr Keys kOfOwnScenarios = {"person"};  // other files of users may have titles
constexpr Keys kOfTwins = {"end_effector", "free_body"};
constexpr Keys kOfDevices = {"manipulator"};

// The first line of a file that gives one of the keys, without the key; empty: none does.
std::optional<std::string> value_in(const fs::path& file, Keys keys) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    for (const char* key : keys) {
      const std::string begin = fmt::format("{}:", key);
      if (!line.starts_with(begin)) continue;
      const std::size_t at = std::min(line.find_first_not_of(' ', begin.size()), line.size());
      return line.substr(at);
    }
  }
  return {};
}

std::string title_of(const fs::path& file) {
  return value_in(file, {"title", "name"}).value_or("");
}

std::vector<std::string> arm_names() {
  return folders_with("device.yaml", models_root() / "models" / "arms");
}

// Names of the files in models/arms/ARM that have one of the keys; without keys all.
std::vector<std::string> names_of_arm(const std::string& arm, Keys keys) {
  const fs::path folder = models_root() / "models" / "arms" / arm;
  std::vector<std::string> names = names_in(folder, "");
  std::erase_if(names, [&](const std::string& name) {
    return keys.size() != 0 && !value_in(folder / (name + ".yaml"), keys);
  });
  return names;
}

constexpr int kMostLookedAt = 1000;           // files of a folder
constexpr std::uintmax_t kLargest = 4 << 20;  // bytes of a configuration file

std::vector<fs::path> yaml_files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  int looked_at = 0;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (++looked_at > kMostLookedAt) break;
    std::error_code ignored;
    const bool is_candidate = entry->path().extension() == ".yaml" &&
                              entry->is_regular_file(ignored) &&
                              entry->file_size(ignored) <= kLargest;
    if (is_candidate) files.push_back(entry->path().lexically_normal());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// The working directory and its folders.
std::vector<fs::path> local_folders() {
  std::vector<fs::path> folders = {"."};
  std::error_code error;
  for (fs::directory_iterator entry(".", error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (folders.size() > kMostLookedAt) break;
    if (entry->is_directory(ignored)) folders.push_back(entry->path());
  }
  return folders;
}

// Those of all arms, as "ARM/NAME".
void add_of_arms(Keys keys, std::vector<ShippedFile>& found) {
  const fs::path arms = models_root() / "models" / "arms";
  for (const std::string& arm : arm_names()) {
    for (const std::string& name : names_of_arm(arm, keys)) {
      found.push_back({fmt::format("{}/{}", arm, name), title_of(arms / arm / (name + ".yaml"))});
    }
  }
}

// Refuses "ARM/NAME" of a shipped arm, with its nearest file; or of another arm, "ur5/drawer", with
// the nearest arm that has such a file.
void refuse_of_arm(const std::string& name, std::string_view kind, Keys keys) {
  const fs::path path = name, arm = path.parent_path();
  if (arm.empty()) return;
  if (const auto own = names_of_arm(arm.string(), keys); !own.empty()) {
    throw SetupError(fmt::format("{}: no such {} file, did you mean '{}/{}'? Of {} there are {}",
                                 name, kind, arm.string(), nearest_name(path.stem().string(), own),
                                 arm.string(), fmt::join(own, ", ")));
  }
  std::error_code error;
  const bool is_file = path.extension() == ".yaml" || fs::exists(arm, error);
  if (is_file || arm.has_parent_path() || keys.size() == 0) return;
  std::vector<ShippedFile> of_arms;
  add_of_arms(keys, of_arms);
  std::vector<std::string> all, same;
  for (const ShippedFile& file : of_arms) {
    all.push_back(file.name);
    if (fs::path(file.name).filename() == path.filename()) same.push_back(file.name);
  }
  throw SetupError(fmt::format("{}: no such {} file, did you mean '{}'? Arms are {}", name, kind,
                               nearest_name(name, same.empty() ? all : same),
                               fmt::join(arm_names(), ", ")));
}

// A file, or the shipped one of this name in models/KINDs: NAME.yaml, or where `has_folder`
// NAME/KIND.yaml; or that of a shipped arm, "fr3/drawer". `words` is what the option takes beside.
fs::path find_shipped(const std::string& name, std::string_view kind, Keys keys,
                      bool has_folder = false, const std::vector<std::string>& words = {}) {
  std::error_code error;  // a name may be longer than the system takes
  if (fs::is_regular_file(name, error)) return name;
  const fs::path folder = models_root() / "models" / fmt::format("{}s", kind);
  const fs::path known =
      has_folder ? folder / name / fmt::format("{}.yaml", kind) : folder / (name + ".yaml");
  if (fs::is_regular_file(known, error)) return known;
  const fs::path of_arm = models_root() / "models" / "arms" / (name + ".yaml");
  if (fs::is_regular_file(of_arm, error)) return of_arm;

  refuse_folder(name, kind);
  refuse_of_arm(name, kind, keys);
  const std::vector<std::string> shipped =
      has_folder ? folders_with(fmt::format("{}.yaml", kind), folder) : names_in(folder, "");
  std::vector<std::string> names = words;
  names.insert(names.end(), shipped.begin(), shipped.end());
  throw SetupError(fmt::format("{}: no such {} file, did you mean '{}'? Shipped are {}", name, kind,
                               nearest_name(fs::path(name).stem().string(), names),
                               fmt::join(shipped, ", ")));
}

// The folder of an installed Python package that holds this code; empty: this is a program.
fs::path package_root() {
  static constexpr char kHere = 0;
  Dl_info library{};
  if (dladdr(&kHere, &library) == 0 || library.dli_fname == nullptr) return {};
  const fs::path file = library.dli_fname;
  std::error_code error;
  const fs::path share = file.parent_path() / "share" / "hapticgiant";
  return file.extension() == ".so" && fs::is_directory(share, error) ? share : fs::path();
}

}  // namespace

fs::path installation_root() {
  if (const fs::path package = package_root(); !package.empty()) return package;
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return {};
  if (fs::equivalent(folder, HG_BUILD_FOLDER, error)) return HG_SOURCE_FOLDER;
  const fs::path share = folder.parent_path() / "share" / "hapticgiant";
  return folder.filename() == "bin" && fs::is_directory(share, error) ? share : fs::path();
}

fs::path models_root() {
  std::error_code error;
  if (fs::is_directory("models/scenarios", error)) return ".";
  const fs::path installation = installation_root();
  if (!installation.empty() && fs::is_directory(installation / "models" / "scenarios", error)) {
    return installation;
  }
  throw SetupError(
      "models/scenarios: neither in the working directory nor where this program was built or "
      "installed");
}

std::vector<ShippedFile> shipped_scenarios() {
  const fs::path models = models_root() / "models";
  std::vector<ShippedFile> found;
  for (const std::string& name : names_in(models / "scenarios", ""))
    found.push_back({name, title_of(models / "scenarios" / (name + ".yaml"))});
  add_of_arms(kOfScenarios, found);
  return found;
}

std::vector<ShippedFile> shipped_devices() {
  const fs::path models = models_root() / "models";
  std::vector<ShippedFile> found = {
      {"haptic_giant", title_of(models / "haptic_giant" / "device.yaml")}};
  for (const std::string& arm : arm_names())
    found.push_back({arm, title_of(models / "arms" / arm / "device.yaml")});
  return found;
}

std::vector<ShippedFile> shipped_twins() {
  const fs::path twins = models_root() / "models" / "twins";
  std::vector<ShippedFile> found;
  for (const std::string& name : folders_with("twin.yaml", twins))
    found.push_back({name, title_of(twins / name / "twin.yaml")});
  add_of_arms(kOfTwins, found);
  return found;
}

LocalFiles local_files() {
  LocalFiles found;
  const std::array kinds = {std::pair(kOfOwnScenarios, &found.scenarios),
                            std::pair(kOfDevices, &found.devices),
                            std::pair(kOfTwins, &found.twins)};
  for (const fs::path& folder : local_folders()) {
    for (const fs::path& file : yaml_files_in(folder)) {
      for (const auto& [keys, files] : kinds) {
        if (!value_in(file, keys)) continue;
        const std::string title = title_of(file);
        files->push_back({file.generic_string(), title.empty() ? file.generic_string() : title});
      }
    }
  }
  for (const auto& [keys, files] : kinds) std::ranges::sort(*files, {}, &ShippedFile::name);
  return found;
}

bool has_surfaces(const fs::path& scenario) { return value_in(scenario, {"surfaces"}).has_value(); }

fs::path find_surfaces(const std::string& name, const SourceReader& reader) {
  return reader.exists(name) ? fs::path(name) : find_scenario(name);
}

fs::path find_scenario(const std::string& name) {
  return find_shipped(name, "scenario", kOfScenarios);
}

fs::path find_script(const std::string& name) {
  return find_shipped(name, "script", {}, false, {"mouse", "none"});
}

fs::path find_twin(const std::string& name, const SourceReader& reader) {
  return reader.exists(name) ? fs::path(name) : find_shipped(name, "twin", kOfTwins, true);
}

fs::path find_device(const std::string& name, const SourceReader& reader) {
  if (reader.exists(name)) return name;
  const fs::path models = models_root() / "models";
  for (const fs::path& known :
       {models.parent_path() / name, models / name / "device.yaml",
        models / "arms" / name / "device.yaml", models / "arms" / (name + ".yaml")}) {
    if (reader.exists(known)) return known;
  }
  refuse_folder(name, "device");
  // the reader of a file says what is beside it
  if (fs::path(name).extension() == ".yaml") return name;
  refuse_of_arm(name, "device", kOfDevices);
  std::vector<std::string> names = arm_names();
  names.insert(names.begin(), "haptic_giant");
  throw SetupError(fmt::format("{}: no such device file, did you mean '{}'? Shipped are {}", name,
                               nearest_name(name, names), fmt::join(names, ", ")));
}

fs::path find_simulation(const std::string& name, const DeviceConfig& device,
                         const SourceReader& reader) {
  constexpr std::string_view kPrefix = "simulation_";
  if (reader.exists(name)) return name;
  const fs::path folder = fs::path(device.sources.front().name).parent_path();
  const fs::path known = folder / fmt::format("{}{}.yaml", kPrefix, name);
  if (reader.exists(known)) return known;

  const std::vector<std::string> names = names_in(folder, kPrefix);
  if (names.empty()) throw SetupError(fmt::format("{}: no such simulation file", name));
  throw SetupError(fmt::format("{}: no such simulation file, did you mean '{}'? Beside {} are {}",
                               name, nearest_name(name, names), device.sources.front().name,
                               fmt::join(names, ", ")));
}

}  // namespace hg::config
