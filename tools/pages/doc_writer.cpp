#include "tools/pages/doc_writer.h"

#include <cmath>

#include "hg/model/urdf.h"

namespace hg::pages {
namespace {

using namespace config;

std::string default_of(double value) {
  if (std::isnan(value)) return "";
  return std::isinf(value) ? "none" : model::to_text(value);
}

std::string allowed(const Range& range, std::string_view key) {
  const std::string_view unit = unit_of(key);
  const std::string text = Bounds(range, key).text();
  return unit.empty() ? text : text + " " + std::string(unit);
}

}  // namespace

bool DocWriter::number(std::string_view key, const double& value, const Range& range,
                       std::string_view text, Need need) {
  return row(key, default_of(value), need, allowed(range, key), text);
}

bool DocWriter::joint_number(const JointKey& key, JointUnit unit, const double& value,
                             const Range& range, std::string_view text, Need need) {
  if (unit != JointUnit::kEither) return number(key.of(unit), value, range, text, need);
  const std::string keys = std::string(key.angle) + "` or `" + std::string(key.length);
  return row(keys, default_of(value), need,
             allowed(range, key.angle) + "; " + allowed(range, key.length), text);
}

bool DocWriter::whole(std::string_view key, std::uint32_t value, std::uint32_t most,
                      std::string_view text, Need need) {
  return row(key, std::to_string(value), need, "a whole number, 0 .. " + std::to_string(most),
             text);
}

bool DocWriter::vector(std::string_view key, const Eigen::Vector3d& value, const Range& range,
                       std::string_view text) {
  if (value.hasNaN()) {
    return row(key, "", Need::kOptional, "three numbers " + allowed(range, key), text);
  }
  std::string standard = "[";
  for (int i = 0; i < 3; ++i) (standard += default_of(value[i])) += i < 2 ? ", " : "]";
  return row(key, standard, Need::kOptional, "three numbers " + allowed(range, key), text);
}

bool DocWriter::inertia(std::string_view key, const Eigen::Matrix3d&, std::string_view text) {
  return row(key, "", Need::kOptional, "three or six numbers " + allowed(kAnyNumber, key), text);
}

bool DocWriter::flag(std::string_view key, bool value, std::string_view text) {
  return row(key, value ? "true" : "false", Need::kOptional, "true, false", text);
}

bool DocWriter::words(std::string_view key, const std::string& value, std::string_view text,
                      Need need) {
  return row(key, value, need, "text", text);
}

bool DocWriter::path(std::string_view key, const std::filesystem::path&, std::string_view text,
                     Need need) {
  return row(key, "", need, "a file", text);
}

bool DocWriter::name(std::string_view key, int, Names, std::string_view kind, std::string_view text,
                     Need need) {
  return row(key, "", need, kind, text);
}

bool DocWriter::names(std::string_view key, const std::vector<int>&, Names, std::string_view kind,
                      std::string_view text, Need need) {
  return row(key, "", need, "a list, each " + std::string(kind), text);
}

bool DocWriter::group(std::string_view key, const std::function<void(DocWriter&)>& write,
                      std::string_view text, Need need) {
  row(key, "", need, "a map", text);
  inside(std::string(key) + ".", write);
  return true;
}

bool DocWriter::list(std::string_view key, const std::function<void(DocWriter&)>& write,
                     std::string_view text, Need need) {
  row(key, "", need, "a list of maps", text);
  inside(std::string(key) + "[].", write);
  return true;
}

bool DocWriter::groups_by_name(std::string_view key, Names, std::string_view kind,
                               const std::function<void(DocWriter&, int)>& write,
                               std::string_view text) {
  row(key, "", Need::kOptional, "a map of maps, each key " + std::string(kind), text);
  inside(std::string(key) + ".NAME.", [&](DocWriter& writer) { write(writer, 0); });
  return true;
}

bool DocWriter::numbers_by_name(std::string_view key, Names, std::string_view kind,
                                const Range& range, const std::function<void(int, double)>&,
                                std::string_view text) {
  const std::string numbers = "a map of numbers, " + Bounds(range, "").text() + ", each key ";
  return row(key, "", Need::kOptional, numbers + std::string(kind), text);
}

bool DocWriter::row(std::string_view key, std::string_view standard, Need need,
                    std::string_view allowed, std::string_view text) {
  rows_.push_back({"`" + prefix_ + std::string(key) + "`",
                   need == Need::kRequired ? "**required**" : standard, allowed, text});
  return true;
}

void DocWriter::inside(std::string_view prefix, const std::function<void(DocWriter&)>& write) {
  const std::string outer = prefix_;
  prefix_ += prefix;
  write(*this);
  prefix_ = outer;
}

}  // namespace hg::pages
