#include "apps/hapticgiant/output_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <system_error>

#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

// only what is, or becomes, a regular file is replaced
bool is_replaced(const std::string& file) {
  std::error_code error;
  const auto type = fs::symlink_status(file, error).type();
  return type == fs::file_type::regular || type == fs::file_type::not_found;
}

}  // namespace

void check_writable(const std::string& file) {
  if (file.empty()) return;
  const std::string partial = file + ".partial";
  std::error_code error;
  bool is_writable = false;
  if (is_replaced(file)) {
    const bool existed = fs::exists(partial, error);
    is_writable = std::ofstream(partial, std::ios::app).good();
    if (!existed) fs::remove(partial, error);
  } else {
    is_writable = !fs::is_directory(file, error) && access(file.c_str(), W_OK) == 0;
  }
  if (!is_writable) throw SetupError(file + ": cannot be written there");
}

void write_output(const std::string& file, const std::string& text) {
  const bool replaces = is_replaced(file);
  const std::string written = replaces ? file + ".partial" : file;
  std::ofstream stream(written);
  stream << text;
  stream.close();
  std::error_code error;
  if (stream && replaces) fs::rename(written, file, error);
  if (stream && !error) return;
  if (replaces) fs::remove(written, error);
  throw SetupError(file + ": could not be written");
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && fs::is_directory(folder, error)) return;
  throw SetupError(folder + ": expected a folder, or a place where one can be made" +
                   (error ? ": " + error.message() : ""));
}

}  // namespace hg::apps
