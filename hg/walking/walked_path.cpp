#include "hg/walking/walked_path.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string_view>

#include "hg/core/input_fault.h"
#include "hg/core/text.h"

namespace hg::walking {
namespace {

namespace fs = std::filesystem;

constexpr double kFacing = 0.15;      // m/s, from here on a person faces where the velocity points
constexpr double kFastest = 12.0;     // m/s; beyond, a column is in another unit
constexpr double kLongestGap = 10.0;  // s
constexpr std::string_view kColumns = "interval_s,x_m,y_m";

struct Row {
  double interval = 0.0;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
};

[[noreturn]] void fail(const std::string& file, int line, std::string what) {
  throw InputError(InputFault{.file = file, .line = line, .what = std::move(what)});
}

Row row_of(std::string_view text, const std::string& file, int line) {
  std::array<double, 3> values{};
  const char* at = text.data();
  const char* end = at + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, values[i]);
    const bool is_last = i + 1 == values.size();
    if (error != std::errc() || !std::isfinite(values[i]) ||
        (is_last ? next != end : next == end || *next != ',')) {
      fail(file, line,
           fmt::format("three numbers expected, {}, got {}", kColumns, in_quotes(text)));
    }
    at = next + 1;
  }
  return {values[0], {values[1], values[2]}};
}

void check(const Row& row, const Row& last, const std::string& file, int line) {
  if (!(row.interval > 0.0 && row.interval <= kLongestGap)) {
    fail(file, line,
         fmt::format("interval_s must be above 0 and at most {:g}, got {:g}", kLongestGap,
                     row.interval));
  }
  const double speed = (row.p - last.p).norm() / row.interval;
  if (!(speed <= kFastest)) {
    fail(file, line, fmt::format("a person of {:.3g} m/s: x_m and y_m are in meters", speed));
  }
}

std::vector<Row> rows_of(const std::string& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> input(gzopen(file.c_str(), "rb"), gzclose);
  if (!input) throw InputError(InputFault{.file = file, .what = "cannot be opened"});
  std::vector<Row> rows;
  std::array<char, 256> buffer{};
  for (int line = 1; gzgets(input.get(), buffer.data(), buffer.size()) != nullptr; ++line) {
    std::string_view text = buffer.data();
    text = text.substr(0, text.find_last_not_of("\r\n") + 1);
    if (line == 1) {
      if (text != kColumns)
        fail(file, line, fmt::format("columns {} expected, got {}", kColumns, in_quotes(text)));
      continue;
    }
    rows.push_back(row_of(text, file, line));
    if (rows.size() > 1) check(rows.back(), rows[rows.size() - 2], file, line);
  }
  int error = Z_OK;
  const char* words = gzerror(input.get(), &error);
  if (error != Z_OK && error != Z_STREAM_END) fail(file, 0, words);
  if (rows.size() < 2) fail(file, 0, "at least two positions expected");
  return rows;
}

// Every kWalkPeriod, along straight lines between the rows.
std::vector<WalkSample> resampled(const std::vector<Row>& rows) {
  std::vector<WalkSample> samples = {{.p = rows[0].p}};
  double since = 0.0;  // the row before, at the next sample
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double interval = rows[i].interval;
    for (since += kWalkPeriod; since <= interval; since += kWalkPeriod) {
      samples.push_back({.p = rows[i - 1].p + since / interval * (rows[i].p - rows[i - 1].p)});
    }
    since -= kWalkPeriod + interval;
  }
  return samples;
}

void add_headings(std::vector<WalkSample>& samples) {
  const auto walks = [](const WalkSample& sample) { return sample.v.norm() > kFacing; };
  const auto first = std::ranges::find_if(samples, walks);
  double heading = first == samples.end() ? 0.0 : std::atan2(first->v.y(), first->v.x());
  for (WalkSample& sample : samples) {
    if (walks(sample)) heading = std::atan2(sample.v.y(), sample.v.x());
    sample.heading = heading;
  }
}

}  // namespace

void add_velocities(std::vector<WalkSample>& samples) {
  constexpr double kLag = 0.05;  // s
  constexpr double kShare = kWalkPeriod / (kLag + kWalkPeriod);
  Eigen::Vector2d once = Eigen::Vector2d::Zero(), twice = once;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    once += kShare * ((samples[i].p - samples[i - 1].p) / kWalkPeriod - once);
    twice += kShare * (once - twice);
    samples[i].v = twice;
  }
}

Rectangle surroundings(const std::vector<WalkSample>& samples) {
  Rectangle bounds = {samples[0].p, samples[0].p};
  for (const WalkSample& sample : samples) {
    bounds.lower = bounds.lower.cwiseMin(sample.p);
    bounds.upper = bounds.upper.cwiseMax(sample.p);
  }
  return bounds.inset(-0.5);
}

WalkedPath read_walked_path(const std::string& file) {
  WalkedPath path = {.name = fs::path(file).filename().string(),
                     .samples = resampled(rows_of(file))};
  path.name = path.name.substr(0, path.name.find('.'));
  add_velocities(path.samples);
  add_headings(path.samples);
  path.spaces = {surroundings(path.samples)};
  return path;
}

std::vector<WalkedPath> read_walked_paths(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string file = entry.path().string();
    if (file.ends_with(".csv") || file.ends_with(".csv.gz")) files.push_back(file);
  }
  if (error) throw InputError(InputFault{.file = folder, .what = error.message()});
  if (files.empty())
    throw InputError(InputFault{.file = folder, .what = "no .csv or .csv.gz file"});
  std::ranges::sort(files);
  std::vector<WalkedPath> paths;
  for (const std::string& file : files) paths.push_back(read_walked_path(file));
  return paths;
}

}  // namespace hg::walking
