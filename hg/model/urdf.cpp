#include "hg/model/urdf.h"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "hg/core/input_fault.h"
#include "hg/core/linear_algebra.h"
#include "hg/core/nearest_name.h"
#include "hg/core/open_file.h"
#include "hg/core/visible.h"

namespace hg::model {
namespace {

using tinyxml2::XMLElement;

constexpr std::array<std::pair<std::string_view, UrdfJointType>, 6> kJointTypes = {{
    {"fixed", UrdfJointType::kFixed},
    {"revolute", UrdfJointType::kRevolute},
    {"continuous", UrdfJointType::kContinuous},
    {"prismatic", UrdfJointType::kPrismatic},
    {"floating", UrdfJointType::kFloating},
    {"planar", UrdfJointType::kPlanar},
}};

// Plausible ranges of values: m, rad, kg, kg m^2, and a joint's own units.
constexpr Interval kPosition = {-1e3, 1e3};
constexpr Interval kAngle = {-1e3, 1e3};
constexpr Interval kRatio = {-1e3, 1e3};
constexpr Interval kLength = {0.0, 1e3};
constexpr Interval kMass = {-1e6, 1e6};  // negative for fixed links only
constexpr Interval kInertia = {-1e9, 1e9};
constexpr Interval kDirection = {-1e6, 1e6};  // of any length
constexpr Interval kVelocity = {0.0, 1e6};
constexpr Interval kEffort = {0.0, 1e9};
constexpr std::uintmax_t kMostBytes = 64'000'000;
constexpr int kMostParts = 1000;         // links or joints; a chain has at most 30 that move
constexpr double kLeastMass = 1e-9;      // least nonzero mass of a link
constexpr double kLeastInertia = 1e-15;  // principal moment

// `item`: the link or joint; empty where none is at hand.
[[noreturn]] void fail(const Urdf& urdf, int line, const std::string& item,
                       const std::string& what) {
  throw InputError(InputFault{.file = urdf.source, .line = line, .item = item, .what = what});
}

void ignore(Urdf& urdf, const std::string& what, int line) {
  const auto seen = std::ranges::find(urdf.ignored, what, &UrdfIgnored::what);
  if (seen != urdf.ignored.end()) {
    ++seen->count;
  } else {
    urdf.ignored.push_back({what, line, 1});
  }
}

// Where another format is at hand.
std::string advice_for(std::string_view root) {
  if (root == "mujoco") return ": an MJCF file; export the mechanism as a URDF";
  if (root == "sdf") return ": an SDF file; export the mechanism as a URDF";
  return {};
}

// Why a text is no XML, and what helps.
std::string reason_of(std::string_view text, tinyxml2::XMLError error) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    return "it is UTF-16; save it as UTF-8";
  }
  switch (error) {
    case tinyxml2::XML_ERROR_EMPTY_DOCUMENT:
      return "it is empty";
    case tinyxml2::XML_ERROR_PARSING_DECLARATION:
      return "<?xml ...?> must be the first in the file; move what stands before it";
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      return "an element is not closed, or closed by another name";
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      return "an attribute is not NAME=\"VALUE\", or stands there twice";
    case tinyxml2::XML_ERROR_PARSING_COMMENT:
      return "a comment does not end";
    case tinyxml2::XML_ERROR_PARSING_TEXT:
      return "text stands where an element is expected";
    default:
      return "an element cannot be read";
  }
}

// The rule of a body that an inertia breaks, and what it has; empty: none.
std::string broken_rule(const Inertial& inertial) {
  // files carry three digits, and tensors are turned after that; a flat plate has I3 = I1 + I2
  constexpr double kRounding = 1e-2;
  if (!(inertial.mass >= kLeastMass && inertial.mass <= kMass.ub)) {
    return "mass must be " + to_text(kLeastMass) + " .. " + to_text(kMass.ub) + " kg, got " +
           to_text(inertial.mass);
  }
  if (!inertial.p_com.allFinite() || !inertial.inertia.allFinite()) {
    return "inertia must be finite, got nan or inf";
  }
  const Eigen::Vector3d moments = symmetric_eigen(inertial.inertia).values;
  std::ostringstream got;
  got << std::setprecision(4) << ", got principal moments " << moments[0] << ", " << moments[1]
      << ", " << moments[2];
  if (!(moments[0] >= kLeastInertia)) return "inertia must be positive definite" + got.str();
  if (moments[0] + moments[1] >= moments[2] * (1.0 - kRounding)) return {};
  return "inertia is of no body, the two smaller principal moments must add up to the largest" +
         got.str();
}

// An element of URDF: what is read of it, and what else URDF has.
struct Known {
  std::string_view element;
  std::vector<std::string> attributes, children;
  std::vector<std::string> other_attributes = {}, other_children = {};
};

// What is not known here (extensions of tools) is skipped with all that it contains. The page draws
// <visual> and <material>.
const std::vector<Known>& known_elements() {
  static const std::vector<Known> kKnown = {
      {"robot",
       {"name"},
       {"link", "joint", "material"},
       {"version"},
       {"transmission", "gazebo", "ros2_control", "sensor"}},
      {"link", {"name"}, {"inertial", "collision", "visual"}},
      {"inertial", {}, {"origin", "mass", "inertia"}},
      {"origin", {"xyz", "rpy"}, {}},
      {"mass", {"value"}, {}},
      {"inertia", {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}},
      {"collision", {"name"}, {"origin", "geometry"}},
      {"geometry", {}, {"sphere", "cylinder", "box"}, {}, {"mesh", "capsule"}},
      {"sphere", {"radius"}, {}},
      {"cylinder", {"radius", "length"}, {}},
      {"box", {"size"}, {}},
      {"joint",
       {"name", "type"},
       {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"},
       {},
       {"calibration", "safety_controller"}},
      {"parent", {"link"}, {}},
      {"child", {"link"}, {}},
      {"axis", {"xyz"}, {}},
      {"limit", {"lower", "upper", "velocity", "effort"}, {}},
      {"dynamics", {"damping", "friction"}, {}},
      {"mimic", {"joint", "multiplier", "offset"}, {}},
  };
  return kKnown;
}

// Lists what is not read of one file, and throws where it is misspelt.
class Inventory {
 public:
  explicit Inventory(Urdf& urdf) : urdf_(urdf) {}

  void take(const XMLElement& e) {
    const auto known = std::ranges::find(known_elements(), e.Name(), &Known::element);
    if (known == known_elements().end()) return;
    for (const auto* a = e.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (std::string_view(a->Name()).find(':') != std::string_view::npos) continue;  // xmlns
      look(a->Name(), a->GetLineNum(), known->attributes, known->other_attributes,
           in_brackets(e) + " ", "");
    }
    for (const auto* c = e.FirstChildElement(); c != nullptr; c = c->NextSiblingElement()) {
      refuse_xacro(*c);
      if (look(c->Name(), c->GetLineNum(), known->children, known->other_children, "<", ">")) {
        take(*c);
      }
    }
  }

 private:
  static std::string in_brackets(const XMLElement& e) { return "<" + std::string(e.Name()) + ">"; }

  // Whether `name` is read; otherwise it is listed, between `before` and `after`.
  bool look(const std::string& name, int line, const std::vector<std::string>& read,
            const std::vector<std::string>& others, const std::string& before,
            const std::string& after) {
    if (std::ranges::find(read, name) != read.end()) return true;
    std::vector<std::string> all = read;
    all.insert(all.end(), others.begin(), others.end());
    const std::string meant = misspelt_name(name, all);
    if (!meant.empty()) {
      fail(urdf_, line, "",
           before + name + after + " is unknown to URDF, nearest is " + in_quotes(meant));
    }
    ignore(urdf_, before + name + after, line);
    return false;
  }

  void refuse_xacro(const XMLElement& e) const {
    if (!std::string_view(e.Name()).starts_with("xacro:")) return;
    const std::filesystem::path source = urdf_.source;
    std::filesystem::path plain = source.stem().replace_extension(".urdf");
    if (plain == source.filename()) plain = "plain_" + plain.string();
    fail(urdf_, e.GetLineNum(), "",
         "is a xacro file, not a URDF; convert it first: xacro " + urdf_.source + " > " +
             plain.string());
  }

  Urdf& urdf_;
};

// Reads the parts of one file; `item` is the link or joint at hand, for messages.
class Reader {
 public:
  explicit Reader(Urdf& urdf) : urdf_(urdf) {}

  void read(const XMLElement& robot) {
    urdf_.name = attribute(robot, "name", "robot");
    refuse_too_many(robot, "link");
    refuse_too_many(robot, "joint");
    for (auto* e = robot.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) {
      urdf_.links.push_back(link(*e));
      refuse_second(urdf_.links, "link");
    }
    if (urdf_.links.empty()) fail(urdf_, robot.GetLineNum(), "robot", "has no links");
    for (auto* e = robot.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) {
      urdf_.joints.push_back(joint(*e));
      refuse_second(urdf_.joints, "joint");
    }
  }

 private:
  // bounds the quadratic search for duplicates
  void refuse_too_many(const XMLElement& robot, const char* kind) const {
    int count = 0;
    for (auto* e = robot.FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
      if (++count <= kMostParts) continue;
      fail(urdf_, e->GetLineNum(), "robot",
           std::string("at most ") + std::to_string(kMostParts) + " elements <" + kind +
               "> are read, got more");
    }
  }

  std::string attribute(const XMLElement& e, const char* key, const std::string& item) const {
    const char* text = e.Attribute(key);
    if (text == nullptr) {
      fail(urdf_, e.GetLineNum(), item,
           std::string("<") + e.Name() + "> needs the attribute " + in_quotes(key));
    }
    require_utf8(e, key, text, item);
    return text;
  }

  void require_utf8(const XMLElement& e, const char* key, const std::string& text,
                    const std::string& item) const {
    if (is_utf8(text)) return;
    fail(urdf_, e.GetLineNum(), item,
         std::string(key) + " must be UTF-8, got " + in_quotes(visible(text)) +
             "; convert the file: iconv -f ISO-8859-1 -t UTF-8");
  }

  // Numbers separated by blanks; exactly `count` of them, each in `range`.
  std::vector<double> numbers(const XMLElement& e, const char* key, std::size_t count,
                              const Interval& range, const std::string& item) const {
    const std::string text = attribute(e, key, item);
    std::vector<double> values;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      double value = 0.0;
      const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
      const char* end = word.data() + word.size();
      const auto [stop, error] = std::from_chars(begin, end, value);
      if (error != std::errc() || stop != end || !std::isfinite(value)) {
        fail(urdf_, e.GetLineNum(), item,
             std::string(key) + " must be numbers, got " + in_quotes(text));
      }
      if (!range.contains(value)) {
        fail(urdf_, e.GetLineNum(), item,
             std::string(key) + " must be " + to_text(range.lb) + " .. " + to_text(range.ub) +
                 ", got " + in_quotes(text));
      }
      values.push_back(value);
    }
    if (values.size() != count) {
      fail(urdf_, e.GetLineNum(), item,
           std::string(key) + " must be " + std::to_string(count) +
               (count == 1 ? " number, got " : " numbers, got ") + in_quotes(text));
    }
    return values;
  }

  double number(const XMLElement& e, const char* key, const Interval& range,
                const std::string& item) const {
    return numbers(e, key, 1, range, item)[0];
  }

  Eigen::Vector3d vector3(const XMLElement& e, const char* key, const Interval& range,
                          const std::string& item) const {
    return Eigen::Vector3d(numbers(e, key, 3, range, item).data());
  }

  const XMLElement& child(const XMLElement& e, const char* name, const std::string& item) const {
    const XMLElement* found = e.FirstChildElement(name);
    if (found == nullptr) {
      fail(urdf_, e.GetLineNum(), item,
           std::string("<") + e.Name() + "> needs an element <" + std::string(name) + ">");
    }
    return *found;
  }

  Pose origin(const XMLElement& parent, const std::string& item) const {
    Pose pose;
    const XMLElement* e = parent.FirstChildElement("origin");
    if (e == nullptr) return pose;
    if (e->Attribute("xyz")) pose.p = vector3(*e, "xyz", kPosition, item);
    if (e->Attribute("rpy")) {
      const Eigen::Vector3d rpy = vector3(*e, "rpy", kAngle, item);
      pose.R = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
    }
    return pose;
  }

  // Empty if mass and inertia are zero, which exporters write for links that are mere frames.
  std::optional<Inertial> inertial(const XMLElement& e, const std::string& item,
                                   std::optional<InputFault>& fault) const {
    const Pose pose = origin(e, item);
    const XMLElement& i = child(e, "inertia", item);
    // read before the comma initialiser: it must not be interrupted by an exception
    const double ixy = number(i, "ixy", kInertia, item);
    const double ixz = number(i, "ixz", kInertia, item);
    const double iyz = number(i, "iyz", kInertia, item);
    const double ixx = number(i, "ixx", kInertia, item);
    const double iyy = number(i, "iyy", kInertia, item);
    const double izz = number(i, "izz", kInertia, item);
    Eigen::Matrix3d inertia;
    inertia << ixx, ixy, ixz, ixy, iyy, iyz, ixz, iyz, izz;
    const Inertial result = {.mass = number(child(e, "mass", item), "value", kMass, item),
                             .p_com = pose.p,
                             .inertia = pose.R * inertia * pose.R.transpose()};
    if (result.mass == 0.0 && inertia.isZero(0.0)) return {};
    const std::string broken = broken_rule(result);
    if (!broken.empty()) {
      fault =
          InputFault{.file = urdf_.source, .line = e.GetLineNum(), .item = item, .what = broken};
    }
    return result;
  }

  UrdfCollision collision(const XMLElement& e, const std::string& item) const {
    UrdfCollision result;
    if (e.Attribute("name") != nullptr) result.name = attribute(e, "name", item);
    result.T_link_shape = origin(e, item);
    const XMLElement& geometry = child(e, "geometry", item);
    if (const XMLElement* sphere = geometry.FirstChildElement("sphere")) {
      result.shape = UrdfShape::kSphere;
      result.size.x() = number(*sphere, "radius", kLength, item);
    } else if (const XMLElement* cylinder = geometry.FirstChildElement("cylinder")) {
      result.shape = UrdfShape::kCylinder;
      result.size.x() = number(*cylinder, "radius", kLength, item);
      result.size.y() = number(*cylinder, "length", kLength, item);
    } else if (const XMLElement* box = geometry.FirstChildElement("box")) {
      result.shape = UrdfShape::kBox;
      result.size = vector3(*box, "size", kLength, item);
    }
    return result;
  }

  UrdfLink link(const XMLElement& e) const {
    UrdfLink result = {.name = attribute(e, "name", "link"),
                       .line = e.GetLineNum(),
                       .inertial = {},
                       .inertial_fault = {},
                       .collisions = {}};
    if (const XMLElement* i = e.FirstChildElement("inertial")) {
      try {
        result.inertial = inertial(*i, "link " + result.name, result.inertial_fault);
      } catch (const SetupError& error) {
        result.inertial = Inertial{.mass = std::numeric_limits<double>::quiet_NaN()};
        result.inertial_fault = faults_of(error).front();
      }
    }
    for (auto* c = e.FirstChildElement("collision"); c; c = c->NextSiblingElement("collision")) {
      result.collisions.push_back(collision(*c, "collision of link " + result.name));
    }
    return result;
  }

  int link_index(const XMLElement& e, const std::string& item) const {
    const std::string name = attribute(e, "link", item);
    std::vector<std::string> names;
    for (const UrdfLink& l : urdf_.links) {
      if (l.name == name) return static_cast<int>(names.size());
      names.push_back(l.name);
    }
    fail(urdf_, e.GetLineNum(), item,
         std::string(e.Name()) + " must be a link, got " + in_quotes(name) + ", nearest is " +
             in_quotes(nearest_name(name, names)));
  }

  UrdfJointType joint_type(const XMLElement& e, const std::string& item) const {
    const std::string text = attribute(e, "type", item);
    std::vector<std::string> names;
    for (const auto& [name, type] : kJointTypes) {
      if (name == text) return type;
      names.emplace_back(name);
    }
    fail(urdf_, e.GetLineNum(), item,
         "type is unknown, got " + in_quotes(text) + ", nearest is " +
             in_quotes(nearest_name(text, names)));
  }

  Eigen::Vector3d axis(const XMLElement& e, const std::string& item) const {
    const XMLElement* a = e.FirstChildElement("axis");
    if (a == nullptr) return Eigen::Vector3d::UnitX();
    const Eigen::Vector3d v = vector3(*a, "xyz", kDirection, item);
    if (v.norm() < 1e-6) {
      fail(urdf_, a->GetLineNum(), item,
           "axis must have a direction, got " + in_quotes(a->Attribute("xyz")));
    }
    return v.normalized();
  }

  // Exporters write 0 for a rating that they do not know: no limit.
  double rating(const XMLElement& limit, const char* key, const Interval& range,
                const std::string& item) {
    if (limit.Attribute(key) == nullptr) return kInfinity;
    const double value = number(limit, key, range, item);
    if (value > 0.0) return value;
    ignore(urdf_, std::string("<limit> ") + key + " 0", limit.GetLineNum());
    return kInfinity;
  }

  // Of a continuous joint; some exporters write zeros.
  void ignore_range(const XMLElement& limit) {
    const auto is_given = [&](const char* key) { return limit.DoubleAttribute(key) != 0.0; };
    if (!is_given("lower") && !is_given("upper")) return;
    ignore(urdf_, "<limit> lower and upper of a continuous joint, which turns without end",
           limit.GetLineNum());
  }

  // those of a fixed joint mean nothing; some exporters write zeros
  void limits(const XMLElement& e, const std::string& item, UrdfJoint& joint) {
    if (joint.type == UrdfJointType::kFixed) return;
    const bool has_range =
        joint.type == UrdfJointType::kRevolute || joint.type == UrdfJointType::kPrismatic;
    const XMLElement* limit = has_range ? &child(e, "limit", item) : e.FirstChildElement("limit");
    if (limit == nullptr) return;
    joint.velocity_max = rating(*limit, "velocity", kVelocity, item);
    joint.effort_max = rating(*limit, "effort", kEffort, item);
    if (!has_range) {
      ignore_range(*limit);
      return;
    }
    const Interval& range = joint.type == UrdfJointType::kPrismatic ? kPosition : kAngle;
    // the default of URDF is 0
    const auto end = [&](const char* key) {
      return limit->Attribute(key) == nullptr ? 0.0 : number(*limit, key, range, item);
    };
    joint.position = {end("lower"), end("upper")};
    if (!(joint.position.lb < joint.position.ub)) {
      const bool is_complete =
          limit->Attribute("lower") != nullptr && limit->Attribute("upper") != nullptr;
      const std::string missing = is_complete ? "" : " (one that is missing is 0)";
      fail(urdf_, limit->GetLineNum(), item,
           "limit lower must be below upper" + missing + ", got lower " +
               to_text(joint.position.lb) + ", upper " + to_text(joint.position.ub));
    }
  }

  void dynamics(const XMLElement& e, const std::string& item, UrdfJoint& joint) const {
    const XMLElement* found = e.FirstChildElement("dynamics");
    if (found == nullptr || joint.type == UrdfJointType::kFixed) return;
    if (found->Attribute("damping")) joint.damping = number(*found, "damping", kEffort, item);
    if (found->Attribute("friction")) joint.friction = number(*found, "friction", kEffort, item);
  }

  void ignore_ratings(const XMLElement& e) {
    for (const char* key : {"limit", "dynamics"}) {
      const XMLElement* found = e.FirstChildElement(key);
      if (found == nullptr) continue;
      ignore(urdf_, "<" + std::string(key) + "> of a floating or planar joint",
             found->GetLineNum());
    }
  }

  UrdfMimic read_mimic(const XMLElement& e, const std::string& item) const {
    UrdfMimic mimic = {.joint = attribute(e, "joint", item), .line = e.GetLineNum()};
    if (e.Attribute("multiplier")) mimic.multiplier = number(e, "multiplier", kRatio, item);
    if (e.Attribute("offset")) mimic.offset = number(e, "offset", kPosition, item);
    return mimic;
  }

  UrdfJoint joint(const XMLElement& e) {
    UrdfJoint result;
    result.name = attribute(e, "name", "joint");
    result.line = e.GetLineNum();
    const std::string item = "joint " + result.name;
    result.parent = link_index(child(e, "parent", item), item);
    result.child = link_index(child(e, "child", item), item);
    result.T_parent_joint = origin(e, item);
    try {
      read_motion(e, item, result);
    } catch (const SetupError& error) {
      result.type = UrdfJointType::kFixed;
      result.mimic = leader_of(e);
      result.fault = faults_of(error).front();
    }
    return result;
  }

  // Of a joint with a fault: which joint it would follow.
  static std::optional<UrdfMimic> leader_of(const XMLElement& e) {
    const XMLElement* mimic = e.FirstChildElement("mimic");
    if (mimic == nullptr || mimic->Attribute("joint") == nullptr) return {};
    return UrdfMimic{.joint = mimic->Attribute("joint"), .line = mimic->GetLineNum()};
  }

  // Kind, axis, limits, dynamics and mimic of a joint.
  void read_motion(const XMLElement& e, const std::string& item, UrdfJoint& result) {
    result.type = joint_type(e, item);
    const bool has_axis =
        result.type != UrdfJointType::kFixed && result.type != UrdfJointType::kFloating;
    if (has_axis) result.axis = axis(e, item);
    const bool is_scalar =
        result.type != UrdfJointType::kFloating && result.type != UrdfJointType::kPlanar;
    if (is_scalar) {
      limits(e, item, result);
      dynamics(e, item, result);
    } else {
      ignore_ratings(e);
    }
    if (const XMLElement* mimic = e.FirstChildElement("mimic")) {
      result.mimic = read_mimic(*mimic, item);
    }
  }

  template <typename Item>
  void refuse_second(const std::vector<Item>& items, const std::string& kind) const {
    for (std::size_t i = 0; i + 1 < items.size(); ++i) {
      if (items[i].name == items.back().name) {
        fail(urdf_, items.back().line, kind + " " + items.back().name,
             "name is taken already in line " + std::to_string(items[i].line));
      }
    }
  }

  Urdf& urdf_;
};

}  // namespace

void check_inertial(const Inertial& inertial, std::string_view item) {
  const std::string broken = broken_rule(inertial);
  if (!broken.empty()) throw SetupError(std::string(item) + ": " + broken);
}

bool is_point_mass(const UrdfLink& link) noexcept {
  return link.inertial && link.inertial->mass > 0.0 && link.inertial->inertia.isZero(0.0);
}

Urdf read_urdf_text(std::string_view text, std::string_view source) {
  Urdf urdf;
  urdf.source = source;
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    fail(urdf, std::max(1, document.ErrorLineNum()), "",
         "is not valid XML: " + reason_of(text, document.ErrorID()));
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot") {
    const std::string got = root == nullptr ? "" : root->Name();
    fail(urdf, root == nullptr ? 1 : root->GetLineNum(), "",
         "root element must be <robot>, got <" + got + ">" + advice_for(got));
  }
  Inventory(urdf).take(*root);
  Reader(urdf).read(*root);
  return urdf;
}

Urdf read_urdf_file(const std::filesystem::path& file) {
  return read_urdf_text(read_file(file, kMostBytes), file.string());
}

}  // namespace hg::model
