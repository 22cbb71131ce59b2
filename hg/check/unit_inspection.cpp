#include "hg/check/unit_inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "hg/check/twin_bodies.h"
#include "hg/config/schema.h"
#include "hg/config/yaml_numbers.h"
#include "hg/core/unit_doubt.h"
#include "hg/model/urdf_vectors.h"

namespace hg::check {
namespace {

using config::YamlNumber;

constexpr double kMostHeld = 50.0;      // kg; a person moves a tool or payload of this mass no more
constexpr double kMostMoved = 500.0;    // kg, of a free body
constexpr double kHeld = 1.0;           // m, from the flange to the end of what a person holds
constexpr double kMoved = 5.0;          // m, likewise of a free body
constexpr double kNoStops = 1000.0;     // m or rad; files have +-1000 for a joint without stops
constexpr double kMostDegrees = 720.0;  // degrees per second, of the fastest wrists
constexpr Interval kLever = {1e-3, 3.0};  // m, torque over force of a sensor or of its noise

// A finding of any file, at a line and column of it.
void add(const std::string& file, config::Place place, std::string item, std::string what,
         std::string fix, Collector& out) {
  out.findings.push_back({.severity = Severity::kWarning,
                          .file = file,
                          .place = place,
                          .item = std::move(item),
                          .what = std::move(what),
                          .fix = std::move(fix)});
}

bool has_no_stops(double lowest, double highest) {
  return lowest == -highest && highest >= kNoStops && is_power_of_ten(highest);
}

void inspect_range(const model::UrdfJoint& joint, Collector& out) {
  const Interval range = joint.position;
  const double widest = std::abs(range.lb) > std::abs(range.ub) ? range.lb : range.ub;
  const bool is_slide = joint.type == model::UrdfJointType::kPrismatic;
  const std::string doubt = is_slide ? doubt_of_length(widest) : doubt_of_angle(widest);
  if (doubt.empty() || has_no_stops(range.lb, range.ub)) return;
  const double size = is_slide ? kOtherLengths[0].size : kDegree;
  out.add_at_urdf(Severity::kWarning, "joint", joint.name,
                  fmt::format("<limit> {:.4g} .. {:.4g}: {}", range.lb, range.ub, doubt),
                  fmt::format("if so, give lower=\"{:.4g}\" upper=\"{:.4g}\"{}", size * range.lb,
                              size * range.ub,
                              is_slide ? "" : "; a joint without stops has the type continuous"));
}

// Of what turns without end only a round number of degrees is doubted, and only where a drive has a
// rating: wheels and propellers are faster than any arm.
std::string doubt_of_velocity(const model::UrdfJoint& joint) {
  const double speed = joint.velocity_max;
  const bool is_endless = joint.type == model::UrdfJointType::kContinuous ||
                          has_no_stops(joint.position.lb, joint.position.ub);
  const bool may_be_degrees =
      std::isfinite(joint.effort_max) && speed <= kMostDegrees && std::fmod(speed, 5.0) == 0.0;
  return is_endless && !may_be_degrees ? "" : doubt_of_speed(speed);
}

void inspect_joint(const model::UrdfJoint& joint, Collector& out) {
  const bool is_slide = joint.type == model::UrdfJointType::kPrismatic;
  const bool turns = joint.type == model::UrdfJointType::kRevolute ||
                     joint.type == model::UrdfJointType::kContinuous;
  if (is_slide || joint.type == model::UrdfJointType::kRevolute) inspect_range(joint, out);
  const std::string doubt = turns ? doubt_of_velocity(joint) : "";
  if (doubt.empty()) return;
  out.add_at_urdf(Severity::kWarning, "joint", joint.name, "<limit> velocity: " + doubt,
                  "if so, give velocity in rad/s");
}

void inspect_vectors(const config::SourceText& source, Collector& out) {
  const model::UrdfVectors vectors = model::urdf_vectors(source.content);
  for (const model::UrdfVector& turn : vectors.turns) {
    if (!turn.values) continue;
    Eigen::Index most = 0;
    turn.values->cwiseAbs().maxCoeff(&most);
    const std::string doubt = doubt_of_orientation((*turn.values)[most]);
    if (doubt.empty()) continue;
    const Eigen::Vector3d mended = kDegree * *turn.values;
    add(source.name, {turn.line, 1}, turn.kind + " " + turn.name,
        fmt::format("<origin> rpy \"{}\": {}", turn.text, doubt),
        fmt::format("if so, give rpy=\"{:.4g} {:.4g} {:.4g}\"", mended.x(), mended.y(), mended.z()),
        out);
  }
  for (const model::UrdfVector& scale : vectors.scales) {
    const bool is_flat = scale.values && (scale.values->array() == 0.0).any();
    if (scale.values && !is_flat) continue;
    add(source.name, {scale.line, 1}, scale.kind + " " + scale.name,
        fmt::format("<mesh> scale must be three numbers other than 0, got '{}'", scale.text),
        "give scale=\"1 1 1\", or \"0.001 0.001 0.001\" for a mesh in millimetres", out);
  }
}

bool starts_with_any(std::string_view key, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return key.starts_with(word); });
}

// Other keys in rad/s are poles of the control or belong to gyroscopes.
bool is_speed_of_joint(std::string_view key) {
  return starts_with_any(key, {"dq_", "no_load_", "full_torque_to_", "speed_", "stribeck_",
                               "friction_speed_", "gantry_deviation_", "braking_deviation_"});
}

std::vector<std::string> slides_among(const std::vector<model::Urdf>& urdfs) {
  std::vector<std::string> names;
  for (const model::Urdf& urdf : urdfs) {
    for (const model::UrdfJoint& joint : urdf.joints) {
      if (joint.type == model::UrdfJointType::kPrismatic) names.push_back(joint.name);
    }
  }
  return names;
}

// The numbers of one file, by the paths of their keys.
class YamlInspection {
 public:
  YamlInspection(const config::SourceText& source, const std::vector<std::string>& slides,
                 Collector& out)
      : file_(source.name),
        numbers_(config::numbers_in(source.content)),
        slides_(slides),
        out_(out) {}

  void inspect() {
    for (const YamlNumber& number : numbers_) {
      warn(number, doubt_of(number));
      if (number.key == "mass_kg") inspect_body(number);
      if (is_torque(number)) inspect_lever(number);
    }
  }

 private:
  void warn(const YamlNumber& number, const std::string& doubt) {
    if (doubt.empty()) return;
    add(file_, number.place, number.item, doubt,
        fmt::format("if so, give {} in {}", number.key, unit_of(number)), out_);
  }

  // Keys of `posture` are names of joints.
  static bool is_posture(const YamlNumber& number) { return number.item.starts_with("posture."); }

  std::string_view unit_of(const YamlNumber& number) const {
    if (!is_posture(number)) return config::unit_of(number.key);
    return std::ranges::count(slides_, number.key) > 0 ? "m" : "rad";
  }

  // What holds for a number alone, by its key.
  std::string doubt_of(const YamlNumber& number) const {
    const std::string_view key = number.key, unit = unit_of(number);
    if (is_end_of_nothing(number)) return "";
    if (unit == "rad") {
      const bool is_orientation =
          !is_posture(number) && starts_with_any(key, {"roll", "pitch", "yaw", "azimuth"});
      return is_orientation ? doubt_of_orientation(number.value) : doubt_of_angle(number.value);
    }
    if (unit == "rad/s") return is_speed_of_joint(key) ? doubt_of_speed(number.value) : "";
    return unit == "m" ? doubt_of_length(number.value) : "";
  }

  // q_min or q_max of a joint without stops.
  bool is_end_of_nothing(const YamlNumber& number) const {
    if (!starts_with_any(number.key, {"q_min_", "q_max_"})) return false;
    std::string item = number.item;
    const bool is_lowest = number.key.starts_with("q_min_");
    item.replace(item.size() - number.key.size(), 5, is_lowest ? "q_max" : "q_min");
    const YamlNumber* other = find(item);
    return other != nullptr &&
           has_no_stops(std::min(number.value, other->value), std::max(number.value, other->value));
  }

  const YamlNumber* find(const std::string& item) const {
    const auto found = std::ranges::find(numbers_, item, &YamlNumber::item);
    return found == numbers_.end() ? nullptr : &*found;
  }

  // Tools, payloads and free bodies: mass, and what stands beside it.
  void inspect_body(const YamlNumber& mass) {
    const std::string map = mass.item.substr(0, mass.item.size() - mass.key.size());
    const bool is_free = map.starts_with("free_body");
    const std::string grams =
        suspected_unit(mass.value, {0.0, is_free ? kMostMoved : kMostHeld}, kOtherMasses, "kg");
    if (!grams.empty())
      warn(mass, fmt::format("{:.4g} kg are more than a person moves; {}", mass.value, grams));
    const double reach = is_free ? kMoved : kHeld;
    double sum = 0.0;
    const YamlNumber* first = nullptr;
    for (const char* axis : {"[0]", "[1]", "[2]"}) {
      if (const YamlNumber* com = find(map + "centre_of_mass_m" + axis)) inspect_com(*com, reach);
      const YamlNumber* moment = find(map + "inertia_kg_m2" + axis);
      if (moment == nullptr) continue;
      if (first == nullptr) first = moment;
      sum += moment->value;
    }
    if (first == nullptr || mass.value <= 0.0 || sum <= 0.0) return;
    if (moments_of(mass.value, 0.5 * reach).contains(sum / 3.0)) return;  // heavy, but one body
    const double kg = grams.empty() ? mass.value : kOtherMasses[0].size * mass.value;
    const double radius = std::sqrt(0.5 * sum / kg);
    const std::string doubt =
        suspected_unit(sum / 3.0, moments_of(kg, 0.5 * reach), kOtherInertias, "kg m^2");
    if (doubt.empty() || radius < 0.5 * reach) return;
    warn(*first, fmt::format("this inertia is that of a body of about {:.2g} m, with {:g} kg; {}",
                             radius, kg, doubt));
  }

  void inspect_com(const YamlNumber& com, double reach) {
    if (!doubt_of_length(com.value).empty()) return;  // the length alone is doubted
    const std::string doubt = suspected_unit(com.value, {-reach, reach}, kOtherLengths, "m");
    if (doubt.empty()) return;
    warn(com,
         fmt::format("{:.4g} m are farther than the end of what is held; {}", com.value, doubt));
  }

  // Of a force/torque sensor, its noise, and what it may bear.
  static bool is_torque(const YamlNumber& number) {
    return number.key == "noise_Nm" || number.key == "noise_Nm_per_sqrt_Hz" ||
           number.key == "torque_max_Nm" || number.item.starts_with("sensors.wrench_sensor.torque");
  }

  void inspect_lever(const YamlNumber& torque) {
    std::string item = torque.item;
    item.replace(item.rfind("Nm"), 2, "N");
    const std::size_t name = item.rfind("torque");
    if (name != std::string::npos) item.replace(name, 6, "force");
    const YamlNumber* force = find(item);
    if (force == nullptr || force->value <= 0.0 || torque.value <= 0.0) return;
    const double lever = torque.value / force->value;
    const std::string what = fmt::format("{:.4g} Nm beside {:.4g} N are a lever of {:.2g} m; ",
                                         torque.value, force->value, lever);
    const double least = kLever.lb * force->value, most = kLever.ub * force->value;
    const std::string small = suspected_unit(torque.value, {least, most}, kOtherTorques, "Nm");
    if (lever > kLever.ub && !small.empty()) warn(torque, what + small);
    if (lever >= kLever.lb) return;
    constexpr std::array kMilli = {OtherUnit{"mN", 1e-3}};
    const std::string mN = suspected_unit(
        force->value, {torque.value / kLever.ub, torque.value / kLever.lb}, kMilli, "N");
    if (!mN.empty()) warn(*force, what + mN);
  }

  std::string file_;
  std::vector<YamlNumber> numbers_;
  const std::vector<std::string>& slides_;
  Collector& out_;
};

}  // namespace

std::vector<std::string> joint_names(const model::ChainModel& chain) {
  std::vector<std::string> names;
  for (const model::Joint& joint : chain.joints()) names.push_back(joint.name);
  for (const model::Coupling& coupling : chain.couplings()) names.push_back(coupling.joint);
  return names;
}

void inspect_units(const std::vector<config::SourceText>& sources,
                   const std::vector<std::string>& joints, Collector& out) {
  const std::vector<model::Urdf> urdfs = urdfs_among(sources);
  const std::vector<std::string> slides = slides_among(urdfs);
  for (const config::SourceText& source : sources) {
    if (is_urdf(source)) {
      inspect_vectors(source, out);
    } else {
      YamlInspection(source, slides, out).inspect();
    }
  }
  for (const model::Urdf& urdf : urdfs) {
    for (const model::UrdfJoint& joint : urdf.joints) {
      const bool counts = joints.empty() || std::ranges::count(joints, joint.name) > 0;
      if (counts && joint.type != model::UrdfJointType::kFixed) inspect_joint(joint, out);
    }
  }
}

}  // namespace hg::check
