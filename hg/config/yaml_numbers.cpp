#include "hg/config/yaml_numbers.h"

#include <yaml-cpp/yaml.h>
#include <charconv>
#include <cmath>

namespace hg::config {
namespace {

void collect(const YAML::Node& node, const std::string& item, const std::string& key,
             std::vector<YamlNumber>& numbers) {
  if (node.IsMap()) {
    for (const auto& entry : node) {
      if (!entry.first.IsScalar()) continue;
      const std::string& name = entry.first.Scalar();
      collect(entry.second, item.empty() ? name : item + "." + name, name, numbers);
    }
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      collect(node[i], item + "[" + std::to_string(i) + "]", key, numbers);
    }
  } else if (node.IsScalar() && node.Tag() != "!") {
    const std::string& text = node.Scalar();
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    double value = 0.0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (begin == end || error != std::errc() || stop != end || !std::isfinite(value)) return;
    numbers.push_back({item, key, {node.Mark().line + 1, node.Mark().column + 1}, value});
  }
}

}  // namespace

std::vector<YamlNumber> numbers_in(const std::string& text) {
  std::vector<YamlNumber> numbers;
  try {
    collect(YAML::Load(text), "", "", numbers);
  } catch (const YAML::Exception&) {  // its loader has reported it
  }
  return numbers;
}

}  // namespace hg::config
