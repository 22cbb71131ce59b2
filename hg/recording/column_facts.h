/// Units of a run's columns, and what the entries of their rows belong to.
///
/// Units come from the lists of fields, names of joints and limits from the recording's metadata
/// "run" and "limits".
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hg/recording/columns.h"
#include "hg/recording/key_values.h"

namespace hg::recording {

/// Unit of a floating joint in metadata "run".
inline constexpr char kFloating[] = "floating";

/// Facts about a column.
struct ColumnFacts {
  std::string unit;  ///< "m", "rad or m", "N, Nm" where entries differ; empty = none
  std::string axis;  ///< what entries belong to, "manipulator"; empty = one number per row
  std::vector<std::string> labels;  ///< name of each entry, as far as known
  std::vector<std::string> units;   ///< unit of each entry with a label
};

/// The parts of a run that entries of columns belong to.
class RunParts {
 public:
  /// Without metadata, entries of joints and limits have no labels.
  RunParts() = default;
  RunParts(const KeyValues& run, const KeyValues& limits) {
    gantry_ = parts(run, "gantry");
    manipulator_ = parts(run, "manipulator");
    twin_ = parts(run, "twin");
    for (const auto& [key, value] : limits) {
      if (key.ends_with(".name")) limits_.push_back({value, {}});
      if (key.ends_with(".unit") && !limits_.empty()) limits_.back().unit = value;
    }
  }

  ColumnFacts facts_of(const Column& column) const {
    ColumnFacts facts;
    facts.unit = column.unit.text();
    facts.axis = name_of(column.axis);
    for (const Part& part : parts_of(column.axis)) {
      facts.labels.push_back(part.name);
      facts.units.push_back(unit_of(column.unit, part, facts.labels.size() - 1));
    }
    const auto is_first = [&](const std::string& unit) { return unit == facts.units[0]; };
    if (!facts.units.empty() && std::ranges::all_of(facts.units, is_first)) {
      facts.unit = facts.units[0];
    }
    return facts;
  }

 private:
  /// Unit: rad, m, that of a floating joint's entry ("v", "omega", "quaternion"), or empty.
  struct Part {
    std::string name, unit;
  };
  using Parts = std::vector<Part>;

  static std::vector<std::string> words(const KeyValues& pairs, const std::string& key) {
    std::vector<std::string> found;
    const auto pair = std::ranges::find(pairs, key, &KeyValues::value_type::first);
    if (pair == pairs.end() || pair->second.empty()) return found;
    std::string_view text = pair->second;
    for (std::size_t end = 0; end != text.npos;
         text.remove_prefix(std::min(end + 1, text.size()))) {
      end = text.find(',');
      found.emplace_back(text.substr(0, end));
    }
    return found;
  }

  static Parts parts(const KeyValues& run, const std::string& group) {
    const std::vector<std::string> names = words(run, group + "_joints");
    std::vector<std::string> units = words(run, group + "_units");
    units.resize(names.size());
    Parts found;
    for (std::size_t i = 0; i < names.size(); ++i) found.push_back({names[i], units[i]});
    return found;
  }

  static std::string name_of(Axis axis) {
    switch (axis) {
      case Axis::kNone:
        return "";
      case Axis::kGantry:
        return "gantry";
      case Axis::kManipulator:
        return "manipulator";
      case Axis::kJoint:
        return "joint";
      case Axis::kTwinCoordinate:
        return "twin_coordinate";
      case Axis::kTwinVelocity:
        return "twin_velocity";
      case Axis::kLimit:
        return "limit";
      case Axis::kDirection:
        return "direction";
      case Axis::kSpatial:
        return "spatial";
      case Axis::kRotation:
        return "rotation";
      case Axis::kUnitReading:
        return "inertial_reading";
      case Axis::kUnit:
        return "inertial_unit";
    }
    return "";
  }

  Parts parts_of(Axis axis) const {
    switch (axis) {
      case Axis::kGantry:
        return gantry_;
      case Axis::kManipulator:
        return manipulator_;
      case Axis::kJoint: {
        Parts all = gantry_;
        all.insert(all.end(), manipulator_.begin(), manipulator_.end());
        return all;
      }
      case Axis::kTwinCoordinate:
        return twin_parts({"x", "y", "z", "qx", "qy", "qz", "qw"});
      case Axis::kTwinVelocity:
        return twin_parts({"x", "y", "z", "about_x", "about_y", "about_z"});
      case Axis::kLimit:
        return limits_;
      case Axis::kDirection:
        return {{"x", {}}, {"y", {}}, {"z", {}}};
      case Axis::kSpatial:
        return {{"x", {}}, {"y", {}}, {"z", {}}, {"about_x", {}}, {"about_y", {}}, {"about_z", {}}};
      case Axis::kRotation:
        return {{"xx", {}}, {"xy", {}}, {"xz", {}}, {"yx", {}}, {"yy", {}},
                {"yz", {}}, {"zx", {}}, {"zy", {}}, {"zz", {}}};
      case Axis::kNone:
      case Axis::kUnitReading:
      case Axis::kUnit:
        return {};
    }
    return {};
  }

  // a floating joint has these entries
  Parts twin_parts(const std::vector<std::string>& floating) const {
    Parts all;
    for (const Part& joint : twin_) {
      if (joint.unit != kFloating) {
        all.push_back(joint);
        continue;
      }
      for (const std::string& entry : floating) {
        const char* unit = entry.starts_with('q') ? "1" : entry.starts_with("about") ? "rad" : "m";
        all.push_back({joint.name + "." + entry, unit});
      }
    }
    return all;
  }

  // of entry `i` of a column
  static std::string unit_of(const Unit& unit, const Part& part, std::size_t i) {
    switch (unit.per) {
      case Unit::Per::kField:
        break;
      case Unit::Per::kHalf:
        return i % 6 < 3 ? unit.linear : unit.angular;
      case Unit::Per::kJoint:
        if (part.unit == "1") return "";
        if (part.unit == "rad") return unit.angular;
        if (part.unit == "m") return unit.linear;
    }
    return unit.text();
  }

  Parts gantry_, manipulator_, twin_, limits_;
};

}  // namespace hg::recording
