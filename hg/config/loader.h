/// Visitor that reads a described thing from one map of a YAML file, and chains from the URDFs that
/// these files name.
///
/// The field keeps its value, the default, unless the key is given and valid. Every function
/// returns whether it was. Faults are collected in Faults. Without a chain the fault is reported,
/// and the rest of the file is read without the names of joints and links: LoaderFile::knows_names.
#pragma once

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hg/config/schema.h"
#include "hg/config/sources.h"
#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::config {

/// The file at hand; outlives its loaders.
struct LoaderFile {
  std::filesystem::path path;
  SourceReader& sources;
  Faults faults;
  Places places = {};
  /// False: without a chain no joint or link has a name, and any name is accepted.
  bool knows_names = true;
};

class Loader {
 public:
  using Names = std::span<const std::string>;

  /// `item` is the path of keys that leads to `map`.
  Loader(const YAML::Node& map, std::string item, LoaderFile& file);

  bool number(std::string_view key, double& value, const Range& range, std::string_view text,
              Need need = Need::kOptional);
  /// Reads a number whose key depends on the joint: of rad or of m; either for an unknown joint.
  bool joint_number(const JointKey& key, JointUnit unit, double& value, const Range& range,
                    std::string_view text, Need need = Need::kOptional);
  /// Reads a whole number from 0 to `most`, also as 0x1A00.
  bool whole(std::string_view key, std::uint32_t& value, std::uint32_t most, std::string_view text,
             Need need = Need::kOptional);
  /// Reads a vector [x, y, z].
  bool vector(std::string_view key, Eigen::Vector3d& value, const Range& range,
              std::string_view text);
  /// Reads an inertia [xx, yy, zz] or [xx, yy, zz, xy, xz, yz].
  bool inertia(std::string_view key, Eigen::Matrix3d& value, std::string_view text);
  bool flag(std::string_view key, bool& value, std::string_view text);
  bool words(std::string_view key, std::string& value, std::string_view text,
             Need need = Need::kOptional);
  /// Reads the path of an existing file; a relative path starts at the folder of this file.
  bool path(std::string_view key, std::filesystem::path& value, std::string_view text,
            Need need = Need::kOptional);
  /// Reads a path as above, or one of `choices`, which sets `choice` and leaves `value` unchanged.
  template <class T>
  bool path_or_choice(std::string_view key, std::filesystem::path& value, T& choice,
                      Choices<T> choices, std::string_view text, Need need = Need::kOptional) {
    for (const Choice<T>& candidate : choices) {
      if (!is_word(key, candidate.name)) continue;
      choice = candidate.value;
      return find(key, need) != nullptr;
    }
    return path(key, value, text, need);
  }
  template <class T>
  bool choice(std::string_view key, T& value, Choices<T> choices, std::string_view text) {
    std::vector<std::string> names;
    for (const Choice<T>& candidate : choices) names.emplace_back(candidate.name);
    int index = 0;
    if (!name(key, index, names, one_of(names), text)) return false;
    value = choices[index].value;
    return true;
  }
  /// Reads a name as its index in `names`; `kind` describes them, for example "a joint".
  bool name(std::string_view key, int& index, Names names, std::string_view kind,
            std::string_view text, Need need = Need::kOptional);
  /// Reads a list of names, each at most once.
  bool names(std::string_view key, std::vector<int>& indices, Names names, std::string_view kind,
             std::string_view text, Need need = Need::kOptional);

  /// Reads a map with keys of its own.
  bool group(std::string_view key, const std::function<void(Loader&)>& read, std::string_view text,
             Need need = Need::kOptional);
  /// Reads a list of maps; `read` is called for each.
  bool list(std::string_view key, const std::function<void(Loader&)>& read, std::string_view text,
            Need need = Need::kOptional);
  /// Reads a map of maps, keyed by some of `names`.
  bool groups_by_name(std::string_view key, Names names, std::string_view kind,
                      const std::function<void(Loader&, int index)>& read, std::string_view text);
  /// Reads a map of numbers without a unit, keyed by some of `names`.
  bool numbers_by_name(std::string_view key, Names names, std::string_view kind, const Range& range,
                       const std::function<void(int index, double value)>& read,
                       std::string_view text);

  /// Checks a rule on more than one value: `what` must hold. A fault is reported at `key`, or at
  /// the map if the key is not given; below the top map only if there is no other fault, so that
  /// one fault does not cause another.
  void rule(bool holds, std::string_view key, std::string_view what, std::string_view got = {});
  bool is_given(std::string_view key) const;
  /// Whether the keys that follow apply to the current item; the reference page always shows them.
  bool covers(bool applies) const { return applies; }

  /// Reports the keys that no function has read, and broken rules. Called last.
  void finish();

 private:
  struct Entry {
    std::string key;
    Place place;
    YAML::Node value;
    bool is_known = false;
  };

  struct BrokenRule {
    Place place;
    std::string item;
    std::string message;
  };

  void add_entry(const YAML::Node& key, const YAML::Node& value);
  Entry* find(std::string_view key, Need need);
  bool is_word(std::string_view key, std::string_view word) const;
  bool text(std::string_view key, std::string& value, Need need);
  static std::string one_of(Names names);
  void read_map(const YAML::Node& node, const std::string& item,
                const std::function<void(Loader&)>& read);
  bool read_number(const YAML::Node& node, const std::string& item, std::string_view unit,
                   const Bounds& bounds, double& value);
  bool read_numbers(const YAML::Node& node, std::string_view key, const Range& range,
                    std::span<double> values);
  bool read_name(const YAML::Node& node, const std::string& item, Names names,
                 std::string_view kind, int& index);
  bool each_by_name(std::string_view key, Names names, std::string_view kind,
                    const std::function<void(const Entry&, const std::string&, int)>& read);
  /// Whether these are names of a chain that could not be read.
  bool is_unknown(Names names) const;
  std::string item_of(std::string_view key) const;
  void fault(const YAML::Node& node, const std::string& item, const std::string& what);

  std::string item_;
  Place place_;
  LoaderFile& file_;
  std::vector<Entry> entries_;
  std::vector<std::string> known_keys_;
  std::size_t faults_before_;  ///< number of faults in the file before this map
  std::vector<BrokenRule> broken_rules_;
};

/// Reads the keys of the file's top map, in its order. Throws SetupError when it is no YAML map.
std::vector<std::string> read_keys(LoaderFile& file);

/// Reads the file and lets `read` visit its top map. Throws SetupError with all faults at once.
void load_file(LoaderFile& file, const std::function<void(Loader&)>& read);

/// A URDF that could be read link by link and joint by joint.
struct UrdfText {
  std::filesystem::path file;
  std::string text;
  std::vector<std::string> link_names;
  std::vector<std::string> joint_names;  ///< of joints that move
  std::vector<model::UrdfJoint> joints;  ///< those, in the same order
};

/// Reads a URDF. Empty, with a fault reported, if it cannot be read; an empty path was reported
/// before.
std::optional<UrdfText> read_urdf(LoaderFile& file, const std::filesystem::path& urdf);

/// Records that there is no chain, for a reason already reported.
std::optional<model::ChainModel> no_chain(LoaderFile& file);

/// Name with this index; empty for -1.
std::string name_of(const std::vector<std::string>& names, int index);

/// Builds a chain from the URDF. Empty, with a fault reported, if the URDF holds no such chain.
std::optional<model::ChainModel> read_chain(LoaderFile& file, const UrdfText& urdf,
                                            const model::ChainOptions& options);

}  // namespace hg::config
