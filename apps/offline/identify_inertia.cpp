#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/offline/identify_command.h"
#include "hg/identify/inertia.h"

namespace hg::apps {
namespace {

using identify::BaseFigure;
using identify::Figure;
using identify::InertiaEstimate;
using identify::JointFit;
using identify::kLinkFigures;
using identify::LinkInertia;
using identify::RecordedInertia;

constexpr std::array<const char*, kLinkFigures> kNames = {
    "mass_kg",   "com_x_m",   "com_y_m",   "com_z_m",   "ixx_kg_m2",
    "ixy_kg_m2", "iyy_kg_m2", "ixz_kg_m2", "iyz_kg_m2", "izz_kg_m2"};

// A long combination without its end.
std::string shortened(const std::string& name) {
  constexpr std::size_t kLongest = 60;
  return name.size() <= kLongest ? name : name.substr(0, kLongest) + " ...";
}

void print_motion(const InertiaEstimate& found) {
  for (const JointFit& joint : found.joints) {
    print_out(
        "{:<22} moved over {:.2f} rad, {:.2g} rad/s^2 rms; {:.3g} Nm rms unexplained, {:.3g} "
        "by the files\n",
        joint.name, joint.way, joint.acceleration, joint.after, joint.before);
  }
}

void print_base(const InertiaEstimate& found) {
  print_out("\n{} of {} base parameters show (kg, kg m, kg m^2):\n{:>10} {:>10} {:>9}\n",
            found.shown, found.base.size(), "URDF", "found", "+-");
  for (const BaseFigure& base : found.base) {
    print_out("{:>10.4f} {:>10.4f} {:>9.4f}  {}{}\n", base.nominal, base.found.value,
              base.found.interval(), shortened(base.name), base.found.is_found ? "" : "  (open)");
  }
}

void print_link(const LinkInertia& link) {
  print_out("\n{:<14}{:>10} {:>10} {:>9}\n", link.name, "URDF", "found", "+-");
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const Figure& figure = link.figures[i];
    print_out("  {:<12}{:>10.4f} {:>10.4f} {:>9.4f}{}\n", kNames[i], link.nominal_values[i],
              figure.value, figure.interval(), figure.is_found ? "" : "  mostly the URDF's");
  }
}

void print_urdf(const InertiaEstimate& found) {
  print_out("\nfor the URDF, all of them together:\n");
  for (const LinkInertia& link : found.links) {
    const model::Inertial& inertial = link.found;
    const Eigen::Matrix3d& I = inertial.inertia;
    print_out(
        "<!-- {} -->\n<inertial>\n  <origin xyz=\"{:.6g} {:.6g} {:.6g}\" rpy=\"0 0 0\"/>\n"
        "  <mass value=\"{:.6g}\"/>\n  <inertia ixx=\"{:.6g}\" ixy=\"{:.6g}\" ixz=\"{:.6g}\" "
        "iyy=\"{:.6g}\" iyz=\"{:.6g}\" izz=\"{:.6g}\"/>\n</inertial>\n",
        link.name, inertial.p_com.x(), inertial.p_com.y(), inertial.p_com.z(), inertial.mass,
        I(0, 0), I(0, 1), I(0, 2), I(1, 1), I(1, 2), I(2, 2));
  }
}

nlohmann::ordered_json to_json(const Figure& figure, double nominal) {
  nlohmann::ordered_json json;
  json["urdf"] = nominal;
  json["value"] = figure.value;
  json["deviation"] = figure.deviation;
  json["is_found"] = figure.is_found;
  return json;
}

nlohmann::ordered_json to_json(const InertiaEstimate& found) {
  nlohmann::ordered_json json;
  json["identified"] = "inertia";
  json["missing"] = found.missing;
  for (const JointFit& joint : found.joints) {
    nlohmann::ordered_json entry;
    entry["name"] = joint.name;
    entry["way_rad"] = joint.way;
    entry["acceleration_rad_per_s2"] = joint.acceleration;
    entry["unexplained_Nm"] = joint.after;
    entry["unexplained_by_files_Nm"] = joint.before;
    json["joints"].push_back(entry);
  }
  json["base"] = nlohmann::ordered_json::array();
  for (const BaseFigure& base : found.base) {
    nlohmann::ordered_json entry = to_json(base.found, base.nominal);
    entry["name"] = base.name;
    json["base"].push_back(entry);
  }
  json["links"] = nlohmann::ordered_json::array();
  for (const LinkInertia& link : found.links) {
    nlohmann::ordered_json entry;
    entry["name"] = link.name;
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      entry[kNames[i]] = to_json(link.figures[i], link.nominal_values[i]);
    }
    json["links"].push_back(entry);
  }
  return json;
}

}  // namespace

int identify_inertia(const IdentifyRecordingArguments& arguments) {
  check_writable(arguments.json, kJson);
  const RecordedInertia result =
      identify::identify_recorded_inertia(arguments.file, given_device(arguments));
  const InertiaEstimate& found = result.found;
  print_out(recording::to_text(result.losses));
  print_out("{}: drives on for {:.1f} s; +- is the 95 % interval\n", arguments.file, result.used_s);
  print_motion(found);
  write_json(arguments.json, to_json(found));
  if (!found.missing.empty()) {
    print_error("not usable: {}\n", found.missing);
    return 2;
  }
  print_base(found);
  for (const LinkInertia& link : found.links) print_link(link);
  print_urdf(found);
  return 0;
}

}  // namespace hg::apps
