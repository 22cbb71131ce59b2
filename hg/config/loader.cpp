#include "hg/config/loader.h"

#include <yaml-cpp/eventhandler.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "hg/config/suspected_unit.h"
#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/core/visible.h"
#include "hg/model/urdf.h"

namespace hg::config {

namespace {

constexpr std::size_t kShown = 40;  // characters of a wrong value; enough to recognise it
// entries of one map or list: no device has as many keys, and few scripts as many segments
constexpr std::size_t kMostKeys = 1000, kMostItems = 10'000;

Place place_of(const YAML::Mark& mark) { return {mark.line + 1, mark.column + 1}; }

std::string in_quotes(std::string_view text) {
  std::string result = "'";
  result += text.substr(0, kShown);
  if (text.size() > kShown) result += "...";
  return result += "'";
}

// Content of a node of the file, for "got ...".
std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return in_quotes(node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a map";
    case YAML::NodeType::Null:
    case YAML::NodeType::Undefined:
      break;
  }
  return "nothing";
}

// The fault with a proposal of the one of `names` that is nearest to the wrong one.
InputFault with_proposal(InputFault fault, std::string_view name,
                         std::span<const std::string> names) {
  fault.meant = nearest_name(name, names);
  if (!fault.meant.empty()) fault.what += ", did you mean '" + fault.meant + "'?";
  return fault;
}

// More than that, with a fault for each, would take minutes and help no reader.
void require_few(const YAML::Node& node, const std::string& item, Faults& faults) {
  const std::size_t most = node.IsMap() ? kMostKeys : kMostItems;
  if (node.size() <= most) return;
  faults.add(
      place_of(node.Mark()), item,
      "has " + std::to_string(node.size()) + " entries, expected at most " + std::to_string(most));
  faults.throw_if_any();
}

// Notes where documents begin.
class DocumentStarts final : public YAML::EventHandler {
 public:
  std::vector<Place> places;

  void OnDocumentStart(const YAML::Mark& mark) override { places.push_back(place_of(mark)); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

// YAML::Load would ignore what follows the first document, which a stray bracket can end, and
// YAML::LoadAll does not return from some stray brackets.
void refuse_second_document(const std::string& text, Faults& faults) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  for (int i = 0; i < 2; ++i) parser.HandleNextDocument(starts);
  if (starts.places.size() < 2) return;
  faults.add(starts.places.back(), "", "the file must be one map, but it has ended before this");
  faults.throw_if_any();
}

// A plain (unquoted) number of YAML, with its words for infinity and "not a number".
std::optional<double> parse_number(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() == "!") return {};
  std::string_view text = node.Scalar();
  if (text == ".nan" || text == ".NaN") return std::numeric_limits<double>::quiet_NaN();
  if (text == "-.inf") return -kInfinity;
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text == ".inf") return kInfinity;
  if (text.find_first_of("0123456789") == std::string_view::npos) return {};

  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

std::optional<std::uint32_t> parse_whole(const YAML::Node& node) {
  if (!node.IsScalar() || node.Tag() == "!") return {};
  std::string_view text = node.Scalar();
  const bool is_hexadecimal = text.starts_with("0x");
  if (is_hexadecimal) text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, is_hexadecimal ? 16 : 10);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace

Loader::Loader(const YAML::Node& map, std::string item, LoaderFile& file)
    : item_(std::move(item)),
      place_(place_of(map.Mark())),
      file_(file),
      faults_before_(file.faults.count()) {
  file_.places.add(item_, place_);
  require_few(map, item_, file_.faults);
  for (const auto& pair : map) add_entry(pair.first, pair.second);
}

void Loader::add_entry(const YAML::Node& key, const YAML::Node& value) {
  if (!key.IsScalar()) return fault(key, item_, "a key must be a word, got " + shown(key));
  const std::string& name = key.Scalar();
  const auto first = std::ranges::find(entries_, name, &Entry::key);
  if (first != entries_.end()) {
    return fault(key, item_of(name),
                 "given twice, first in line " + std::to_string(first->place.line));
  }
  entries_.push_back({name, place_of(key.Mark()), value, false});
  file_.places.add(item_of(name), place_of(value.IsScalar() ? value.Mark() : key.Mark()));
}

bool Loader::number(std::string_view key, double& value, const Range& range, std::string_view,
                    Need need) {
  const Entry* entry = find(key, need);
  return entry != nullptr &&
         read_number(entry->value, item_of(key), unit_of(key), {range, key}, value);
}

bool Loader::whole(std::string_view key, std::uint32_t& value, std::uint32_t most, std::string_view,
                   Need need) {
  const Entry* entry = find(key, need);
  if (entry == nullptr) return false;
  const std::optional<std::uint32_t> read = parse_whole(entry->value);
  if (!read || *read > most) {
    fault(entry->value, item_of(key),
          "must be a whole number from 0 to " + std::to_string(most) + ", also as 0x1A, got " +
              shown(entry->value));
    return false;
  }
  value = *read;
  return true;
}

bool Loader::joint_number(const JointKey& key, JointUnit unit, double& value, const Range& range,
                          std::string_view text, Need need) {
  if (unit == JointUnit::kEither && is_given(key.length)) unit = JointUnit::kLength;
  return number(key.of(unit), value, range, text, need);
}

bool Loader::vector(std::string_view key, Eigen::Vector3d& value, const Range& range,
                    std::string_view) {
  const Entry* entry = find(key, Need::kOptional);
  if (entry == nullptr) return false;
  const YAML::Node& node = entry->value;
  if (!node.IsSequence() || node.size() != 3) {
    fault(node, item_of(key),
          "must be a list of three numbers [x, y, z], got " +
              (node.IsSequence() ? std::to_string(node.size()) + " of them" : shown(node)));
    return false;
  }
  Eigen::Vector3d read;
  if (!read_numbers(node, key, range, {read.data(), 3})) return false;
  value = read;
  return true;
}

bool Loader::inertia(std::string_view key, Eigen::Matrix3d& value, std::string_view) {
  const Entry* entry = find(key, Need::kOptional);
  if (entry == nullptr) return false;
  const YAML::Node& node = entry->value;
  if (!node.IsSequence() || (node.size() != 3 && node.size() != 6)) {
    fault(node, item_of(key),
          "must be a list of numbers [xx, yy, zz] or [xx, yy, zz, xy, xz, yz], got " +
              (node.IsSequence() ? std::to_string(node.size()) + " of them" : shown(node)));
    return false;
  }
  std::array<double, 6> i{};
  if (!read_numbers(node, key, kAnyNumber, {i.data(), node.size()})) return false;
  value << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return true;
}

bool Loader::flag(std::string_view key, bool& value, std::string_view) {
  const Entry* entry = find(key, Need::kOptional);
  if (entry == nullptr) return false;
  const bool is_true = is_word(key, "true");
  if (!is_true && !is_word(key, "false")) {
    fault(entry->value, item_of(key), "must be true or false, got " + shown(entry->value));
    return false;
  }
  value = is_true;
  return true;
}

bool Loader::text(std::string_view key, std::string& value, Need need) {
  const Entry* entry = find(key, need);
  if (entry == nullptr) return false;
  if (!entry->value.IsScalar() || entry->value.Scalar().empty()) {
    fault(entry->value, item_of(key), "must be text, got " + shown(entry->value));
    return false;
  }
  value = entry->value.Scalar();
  return true;
}

bool Loader::words(std::string_view key, std::string& value, std::string_view, Need need) {
  std::string given;
  if (!text(key, given, need)) return false;
  if (!is_utf8(given)) {
    fault(find(key, need)->value, item_of(key), "must be UTF-8, got " + in_quotes(visible(given)));
    return false;
  }
  value = given;
  return true;
}

bool Loader::path(std::string_view key, std::filesystem::path& value, std::string_view, Need need) {
  std::string given;  // names of files may have any bytes
  if (!text(key, given, need)) return false;
  const std::filesystem::path file = (file_.path.parent_path() / given).lexically_normal();
  if (!file_.sources.exists(file)) {
    file_.faults.add(place_of(find(key, need)->value.Mark()),
                     with_proposal({.item = item_of(key),
                                    .what = "no such file, got " + in_quotes(given),
                                    .is_missing_file = true},
                                   file.filename().string(), file_.sources.siblings(file)));
    return false;
  }
  value = file;
  return true;
}

bool Loader::name(std::string_view key, int& index, Names names, std::string_view kind,
                  std::string_view, Need need) {
  const Entry* entry = find(key, need);
  return entry != nullptr && read_name(entry->value, item_of(key), names, kind, index);
}

bool Loader::names(std::string_view key, std::vector<int>& indices, Names names,
                   std::string_view kind, std::string_view, Need need) {
  const Entry* entry = find(key, need);
  if (entry == nullptr) return false;
  const YAML::Node& node = entry->value;
  if (!node.IsSequence()) {
    fault(node, item_of(key), "must be a list of names, got " + shown(node));
    return false;
  }
  std::vector<int> read;
  for (std::size_t i = 0; i < node.size(); ++i) {
    const std::string item = item_of(key) + "[" + std::to_string(i) + "]";
    int index = 0;
    if (!read_name(node[i], item, names, kind, index)) continue;
    if (std::ranges::find(read, index) != read.end()) {
      fault(node[i], item, "named twice, got " + shown(node[i]));
    } else {
      read.push_back(index);
    }
  }
  if (read.size() != node.size()) return false;
  indices = read;
  return true;
}

bool Loader::group(std::string_view key, const std::function<void(Loader&)>& read, std::string_view,
                   Need need) {
  const Entry* entry = find(key, need);
  if (entry == nullptr) return false;
  read_map(entry->value, item_of(key), read);
  return true;
}

bool Loader::list(std::string_view key, const std::function<void(Loader&)>& read, std::string_view,
                  Need need) {
  const Entry* entry = find(key, need);
  if (entry == nullptr) return false;
  if (!entry->value.IsSequence()) {
    fault(entry->value, item_of(key), "must be a list, got " + shown(entry->value));
    return false;
  }
  require_few(entry->value, item_of(key), file_.faults);
  for (std::size_t i = 0; i < entry->value.size(); ++i) {
    read_map(entry->value[i], item_of(key) + "[" + std::to_string(i) + "]", read);
  }
  return true;
}

bool Loader::groups_by_name(std::string_view key, Names names, std::string_view kind,
                            const std::function<void(Loader&, int)>& read, std::string_view) {
  return each_by_name(key, names, kind,
                      [&](const Entry& entry, const std::string& item, int index) {
                        read_map(entry.value, item, [&](Loader& child) { read(child, index); });
                      });
}

bool Loader::numbers_by_name(std::string_view key, Names names, std::string_view kind,
                             const Range& range, const std::function<void(int, double)>& read,
                             std::string_view) {
  const Bounds bounds(range, "");
  return each_by_name(key, names, kind,
                      [&](const Entry& entry, const std::string& item, int index) {
                        double value = 0.0;
                        if (read_number(entry.value, item, "", bounds, value)) read(index, value);
                      });
}

void Loader::rule(bool holds, std::string_view key, std::string_view what, std::string_view got) {
  if (holds) return;
  std::string message(what);
  if (!got.empty()) (message += ", got ") += got;
  const auto entry = std::ranges::find(entries_, key, &Entry::key);
  const bool is_at_key = entry != entries_.end();
  const Place place = is_at_key ? place_of(entry->value.Mark()) : place_;
  const std::string item = is_at_key ? item_of(key) : item_;
  if (item_.empty()) {
    file_.faults.add(place, item, message);
  } else {
    broken_rules_.push_back({place, item, message});
  }
}

bool Loader::is_given(std::string_view key) const {
  return std::ranges::find(entries_, key, &Entry::key) != entries_.end();
}

void Loader::finish() {
  for (const Entry& entry : entries_) {
    if (entry.is_known) continue;
    file_.faults.add(entry.place, with_proposal({.item = item_of(entry.key), .what = "unknown key"},
                                                entry.key, known_keys_));
  }
  if (file_.faults.count() > faults_before_) return;
  for (const BrokenRule& rule : broken_rules_) {
    file_.faults.add(rule.place, rule.item, rule.message);
  }
}

Loader::Entry* Loader::find(std::string_view key, Need need) {
  known_keys_.emplace_back(key);
  const auto entry = std::ranges::find(entries_, key, &Entry::key);
  if (entry == entries_.end()) {
    if (need == Need::kRequired) {
      file_.faults.add(place_, item_, "key " + in_quotes(key) + " is missing");
    }
    return nullptr;
  }
  entry->is_known = true;
  return &*entry;
}

bool Loader::is_word(std::string_view key, std::string_view word) const {
  const auto entry = std::ranges::find(entries_, key, &Entry::key);
  return entry != entries_.end() && entry->value.IsScalar() && entry->value.Tag() != "!" &&
         entry->value.Scalar() == word;
}

std::string Loader::one_of(Names names) {
  std::string text = names.size() > 1 ? "one of " : "";
  for (std::size_t i = 0; i < names.size(); ++i) (text += i > 0 ? ", " : "") += names[i];
  return text;
}

void Loader::read_map(const YAML::Node& node, const std::string& item,
                      const std::function<void(Loader&)>& read) {
  if (!node.IsMap()) return fault(node, item, "must be a map of keys, got " + shown(node));
  Loader child(node, item, file_);
  read(child);
  child.finish();
}

bool Loader::read_number(const YAML::Node& node, const std::string& item, std::string_view unit,
                         const Bounds& bounds, double& value) {
  const std::optional<double> number = parse_number(node);
  if (!number) {
    fault(node, item,
          (unit.empty() ? "must be a number" : "must be a number in " + std::string(unit)) +
              ", got " + shown(node));
    return false;
  }
  if (!bounds.contains(*number)) {
    fault(node, item,
          "must be " + bounds.text() + ", got " + node.Scalar() + suspected_of(*number, unit));
    return false;
  }
  value = *number;
  return true;
}

bool Loader::read_numbers(const YAML::Node& node, std::string_view key, const Range& range,
                          std::span<double> values) {
  const Bounds bounds(range, key);
  bool is_right = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    is_right &= read_number(node[i], item_of(key) + "[" + std::to_string(i) + "]", unit_of(key),
                            bounds, values[i]);
  }
  return is_right;
}

bool Loader::read_name(const YAML::Node& node, const std::string& item, Names names,
                       std::string_view kind, int& index) {
  if (!node.IsScalar()) {
    fault(node, item, "must be " + std::string(kind) + ", got " + shown(node));
    return false;
  }
  const auto found = std::ranges::find(names, node.Scalar());
  if (found == names.end()) {
    if (is_unknown(names)) return false;
    file_.faults.add(
        place_of(node.Mark()),
        with_proposal(
            {.item = item, .what = "must be " + std::string(kind) + ", got " + shown(node)},
            node.Scalar(), names));
    return false;
  }
  index = static_cast<int>(found - names.begin());
  return true;
}

bool Loader::each_by_name(std::string_view key, Names names, std::string_view kind,
                          const std::function<void(const Entry&, const std::string&, int)>& read) {
  const Entry* entry = find(key, Need::kOptional);
  if (entry == nullptr) return false;
  if (!entry->value.IsMap()) {
    fault(entry->value, item_of(key),
          "must be a map with names as keys, got " + shown(entry->value));
    return false;
  }
  const Loader child(entry->value, item_of(key), file_);
  if (is_unknown(names)) return false;
  for (const Entry& named : child.entries_) {
    const auto found = std::ranges::find(names, named.key);
    const std::string item = child.item_of(named.key);
    if (found == names.end()) {
      file_.faults.add(named.place, with_proposal({.item = item,
                                                   .what = "must be " + std::string(kind) +
                                                           ", got " + in_quotes(named.key)},
                                                  named.key, names));
    } else {
      read(named, item, static_cast<int>(found - names.begin()));
    }
  }
  return true;
}

bool Loader::is_unknown(Names names) const { return names.empty() && !file_.knows_names; }

std::string Loader::item_of(std::string_view key) const {
  std::string item = item_;
  if (!item.empty()) item += '.';
  return item += key;
}

void Loader::fault(const YAML::Node& node, const std::string& item, const std::string& what) {
  file_.faults.add(place_of(node.Mark()), item, what);
}

namespace {

// the top map; throws SetupError unless the file holds one
YAML::Node read_top_map(LoaderFile& file) {
  YAML::Node root;
  try {
    const std::string text = file.sources.read(file.path);
    refuse_second_document(text, file.faults);
    root = YAML::Load(text);
  } catch (const YAML::Exception& error) {
    file.faults.add(place_of(error.mark), "", "not valid YAML: " + error.msg);
  }
  if (file.faults.count() == 0 && !root.IsMap()) {
    file.faults.add({}, "", "the file must be a map of keys, got " + shown(root));
  }
  file.faults.throw_if_any();
  return root;
}

}  // namespace

std::vector<std::string> read_keys(LoaderFile& file) {
  std::vector<std::string> keys;
  for (const auto& pair : read_top_map(file)) {
    if (pair.first.IsScalar()) keys.push_back(pair.first.Scalar());
  }
  return keys;
}

void load_file(LoaderFile& file, const std::function<void(Loader&)>& read) {
  Loader loader(read_top_map(file), "", file);
  read(loader);
  loader.finish();
  file.faults.throw_if_any();
}

std::optional<UrdfText> read_urdf(LoaderFile& file, const std::filesystem::path& urdf) {
  file.knows_names = false;
  if (urdf.empty()) return {};
  try {
    UrdfText result = {urdf, file.sources.read(urdf), {}, {}, {}};
    const model::Urdf parts = model::read_urdf_text(result.text, urdf.generic_string());
    for (const model::UrdfLink& link : parts.links) result.link_names.push_back(link.name);
    for (const model::UrdfJoint& joint : parts.joints) {
      if (joint.type == model::UrdfJointType::kFixed && !joint.fault) continue;
      result.joint_names.push_back(joint.name);
      result.joints.push_back(joint);
    }
    file.knows_names = true;
    return result;
  } catch (const SetupError& error) {
    file.faults.add_all(error);
    return {};
  }
}

std::optional<model::ChainModel> no_chain(LoaderFile& file) {
  file.knows_names = false;
  return {};
}

std::string name_of(const std::vector<std::string>& names, int index) {
  return index < 0 ? "" : names[index];
}

std::optional<model::ChainModel> read_chain(LoaderFile& file, const UrdfText& urdf,
                                            const model::ChainOptions& options) {
  try {
    return model::ChainModel::from_urdf_text(urdf.text, urdf.file.generic_string(), options);
  } catch (const SetupError& error) {
    file.faults.add_all(error);
    return no_chain(file);
  }
}

}  // namespace hg::config
