/// The language of the descriptions of configuration files: allowed values of numbers, units in
/// keys, choices, and the parts that several kinds of file share.
///
/// A description is a function template of a visitor V: the Loader of loader.h, or the writer of
/// the reference page. It calls one function per key: key, field, allowed values, and one line of
/// text for the page.
///
/// Keys end in their unit: `q_max_rad`, `stiffness_N_per_m`; a key without a known suffix has no
/// unit. A unit bounds its values to those of any plausible machine; a description narrows that
/// where a key needs it, and must do so where there is no unit.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "hg/core/enumerators.h"
#include "hg/core/interval.h"
#include "hg/core/types.h"
#include "hg/limits/acceleration_bounds.h"
#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::config {

enum class Need { kOptional, kRequired };

/// Range of a number as given by a description; the unit of its key adds its own bounds.
struct Range {
  double lb = -kInfinity;
  double ub = kInfinity;
  /// Excludes lb 0: a positive number, at least the smallest of its unit
  bool excludes_lb = false;
  bool allows_infinity = false;  ///< ".inf" stands for "no limit"
};

/// Marks a number without default: it counts only when given.
inline constexpr double kNoDefault = std::numeric_limits<double>::quiet_NaN();

inline constexpr Range kAnyNumber = {};
inline constexpr Range kPositive = {.lb = 0.0, .excludes_lb = true};
inline constexpr Range kNotNegative = {.lb = 0.0};
inline constexpr Range kUnlimited = {.allows_infinity = true};
inline constexpr Range kPositiveOrNone = {.lb = 0.0, .excludes_lb = true, .allows_infinity = true};

// ranges of numbers without a unit
inline constexpr Range kFactor = {.lb = 1e-3, .ub = 1e3};     ///< true value over assumed value
inline constexpr Range kTolerance = {.lb = 1e-6, .ub = 1e6};  ///< share or multiple of a rating
inline constexpr Range kFromOne = {.lb = 1.0, .ub = 1e6};     ///< multiple of a rating
inline constexpr Range kShare = {.lb = 0.0, .ub = 1e3};       ///< share of a full scale or a load
inline constexpr Range kShareOrNone = {.lb = 1e-6, .ub = 1e3, .allows_infinity = true};
inline constexpr Range kRatio = {.lb = -1e3, .ub = 1e3};  ///< of the speeds of two joints
inline constexpr Range kCount = {.lb = 0.0, .ub = 1e6};
/// Position of a joint in rad or m, under a key that is its name.
inline constexpr Range kJointPosition = {.lb = -1e3, .ub = 1e3};

/// The allowed values of a number: finite ends always, NaN never.
class Bounds {
 public:
  /// Intersects `range` with what the unit of `key` allows. Throws std::logic_error if an end
  /// remains open: the description must give it.
  Bounds(const Range& range, std::string_view key);

  bool contains(double value) const noexcept;
  /// The bounds as text, for example "0 .. 1" or "1e-09 .. 1000 or .inf".
  std::string text() const;

 private:
  double lb_, ub_;
  bool allows_infinity_;
};

/// Unit named by a key: "rad/s^2" for "ddq_max_rad_per_s2"; empty if there is none.
std::string_view unit_of(std::string_view key) noexcept;

/// Kind of unit of a joint's position; kEither stands for any joint on the reference page.
enum class JointUnit { kAngle, kLength, kEither };

/// The two spellings of a key that belongs to a joint: rad family and m family.
struct JointKey {
  std::string_view angle;
  std::string_view length;

  std::string_view of(JointUnit unit) const noexcept {
    return unit == JointUnit::kLength ? length : angle;
  }
};

/// One name of a choice and the value it stands for.
template <class T>
struct Choice {
  std::string_view name;
  T value;
};
template <class T>
using Choices = std::span<const Choice<std::type_identity_t<T>>>;

/// A choice per enumerator of E, named like it: "either_way" for kEitherWay.
template <class E>
constexpr auto choices_of() {
  const auto choices = []<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    return std::array{
        Choice<E>{key_name<enumerators<E>()[kIndex].value>(), enumerators<E>()[kIndex].value}...};
  };
  return choices(std::make_index_sequence<enumerators<E>().size()>{});
}

// ---- limits, chains, poses ----

inline JointUnit unit_of(model::JointType type) {
  return type == model::JointType::kPrismatic ? JointUnit::kLength : JointUnit::kAngle;
}

inline constexpr JointKey kLowest = {"q_min_rad", "q_min_m"};
inline constexpr JointKey kHighest = {"q_max_rad", "q_max_m"};
inline constexpr JointKey kSpeed = {"dq_max_rad_per_s", "dq_max_m_per_s"};
inline constexpr JointKey kAcceleration = {"ddq_max_rad_per_s2", "ddq_max_m_per_s2"};

template <class V>
void describe_positions(V& v, limits::JointLimits& limits, JointUnit unit) {
  v.joint_number(kLowest, unit, limits.q_min, kUnlimited, "lowest position");
  v.joint_number(kHighest, unit, limits.q_max, kUnlimited, "highest position");
  v.rule(limits.q_min <= limits.q_max, kHighest.of(unit), "q_max must not be below q_min",
         model::to_text(limits.q_max) + " with q_min " + model::to_text(limits.q_min));
}

template <class V>
void describe_ratings(V& v, limits::JointLimits& limits, JointUnit unit, Need need) {
  v.joint_number(kSpeed, unit, limits.dq_max, kPositiveOrNone, "largest speed", need);
  v.joint_number(kAcceleration, unit, limits.ddq_max, kPositiveOrNone, "largest acceleration",
                 need);
}

/// The part of a URDF with branches: indices of links, -1 = not given.
struct ChainPart {
  int root_link = -1, tip_link = -1;
  bool is_usable = false;  ///< the links that are given exist
};

template <class V>
void describe(V& v, ChainPart& part, const std::vector<std::string>& links) {
  const bool has_root = v.name("root_link", part.root_link, links, "a link of the URDF",
                               "first link of the chain, in a URDF with branches") ||
                        !v.is_given("root_link");
  const bool has_tip =
      v.name("tip_link", part.tip_link, links, "a link of the URDF",
             "last link of the chain; joints beyond or beside it stand still at 0") ||
      !v.is_given("tip_link");
  part.is_usable = has_root && has_tip;
}

/// Position and roll, pitch, yaw as in a URDF: R = Rz(yaw) Ry(pitch) Rx(roll).
struct Placement {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
};

inline Pose pose_of(const Placement& placement) {
  const auto rotation = Eigen::AngleAxisd(placement.yaw, Eigen::Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(placement.pitch, Eigen::Vector3d::UnitY()) *
                        Eigen::AngleAxisd(placement.roll, Eigen::Vector3d::UnitX());
  return {placement.p, rotation.toRotationMatrix()};
}

template <class V>
void describe(V& v, Placement& placement) {
  v.number("x_m", placement.p.x(), kAnyNumber, "position");
  v.number("y_m", placement.p.y(), kAnyNumber, "position");
  v.number("z_m", placement.p.z(), kAnyNumber, "position");
  v.number("roll_rad", placement.roll, kAnyNumber, "about x, first");
  v.number("pitch_rad", placement.pitch, kAnyNumber, "about y, second");
  v.number("yaw_rad", placement.yaw, kAnyNumber, "about z, last");
}

/// A value per manipulator joint. A faulty file may name more joints than a device can have: these
/// are reported elsewhere and left out here.
inline VectorM per_joint(std::size_t joints, double value) {
  return VectorM::Constant(std::min(static_cast<int>(joints), kMaxManipulator), value);
}
inline void set_joint(VectorM& values, int index, double value) {
  if (index < values.size()) values[index] = value;
}

}  // namespace hg::config
