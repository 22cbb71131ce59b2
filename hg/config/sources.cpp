#include "hg/config/sources.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "hg/core/open_file.h"

namespace hg::config {

namespace {

constexpr std::uintmax_t kSizeMax = 4 << 20;  // bytes; configuration is written by hand

std::string name_within(const std::filesystem::path& file) {
  return file.lexically_normal().generic_string();
}

}  // namespace

SourceReader::SourceReader(std::vector<SourceText> recorded)
    : is_recorded_(true), recorded_(std::move(recorded)) {}

bool SourceReader::exists(const std::filesystem::path& file) const {
  std::error_code ignored;
  if (!is_recorded_) return std::filesystem::is_regular_file(file, ignored);
  return std::ranges::any_of(
      recorded_, [name = name_within(file)](const SourceText& text) { return text.name == name; });
}

std::vector<std::string> SourceReader::siblings(const std::filesystem::path& file) const {
  std::vector<std::string> names;
  if (is_recorded_) return names;
  std::error_code error;
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() == file.extension()) {
      names.push_back(entry.path().filename().generic_string());
    }
  }
  std::ranges::sort(names);
  return names;
}

std::string SourceReader::read(const std::filesystem::path& file) {
  const std::string name = name_within(file);
  if (!exists(file)) {
    std::error_code ignored;
    const bool is_folder = !is_recorded_ && std::filesystem::is_directory(file, ignored);
    throw InputError(InputFault{.file = name, .what = is_folder ? "is a folder" : "no such file"});
  }
  std::string content;
  if (is_recorded_) {
    content = std::ranges::find(recorded_, name, &SourceText::name)->content;
  } else {
    std::error_code ignored;
    if (std::filesystem::file_size(file, ignored) > kSizeMax) {
      throw InputError(InputFault{.file = name, .what = "a configuration file has at most 4 MB"});
    }
    content = read_file(file, kSizeMax);
  }
  texts_.push_back({name, content});
  return content;
}

std::vector<SourceText> SourceReader::since(std::size_t count) const {
  return {texts_.begin() + static_cast<std::ptrdiff_t>(count), texts_.end()};
}

void Places::add(const std::string& item, Place place) { places_.emplace(item, place); }

Place Places::nearest(std::string item) const {
  while (true) {
    const auto found = places_.find(item);
    if (found != places_.end()) return found->second;
    const std::size_t end = item.find_last_of(".[");
    if (end == std::string::npos) return {};
    item.resize(end);
  }
}

void Faults::add(Place place, std::string_view item, std::string_view what) {
  add(place, {.item = std::string(item), .what = std::string(what)});
}

void Faults::add(Place place, InputFault fault) {
  fault.file = file_;
  fault.line = place.line;
  fault.column = place.column;
  faults_.push_back({place, std::move(fault)});
}

void Faults::add_all(const SetupError& error) {
  for (InputFault& fault : faults_of(error)) {
    faults_.push_back({{std::numeric_limits<int>::max(), 0}, std::move(fault)});
  }
}

void Faults::throw_if_any() const {
  if (faults_.empty()) return;
  std::vector<Placed> sorted = faults_;
  std::ranges::stable_sort(sorted, {}, [](const Placed& placed) {
    return std::tuple(placed.order.line, placed.order.column);
  });
  std::vector<InputFault> faults;
  for (Placed& placed : sorted) faults.push_back(std::move(placed.fault));
  throw InputError(std::move(faults));
}

}  // namespace hg::config
