#include "apps/offline/export_table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>

#include "apps/hapticgiant/report.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/core/visible.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using recording::Column;
using recording::Columns;

constexpr std::uintmax_t kMostDictionary = 16u << 20u;  // bytes
constexpr std::size_t kSearched = 1u << 20u;            // bytes at each end of a table

bool is_dictionary(const std::string& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > kMostDictionary) {
    return false;
  }
  const Json found = Json::parse(read_file(file, kMostDictionary), nullptr, false);
  if (!found.is_object() || !found.contains("columns")) return false;
  const auto by = found.find("exported_by");
  return by != found.end() && by->is_string() &&
         by->get_ref<const std::string&>().starts_with("hapticgiant ");
}

// Parquet has its schema at the end, HDF5 attributes anywhere, in small files near the beginning
bool has_dictionary_inside(const std::string& file) {
  std::ifstream bytes(file, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  std::string text(kSearched, '\0');
  for (const std::uintmax_t begin : {std::uintmax_t{0}, size > kSearched ? size - kSearched : 0}) {
    bytes.clear();
    bytes.seekg(static_cast<std::streamoff>(begin));
    bytes.read(text.data(), static_cast<std::streamsize>(text.size()));
    const std::string_view part(text.data(), static_cast<std::size_t>(bytes.gcount()));
    if (part.find("exported_by") != std::string_view::npos) return true;
  }
  return false;
}

bool begins_with(const std::string& file, std::string_view beginning) {
  std::ifstream bytes(file, std::ios::binary);
  std::string found(beginning.size(), '\0');
  bytes.read(found.data(), static_cast<std::streamsize>(found.size()));
  return found == beginning;
}

// an empty file beside `file` that was not there before
std::string new_partial(const std::string& file) {
  std::string name = file + ".XXXXXX.partial";
  constexpr int kSuffix = 8;  // letters of ".partial"
  const int descriptor = mkostemps(name.data(), kSuffix, O_CLOEXEC);
  if (descriptor < 0) {
    throw SetupError(file + ": cannot be written: " + std::strerror(errno));
  }
  const OpenFile made(descriptor);
  const mode_t mask = umask(0);
  umask(mask);
  (void)fchmod(descriptor, 0666 & ~mask);  // what it would have without mkostemps
  return name;
}

class TextFile {
 public:
  explicit TextFile(const std::string& file)
      : name_(file), file_(open_to_write(file, Content::kEmptied)) {}

  void write(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = ::write(file_.descriptor(), text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw SetupError(name_ + ": could not be written: " + std::strerror(errno));
      text.remove_prefix(written);
    }
  }

 private:
  std::string name_;
  OpenFile file_;
};

// RFC 4180
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

template <typename T>
void append_number(fmt::memory_buffer& text, const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value)) return;
  }
  fmt::format_to(std::back_inserter(text), "{}", value);
}

using Append = void (*)(fmt::memory_buffer&, const std::byte*);

// what writes a number of a column; of bytes as numbers, not as letters
Append append_of(const Column& column) {
  if (column.kind == 'f') return append_number<double>;
  const bool is_signed = column.kind == 'i';
  switch (column.bytes) {
    case 1:
      return [](fmt::memory_buffer& text, const std::byte* bytes) {
        fmt::format_to(std::back_inserter(text), "{}", std::to_integer<int>(*bytes));
      };
    case 2:
      return is_signed ? append_number<std::int16_t> : append_number<std::uint16_t>;
    case 4:
      return is_signed ? append_number<std::int32_t> : append_number<std::uint32_t>;
    default:
      return is_signed ? append_number<std::int64_t> : append_number<std::uint64_t>;
  }
}

class CsvTable final : public ExportTable {
 public:
  CsvTable(const std::string& file, const Json& facts) : file_(file) {
    std::string head;
    for (const Json& column : facts["columns"]) {
      const std::string name = column["name"];
      const std::size_t width = column.value("width", std::size_t{0});
      if (width == 0) head += "," + cell(name);
      for (std::size_t i = 0; i < width; ++i) head += fmt::format(",{}[{}]", name, i);
    }
    file_.write(head.substr(1) + "\n");
  }

  void write(const Columns& rows) override {
    struct Part {
      std::string name;
      std::vector<std::byte> bytes;
      std::size_t numbers, size;
      Append append;
    };
    std::vector<Part> parts;
    for (const Column& column : rows.all()) {
      if (!column.is_kept) continue;
      parts.push_back({column.name, padded(column, rows.rows()), column.width(), column.bytes,
                       append_of(column)});
    }
    const auto time = std::ranges::find(parts, "time_s", &Part::name);
    std::rotate(parts.begin(), time, time + 1);  // the first in the head
    text_.clear();
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      char separator = '\0';
      for (const Part& part : parts) {
        const std::byte* number = part.bytes.data() + row * part.numbers * part.size;
        for (std::size_t i = 0; i < part.numbers; ++i, number += part.size) {
          if (separator != '\0') text_.push_back(separator);
          part.append(text_, number);
          separator = ',';
        }
      }
      text_.push_back('\n');
    }
    file_.write({text_.data(), text_.size()});
  }

  void finish() override {}

 private:
  TextFile file_;
  fmt::memory_buffer text_;
};

class PythonTable final : public ExportTable {
 public:
  PythonTable(const std::string& format, const Json& head) : program_(format) {
    program_.write(head.dump() + "\n");
  }
  void write(const Columns& rows) override { program_.write(to_npy(rows)); }
  void finish() override {
    program_.write("end\n");
    program_.finish();
  }

 private:
  ExportProgram program_;
};

}  // namespace

ExportFiles::ExportFiles(const std::string& dictionary)
    : has_dictionary_(is_dictionary(dictionary)) {}

ExportFiles::~ExportFiles() {
  std::error_code ignored;
  for (const Added& added : files_) fs::remove(added.partial, ignored);
}

std::string ExportFiles::add(const std::string& file, ExportMark mark) {
  std::error_code error;
  const fs::file_type type = fs::symlink_status(file, error).type();
  if (type != fs::file_type::regular && type != fs::file_type::not_found) {
    throw SetupError(file + ": is no regular file, so that it cannot be replaced");
  }
  if (type == fs::file_type::regular) {
    const bool is_export = mark == ExportMark::kDictionary ? has_dictionary_
                           : mark == ExportMark::kBeside
                               ? has_dictionary_ && begins_with(file, "time_s")
                               : has_dictionary_inside(file);
    if (!is_export) {
      throw SetupError(file + ": exists already and is of no older export; it is not replaced");
    }
  }
  files_.push_back({file, new_partial(file)});
  return files_.back().partial;
}

std::vector<std::string> ExportFiles::keep() {
  std::vector<std::string> names;
  for (const Added& added : files_) {
    std::error_code error;
    fs::rename(added.partial, added.file, error);
    if (error) throw SetupError(added.file + ": could not be written: " + error.message());
    names.push_back(added.file);
  }
  files_.clear();
  return names;
}

std::unique_ptr<ExportTable> make_csv(ExportFiles& files, const std::string& out, const Json& facts,
                                      const std::vector<messages::Event>& events) {
  const std::string table = files.add(out + ".csv", ExportMark::kBeside);
  TextFile events_file(files.add(out + ".events.csv", ExportMark::kBeside));
  events_file.write("time_s,name,text\n");
  for (const messages::Event& event : events) {
    events_file.write(fmt::format("{},{},{}\n", event.time_s, cell(event.name), cell(event.text)));
  }
  TextFile(files.add(out + ".json", ExportMark::kDictionary)).write(facts.dump(2) + "\n");
  return std::make_unique<CsvTable>(table, facts);
}

std::unique_ptr<ExportTable> make_python_table(ExportFiles& files, const std::string& format,
                                               const std::string& out, const Json& facts,
                                               const std::vector<messages::Event>& events) {
  if (visible(out) != out) {
    throw SetupError("--out " + out + ": expected a name in UTF-8 without control characters");
  }
  Json head = {{"facts", facts}, {"events", Json::array()}};
  for (const messages::Event& event : events) {
    head["events"].push_back({event.time_s, event.name, event.text});
  }
  if (format == "parquet") {
    head["file"] = fs::absolute(files.add(out + ".parquet", ExportMark::kInside));
    head["events_file"] = fs::absolute(files.add(out + ".events.parquet", ExportMark::kInside));
  } else {
    head["file"] = fs::absolute(files.add(out + ".h5", ExportMark::kInside));
  }
  return std::make_unique<PythonTable>(format, head);
}

}  // namespace hg::apps
