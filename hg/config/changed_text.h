/// Configuration files with values other than those that they give.
#pragma once

#include <span>
#include <string>

namespace hg::config {

/// A value for a key of a file: item "joints.m1.q_max_rad" or "frames[0].name", value as in YAML.
struct ChangedValue {
  std::string item;
  std::string value;
};

/// The text of a YAML file that says the same, but for these values; keys that it does not have are
/// added, entries of lists are not. Comments are lost. Throws SetupError, which names the item.
std::string changed_text(const std::string& text, std::span<const ChangedValue> changes);

}  // namespace hg::config
