#include "apps/hapticgiant/print_datasheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/command_line/output.h"

namespace hg::apps {
namespace {

using check::Bottleneck;
using check::Datasheet;
using check::Distribution;
using check::JointLine;

std::string or_none(double value, const char* unit) {
  return std::isfinite(value) ? fmt::format("{:.4g} {}", value, unit) : "-";
}

std::string range(const JointLine& joint) {
  const char* unit = joint.is_angle ? "rad" : "m";
  if (!joint.range.bounded()) return "unlimited";
  return fmt::format("{:.2f} .. {:.2f} {}", joint.range.lb, joint.range.ub, unit);
}

void print_joints(const Datasheet& sheet) {
  std::size_t width = 5;
  for (const JointLine& joint : sheet.joints) width = std::max(width, joint.name.size());
  const auto line = [&](const std::string& name, const std::string& positions,
                        const std::string& speed, const std::string& acceleration,
                        const std::string& rating, const std::string& gravity) {
    print_out("  {:<{}}  {:<20}  {:<11}  {:<12}  {:<8}  {}\n", name, width, positions, speed,
              acceleration, rating, gravity);
  };
  line("joint", "range", "speed", "acceleration", "rating", "gravity");
  for (const JointLine& joint : sheet.joints) {
    const char* effort = joint.is_angle ? "Nm" : "N";
    line(joint.name, range(joint), or_none(joint.dq_max, joint.is_angle ? "rad/s" : "m/s"),
         or_none(joint.ddq_max, joint.is_angle ? "rad/s^2" : "m/s^2"),
         or_none(joint.effort_max, effort), fmt::format("{:.1f} {}", joint.gravity_max, effort));
  }
}

void print_workspace(const Datasheet& sheet) {
  const workspace::HandleWorkspace& space = sheet.workspace;
  if (sheet.reach > 0.0) {
    print_out("  reach               {:.2f} m, handle from the axis of the arm's first joint\n",
              sheet.reach);
  }
  const Eigen::Vector3d low = space.bounds.min(), high = space.bounds.max();
  print_out(
      "  workspace           {:.1f} m^3 within all limits; x {:.2f} .. {:.2f}, y {:.2f} .. "
      "{:.2f}, z {:.2f} .. {:.2f} m\n",
      space.volume, low.x(), high.x(), low.y(), high.y(), low.z(), high.z());
  if (!space.has_box) return;
  print_out(
      "  box of the handle   {:.2f} m^3: {:.0f} % reached in some orientation, {:.0f} % in "
      "the nominal one (handle axis {:.2f} {:.2f} {:.2f})\n",
      space.box_volume, 100.0 * space.share_any, 100.0 * space.share_nominal,
      space.nominal_axis.x(), space.nominal_axis.y(), space.nominal_axis.z());
}

// three digits, never with an exponent
std::string short_number(double value) {
  return std::abs(value) < 100.0 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

std::string values(const Distribution& d, const char* unit) {
  return fmt::format("{} {} in 95 % of the postures, median {}, least {}", short_number(d.low),
                     unit, short_number(d.median), short_number(d.smallest));
}

std::string by(const Bottleneck& bottleneck) {
  if (bottleneck.joint.empty()) return "";
  return fmt::format("; limited by {} in {:.0f} %", bottleneck.joint, 100.0 * bottleneck.share);
}

void print_capability(const Datasheet& sheet) {
  if (sheet.has_ratings) {
    print_out("  force               {}{}\n", values(sheet.force, "N"), by(sheet.force_bottleneck));
    print_out("  torque              {}{}\n", values(sheet.torque, "Nm"),
              by(sheet.torque_bottleneck));
    print_out("  50 N and 10 Nm      at once, in any directions: {:.0f} % of the postures\n",
              100.0 * sheet.share_paper_wrench);
  } else {
    const bool has_some = sheet.unrated.size() < sheet.joints.size();
    print_out("  force, torque       unknown: {}\n",
              has_some ? fmt::format("no effort in the URDF: {}", fmt::join(sheet.unrated, ", "))
                       : std::string("the URDF gives no effort"));
  }
  print_out("  acceleration        {}{}\n", values(sheet.acceleration, "m/s^2"),
            by(sheet.acceleration_bottleneck));
  if (sheet.has_ratings) {
    print_out(
        "  free body           {:.0f} kg: what the force above moves with that acceleration\n",
        sheet.free_body_mass);
  }
}

nlohmann::json vector_json(const Eigen::Ref<const Eigen::VectorXd>& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

void print_walls(const Datasheet& sheet) {
  if (sheet.walls.empty()) return;
  std::string text;
  for (const check::WallForce& wall : sheet.walls) {
    text += text.empty() ? "" : ", ";
    text += wall.places == 0 ? wall.name() + " not reached"
                             : fmt::format("{} {:.0f} N ({})", wall.name(), wall.least, wall.motor);
  }
  print_out("  walls hold          {}: least over their places\n", text);
}

nlohmann::json walls_json(const Datasheet& sheet) {
  nlohmann::json walls = nlohmann::json::array();
  for (const check::WallForce& wall : sheet.walls) {
    nlohmann::json json = {{"wall", wall.name()}, {"places", wall.places}};
    if (wall.places > 0) {
      json["least_N"] = wall.least;
      json["median_N"] = wall.median;
      json["motor"] = wall.motor;
      json["place_m"] = vector_json(wall.place);
    }
    walls.push_back(json);
  }
  return walls;
}

void print_conditioning(const Datasheet& sheet) {
  print_out(
      "  conditioning        condition number {:.1f}, 5 % above {:.0f}; lengths in {:.2f} m\n",
      sheet.condition_median, sheet.condition_high, sheet.length);
  print_out("  nearest singularity smallest singular value {:.2g} at",
            sheet.most_singular.conditioning.smallest);
  const Eigen::VectorXd& q = sheet.most_singular.q;
  for (std::size_t i = 0; i < sheet.joints.size(); ++i) {
    if (sheet.joints[i].is_gantry) continue;
    print_out(" {} {:.2f}", sheet.joints[i].name, q[i]);
  }
  print_out("\n");
}

void print_bandwidth(const check::Bandwidth& bandwidth) {
  print_out("  bandwidth           control {:g} Hz, handle onto twin {:.1f} Hz", bandwidth.rate_Hz,
            bandwidth.synchronisation_Hz);
  if (bandwidth.gantry_Hz > 0.0) {
    print_out(", gantry {:.1f} Hz (its drive {:.1f} Hz)", bandwidth.gantry_Hz, bandwidth.drive_Hz);
  }
  if (bandwidth.wrench_delay_s > 0.0) {
    print_out(", force {:.1f} ms behind", 1e3 * bandwidth.wrench_delay_s);
  }
  print_out("\n");
}

nlohmann::json distribution_json(const Distribution& d) {
  return {{"least", d.smallest}, {"low_5_percent", d.low}, {"median", d.median}};
}

nlohmann::json joint_json(const JointLine& joint) {
  const std::string unit = joint.is_angle ? "rad" : "m";
  const std::string effort = joint.is_angle ? "Nm" : "N";
  return {{"name", joint.name},
          {"gantry", joint.is_gantry},
          {"q_min_" + unit, joint.range.lb},
          {"q_max_" + unit, joint.range.ub},
          {"dq_max_" + unit + "_per_s", joint.dq_max},
          {"ddq_max_" + unit + "_per_s2", joint.ddq_max},
          {"effort_max_" + effort, joint.effort_max},
          {"gravity_max_" + effort, joint.gravity_max}};
}

// prints, of axes with the same limit, the one that needs most of it
void print_stopping(const Datasheet& sheet) {
  std::map<std::string, const check::Stopping*> most;
  for (const check::Stopping& axis : sheet.stopping) {
    const check::Stopping*& worst = most[axis.key];
    if (worst == nullptr || axis.need.distance > worst->need.distance) worst = &axis;
  }
  std::string text;
  for (const auto& [key, axis] : most) {
    const char* unit = axis->is_angle ? "rad" : "m";
    text += fmt::format(", {:g} {} ({} needs {:.2f} {} from full speed)", axis->distance, unit,
                        axis->name, axis->need.distance, unit);
  }
  print_out("  stops               within {:g} s{}\n", sheet.stop_time, text);
}

nlohmann::json stopping_json(const Datasheet& sheet) {
  nlohmann::json axes = nlohmann::json::array();
  for (const check::Stopping& axis : sheet.stopping) {
    const std::string unit = axis.is_angle ? "rad" : "m";
    axes.push_back({{"name", axis.name},
                    {"distance_" + unit, axis.distance},
                    {"needs_" + unit, axis.need.distance},
                    {"needs_s", axis.need.time}});
  }
  return {{"time_s", sheet.stop_time}, {"axes", axes}};
}

}  // namespace

void print_datasheet(const Datasheet& sheet) {
  print_out("\n{}: datasheet\n", sheet.name);
  if (sheet.postures == 0) {
    print_out("  none: no posture was found within all limits\n");
    return;
  }
  print_joints(sheet);
  print_workspace(sheet);
  print_capability(sheet);
  print_walls(sheet);
  print_conditioning(sheet);
  print_bandwidth(sheet.bandwidth);
  print_stopping(sheet);
  print_out(
      "  Of {} postures drawn uniformly in the joint ranges (seed {}), handle in the worst "
      "direction, at rest,\n  against the ratings less gravity. How to read it: "
      "docs/start/check.md\n",
      sheet.postures, sheet.options.seed);
}

nlohmann::json datasheet_json(const Datasheet& sheet) {
  nlohmann::json json = {{"name", sheet.name},
                         {"seed", sheet.options.seed},
                         {"postures", sheet.postures},
                         {"share_in_boxes", sheet.share_in_boxes}};
  json["joints"] = nlohmann::json::array();
  if (sheet.postures == 0) return json;
  for (const JointLine& joint : sheet.joints) json["joints"].push_back(joint_json(joint));
  json["stopping"] = stopping_json(sheet);
  json["walls"] = walls_json(sheet);
  const workspace::HandleWorkspace& space = sheet.workspace;
  json["reach_m"] = sheet.reach;
  json["workspace"] = {{"volume_m3", space.volume},
                       {"lower_m", vector_json(space.bounds.min())},
                       {"upper_m", vector_json(space.bounds.max())}};
  if (space.has_box) {
    json["box"] = {{"volume_m3", space.box_volume},
                   {"share_any_orientation", space.share_any},
                   {"share_nominal_orientation", space.share_nominal}};
  }
  if (sheet.has_ratings) {
    json["force_N"] = distribution_json(sheet.force);
    json["torque_Nm"] = distribution_json(sheet.torque);
    json["share_50_N_and_10_Nm"] = sheet.share_paper_wrench;
    json["free_body_mass_kg"] = sheet.free_body_mass;
  }
  json["acceleration_m_per_s2"] = distribution_json(sheet.acceleration);
  json["condition_median"] = sheet.condition_median;
  json["smallest_singular_value"] = sheet.most_singular.conditioning.smallest;
  json["most_singular_posture"] = vector_json(sheet.most_singular.q);
  return json;
}

}  // namespace hg::apps
