#include "hg/design/design_urdf.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <sstream>
#include <string_view>

#include "hg/core/error.h"

namespace hg::design {
namespace {

using tinyxml2::XMLElement;

std::string text_of(double value) {
  const double rounded = std::round(value * 1e9) / 1e9;
  return fmt::format("{}", rounded == 0.0 ? 0.0 : rounded);
}

std::string text_of(const Eigen::Vector3d& v) {
  return text_of(v[0]) + " " + text_of(v[1]) + " " + text_of(v[2]);
}

Eigen::Vector3d vector_of(const XMLElement* element, const char* attribute) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (element == nullptr || element->Attribute(attribute) == nullptr) return v;
  std::istringstream words(element->Attribute(attribute));
  words >> v[0] >> v[1] >> v[2];
  return v;
}

Eigen::Matrix3d rotation_of(const XMLElement* origin) {
  const Eigen::Vector3d rpy = vector_of(origin, "rpy");
  return (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

XMLElement& named(XMLElement& robot, const char* kind, std::string_view name) {
  for (XMLElement* it = robot.FirstChildElement(kind); it != nullptr;
       it = it->NextSiblingElement(kind)) {
    const char* own = it->Attribute("name");
    if (own != nullptr && own == name) return *it;
  }
  throw SetupError(fmt::format("design: the base's URDF has no {} '{}'", kind, name));
}

XMLElement& child(XMLElement& parent, const char* name) {
  if (XMLElement* found = parent.FirstChildElement(name)) return *found;
  const char* own = parent.Attribute("name");
  throw SetupError(
      fmt::format("design: '{}' of the base's URDF has no <{}>", own ? own : "?", name));
}

// A coordinate along an axis to its new place.
using Move = std::function<double(double)>;

// Cylinder or box of a link: its ends along axis `axis` are moved.
void stretch(XMLElement& item, int axis, const Move& move) {
  XMLElement& origin = child(item, "origin");
  XMLElement& geometry = child(item, "geometry");
  Eigen::Vector3d p = vector_of(&origin, "xyz");
  const Eigen::Matrix3d R = rotation_of(&origin);
  double half = 0.0;
  int edge = -1;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  XMLElement* cylinder = geometry.FirstChildElement("cylinder");
  XMLElement* box = geometry.FirstChildElement("box");
  if (cylinder != nullptr) {
    size[2] = cylinder->DoubleAttribute("length");
    if (std::abs(R(axis, 2)) > 0.99) edge = 2;
  } else if (box != nullptr) {
    size = vector_of(box, "size");
    for (int i = 0; i < 3; ++i) {
      if (std::abs(R(axis, i)) > 0.99) edge = i;
    }
  }
  if (edge >= 0) half = 0.5 * size[edge];
  const double from = move(p[axis] - half), to = move(p[axis] + half);
  p[axis] = 0.5 * (from + to);
  origin.SetAttribute("xyz", text_of(p).c_str());
  if (edge < 0) return;
  size[edge] = to - from;
  if (cylinder != nullptr) {
    cylinder->SetAttribute("length", text_of(size[2]).c_str());
  } else {
    box->SetAttribute("size", text_of(size).c_str());
  }
}

void scale_radius(XMLElement& item, double factor) {
  for (const char* shape : {"cylinder", "sphere"}) {
    XMLElement* found = child(item, "geometry").FirstChildElement(shape);
    if (found == nullptr) continue;
    found->SetAttribute("radius", text_of(factor * found->DoubleAttribute("radius")).c_str());
  }
}

void each_shape(XMLElement& link, const std::function<void(XMLElement&, bool is_visual)>& visit) {
  for (const char* kind : {"visual", "collision"}) {
    for (XMLElement* it = link.FirstChildElement(kind); it != nullptr;
         it = it->NextSiblingElement(kind)) {
      visit(*it, std::string_view(kind) == "visual");
    }
  }
}

// How a link of the arm runs from its joint to the next.
struct Run {
  const char* link;
  int axis;
  double sign;
  double keep_start, keep_end;  // shares of the length that are fittings and do not stretch
};

constexpr std::array<Run, 6> kRuns = {{{"m1", 0, 1, 0.28, 0.19},
                                       {"m2", 0, 1, 0.28, 0.19},
                                       {"m3", 2, -1, 0.28, 0.19},
                                       {"m4", 1, -1, 0.28, 0.19},
                                       {"m5", 0, 1, 0.0, 0.0},
                                       {"m6", 2, 1, 0.28, 0.5}}};

std::array<double, 6> by_link(const model::haptic_giant::Lengths& lengths) {
  return {lengths.L1, lengths.L2, lengths.D3, lengths.L4, 0.0, lengths.D6};
}

void set_inertial(XMLElement& link, const Run& run, const DesignLink& values) {
  XMLElement& inertial = child(link, "inertial");
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  p[run.axis] = run.sign * values.centre;
  child(inertial, "origin").SetAttribute("xyz", text_of(p).c_str());
  child(inertial, "mass").SetAttribute("value", text_of(values.mass).c_str());
  XMLElement& inertia = child(inertial, "inertia");
  constexpr std::array kKeys = {"ixx", "iyy", "izz"};
  for (int i = 0; i < 3; ++i) {
    const double value = i == run.axis ? values.axial_inertia : values.inertia;
    inertia.SetAttribute(kKeys[static_cast<std::size_t>(i)], text_of(value).c_str());
  }
}

void change_link(XMLElement& robot, const Run& run, const DesignLink& values, double from,
                 double to) {
  XMLElement& link = named(robot, "link", run.link);
  const double start = run.keep_start * from, end = (1.0 - run.keep_end) * from;
  const double longer = to - from;
  if (from > 0.0 && end - start + longer < 0.02) {
    throw SetupError(
        fmt::format("design: link {} of {:.3f} m is too short for its joints; {:.3f} m "
                    "would do",
                    run.link, to, from - (end - start) + 0.02));
  }
  const Move move = [&](double x) {
    const double t = run.sign * x;
    if (from == 0.0 || t <= start) return x;
    const double share = std::min(1.0, (t - start) / (end - start));
    return run.sign * (t + share * longer);
  };
  each_shape(link, [&](XMLElement& item, bool is_visual) {
    const double t = run.sign * vector_of(&child(item, "origin"), "xyz")[run.axis];
    scale_radius(item, is_visual && t < start ? values.scale_start : values.scale_end);
    stretch(item, run.axis, move);
  });
  set_inertial(link, run, values);

  // what is fixed to the end of the link
  for (XMLElement* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const char* parent = child(*joint, "parent").Attribute("link");
    if (parent == nullptr || std::string_view(parent) != run.link) continue;
    XMLElement& origin = child(*joint, "origin");
    Eigen::Vector3d p = vector_of(&origin, "xyz");
    p[run.axis] = move(p[run.axis]);
    origin.SetAttribute("xyz", text_of(p).c_str());
  }
  XMLElement& limit = child(named(robot, "joint", run.link), "limit");
  limit.SetAttribute("velocity", text_of(values.velocity).c_str());
  limit.SetAttribute("effort", text_of(values.effort).c_str());
}

// The frame of the hall grows at its outer ends, and down to the floor.
void change_gantry(XMLElement& robot, const UrdfChange& change) {
  constexpr double kInner = 1.0;   // m; what is nearer to the middle stays
  constexpr double kBelow = -1.5;  // m; what is lower stands on the floor
  const auto wider = [](double by) -> Move {
    return [by](double x) { return std::abs(x) > kInner ? x + std::copysign(0.5 * by, x) : x; };
  };
  each_shape(named(robot, "link", "base"), [&](XMLElement& item, bool) {
    stretch(item, 0, wider(change.wider_x));
    stretch(item, 1, wider(change.wider_y));
    stretch(item, 2, [&](double z) { return z < kBelow ? z - change.higher : z; });
  });
  each_shape(named(robot, "link", "ppu1"),
             [&](XMLElement& item, bool) { stretch(item, 1, wider(change.wider_y)); });
  for (int i = 0; i < 2; ++i) {
    XMLElement& limit = child(named(robot, "joint", i == 0 ? "ppu1" : "ppu2"), "limit");
    const double end = change.gantry_end[static_cast<std::size_t>(i)];
    limit.SetAttribute("lower", text_of(-end).c_str());
    limit.SetAttribute("upper", text_of(end).c_str());
  }
}

// Comments of the base give its measures.
void delete_comments(tinyxml2::XMLNode& node) {
  for (tinyxml2::XMLNode* it = node.FirstChild(); it != nullptr;) {
    tinyxml2::XMLNode* next = it->NextSibling();
    if (it->ToComment() != nullptr) {
      node.DeleteChild(it);
    } else {
      delete_comments(*it);
    }
    it = next;
  }
}

}  // namespace

std::string changed_urdf(const std::string& text, const UrdfChange& change) {
  tinyxml2::XMLDocument document;
  XMLElement* robot = document.Parse(text.data(), text.size()) == tinyxml2::XML_SUCCESS
                          ? document.FirstChildElement("robot")
                          : nullptr;
  if (robot == nullptr) throw SetupError("design: the base's URDF is not valid");
  delete_comments(document);
  document.InsertFirstChild(document.NewComment((" " + change.comment + " ").c_str()));
  if (tinyxml2::XMLNode* declaration = document.FirstChild()->NextSibling();
      declaration->ToDeclaration() != nullptr) {
    document.InsertFirstChild(declaration);
  }
  const std::array<double, 6> from = by_link(change.from), to = by_link(change.to);
  for (std::size_t i = 0; i < kRuns.size(); ++i) {
    change_link(*robot, kRuns[i], change.links[i], from[i], to[i]);
  }
  change_gantry(*robot, change);
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

}  // namespace hg::design
