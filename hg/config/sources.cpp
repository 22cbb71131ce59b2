#include "hg/config/sources.h"

#include <algorithm>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/open_file.h"

namespace hg::config {
namespace {

constexpr std::uintmax_t kSizeMax = 4 << 20;  // bytes; configuration is written by hand

std::string name_of(const std::filesystem::path& file) {
  return file.lexically_normal().generic_string();
}

}  // namespace

SourceReader::SourceReader(std::vector<SourceText> recorded)
    : is_recorded_(true), recorded_(std::move(recorded)) {}

bool SourceReader::exists(const std::filesystem::path& file) const {
  std::error_code ignored;
  if (!is_recorded_) return std::filesystem::is_regular_file(file, ignored);
  return std::ranges::any_of(
      recorded_, [name = name_of(file)](const SourceText& text) { return text.name == name; });
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
  const std::string name = name_of(file);
  if (!exists(file)) throw SetupError(name + ": no such file");
  std::string content;
  if (is_recorded_) {
    content = std::ranges::find(recorded_, name, &SourceText::name)->content;
  } else {
    std::error_code ignored;
    if (std::filesystem::file_size(file, ignored) > kSizeMax) {
      throw SetupError(name + ": a configuration file has at most 4 MB");
    }
    content = read_file(file, kSizeMax);
  }
  texts_.push_back({name, content});
  return content;
}

std::vector<SourceText> SourceReader::since(std::size_t count) const {
  return {texts_.begin() + static_cast<std::ptrdiff_t>(count), texts_.end()};
}

}  // namespace hg::config
