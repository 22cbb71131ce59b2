#include "hg/config/changed_text.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <charconv>
#include <cstddef>
#include <string_view>

#include "hg/core/error.h"

namespace hg::config {
namespace {

// Without aliases: a change of one node must not change another.
YAML::Node copy_of(const YAML::Node& node) {
  YAML::Node copy(node.Type());
  if (node.IsScalar()) copy = node.Scalar();
  if (node.IsMap()) {
    for (const auto& pair : node) copy.force_insert(pair.first.Scalar(), copy_of(pair.second));
  }
  if (node.IsSequence()) {
    for (const auto& entry : node) copy.push_back(copy_of(entry));
  }
  copy.SetStyle(node.Style());
  return copy;
}

// Sets what `rest` of the item leads to from `node` on.
void set(YAML::Node node, std::string_view rest, const ChangedValue& change) {
  const auto refuse = [&](std::string_view what) {
    const std::string_view item(change.item);
    throw SetupError(
        fmt::format("{}: {}", item,
                    fmt::format(fmt::runtime(what), item.substr(0, item.size() - rest.size()))));
  };
  if (rest.empty()) {
    node = YAML::Load(change.value);
    return;
  }
  if (rest.front() == '[') {
    const std::size_t end = rest.find(']');
    std::size_t index = 0;
    const char* last = rest.data() + (end == std::string_view::npos ? rest.size() : end);
    const bool is_index = std::from_chars(rest.data() + 1, last, index).ptr == last;
    if (end == std::string_view::npos || !is_index) refuse("expected [NUMBER] after '{}'");
    if (!node.IsSequence()) {
      refuse("'{}' is no list; a name with a dot or bracket stands in quotes: joints.\"arm[0]\"");
    }
    if (index >= node.size()) refuse(fmt::format("'{{}}' has {} entries", node.size()));
    return set(node[index], rest.substr(end + 1), change);
  }
  if (rest.front() == '.') rest.remove_prefix(1);
  const bool is_quoted = rest.starts_with('"');  // a name with a dot or bracket
  const std::size_t end = is_quoted ? rest.find('"', 1) : rest.find_first_of(".[");
  if (is_quoted && end == std::string_view::npos) refuse("the quotes behind '{}' do not end");
  const std::string_view key = is_quoted ? rest.substr(1, end - 1) : rest.substr(0, end);
  if (key.empty()) refuse("expected a key after '{}'");
  const std::string_view behind = rest.substr(key.size() + (is_quoted ? 2 : 0));
  if (is_quoted && !behind.empty() && behind[0] != '.' && behind[0] != '[') {
    refuse("expected '.' or '[' behind the quotes after '{}'");
  }
  if (node.IsScalar() || node.IsSequence()) refuse("'{}' is no map of keys");
  set(node[std::string(key)], behind, change);
}

}  // namespace

std::string changed_text(const std::string& text, std::span<const ChangedValue> changes) {
  YAML::Node root = copy_of(YAML::Load(text));
  for (const ChangedValue& change : changes) {
    try {
      set(root, change.item, change);
    } catch (const YAML::Exception& error) {
      throw SetupError(
          fmt::format("{}: not valid YAML: {}, got '{}'", change.item, error.msg, change.value));
    }
  }
  return YAML::Dump(root) + "\n";
}

}  // namespace hg::config
