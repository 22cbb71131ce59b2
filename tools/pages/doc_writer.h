/// Visitor that lists a description as rows of a table. Same functions as Loader; fields
/// hold the defaults, and nothing is changed in them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/config/schema.h"

namespace hg::pages {

class DocWriter {
 public:
  using JointKey = config::JointKey;
  using JointUnit = config::JointUnit;
  using Need = config::Need;
  using Range = config::Range;
  template <class T>
  using Choices = config::Choices<T>;
  using Names = std::span<const std::string>;

  bool number(std::string_view key, const double& value, const Range& range, std::string_view text,
              Need need = Need::kOptional);
  bool joint_number(const JointKey& key, JointUnit unit, const double& value, const Range& range,
                    std::string_view text, Need need = Need::kOptional);
  bool whole(std::string_view key, std::uint32_t value, std::uint32_t most, std::string_view text,
             Need need = Need::kOptional);
  bool vector(std::string_view key, const Eigen::Vector3d& value, const Range& range,
              std::string_view text);
  bool inertia(std::string_view key, const Eigen::Matrix3d& value, std::string_view text);
  bool flag(std::string_view key, bool value, std::string_view text);
  bool words(std::string_view key, const std::string& value, std::string_view text,
             Need need = Need::kOptional);
  bool path(std::string_view key, const std::filesystem::path& value, std::string_view text,
            Need need = Need::kOptional);
  template <class T>
  bool path_or_choice(std::string_view key, const std::filesystem::path&, const T&,
                      Choices<T> choices, std::string_view text, Need need = Need::kOptional) {
    return row(key, "", need, "a file" + names_of<T>(choices, ""), text);
  }
  template <class T>
  bool choice(std::string_view key, const T& value, Choices<T> choices, std::string_view text) {
    std::string_view standard;
    for (const config::Choice<T>& candidate : choices) {
      if (candidate.value == value) standard = candidate.name;
    }
    return row(key, standard, Need::kOptional, names_of<T>(choices, "").substr(2), text);
  }
  bool name(std::string_view key, int index, Names names, std::string_view kind,
            std::string_view text, Need need = Need::kOptional);
  bool names(std::string_view key, const std::vector<int>& indices, Names names,
             std::string_view kind, std::string_view text, Need need = Need::kOptional);

  bool group(std::string_view key, const std::function<void(DocWriter&)>& write,
             std::string_view text, Need need = Need::kOptional);
  bool list(std::string_view key, const std::function<void(DocWriter&)>& write,
            std::string_view text, Need need = Need::kOptional);
  /// Writes the item with index 0 as an example for all.
  bool groups_by_name(std::string_view key, Names names, std::string_view kind,
                      const std::function<void(DocWriter&, int index)>& write,
                      std::string_view text);
  bool numbers_by_name(std::string_view key, Names names, std::string_view kind, const Range& range,
                       const std::function<void(int index, double value)>& read,
                       std::string_view text);

  void rule(bool, std::string_view, std::string_view, std::string_view = {}) {}
  bool covers(bool) const { return true; }
  bool is_given(std::string_view) const { return true; }

  /// A row per key: key, default, allowed values, meaning.
  nlohmann::ordered_json table() const { return rows_; }

 private:
  template <class T>
  static std::string names_of(Choices<T> choices, std::string text) {
    for (const config::Choice<T>& candidate : choices) (text += ", ") += candidate.name;
    return text;
  }
  bool row(std::string_view key, std::string_view standard, Need need, std::string_view allowed,
           std::string_view text);
  void inside(std::string_view prefix, const std::function<void(DocWriter&)>& write);

  std::string prefix_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

}  // namespace hg::pages
