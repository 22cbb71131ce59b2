#include "apps/offline/design_command.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/python_program.h"
#include "apps/hapticgiant/report.h"
#include "apps/offline/subcommand.h"
#include "hg/config/device.h"
#include "hg/config/shipped_files.h"
#include "hg/core/error.h"
#include "hg/design/device_metrics.h"
#include "hg/design/human_arm.h"
#include "hg/design/human_capability.h"

namespace hg::apps {
namespace {

using nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
// poses of the hand, where the device has a closed form and where each takes 50 ms
constexpr int kPoses = 1000, kPosesNumerically = 200;

struct DesignArguments {
  std::string device;
  std::string person = "male,50";
  design::CapabilityOptions capability;
  int poses = 0;  ///< 0: by the device
  std::string grip;
  std::string json, picture;
};

design::HumanArm arm_of(const std::string& person) {
  const std::size_t comma = person.find(',');
  const std::string sex = person.substr(0, comma);
  const auto refuse = [&person] {
    throw SetupError(fmt::format(
        "--person: expected male or female, a comma and the percentile of the stature, for example "
        "female,5, got '{}'",
        person));
  };
  if (comma == std::string::npos || (sex != "male" && sex != "female")) refuse();
  const std::optional<double> percentile = number_in(person.substr(comma + 1));
  if (!percentile) refuse();
  return design::human_arm(sex == "male" ? design::Sex::kMale : design::Sex::kFemale, *percentile);
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

template <class Vector>
ordered_json array_of(const Vector& v) {
  return std::vector<double>(v.data(), v.data() + v.size());
}

ordered_json array_of(const Eigen::Matrix3d& R) {  // row by row
  const Eigen::Matrix3d transposed = R.transpose();
  return std::vector<double>(transposed.data(), transposed.data() + 9);
}

ordered_json pose_json(const Pose& pose) {
  return {{"p_m", array_of(pose.p)}, {"R", array_of(pose.R)}};
}

ordered_json arm_json(const design::HumanArm& arm) {
  ordered_json joints = ordered_json::array(), body = ordered_json::array();
  for (const design::ArmJoint& joint : arm.joints) {
    joints.push_back({{"name", joint.name},
                      {"q_min_rad", joint.range.lb},
                      {"q_max_rad", joint.range.ub},
                      {"dq_max_rad_per_s", joint.dq_max},
                      {"ddq_max_rad_per_s2", joint.ddq_max},
                      {"torque_Nm", joint.torque}});
  }
  for (const design::Capsule& part : arm.body) {
    body.push_back(
        {{"from_m", array_of(part.from)}, {"to_m", array_of(part.to)}, {"radius_m", part.radius}});
  }
  return {{"sex", to_string(arm.sex)},
          {"stature_m", arm.stature},
          {"shoulder_m", array_of(arm.p_shoulder)},
          {"upper_arm_m", arm.upper_arm},
          {"forearm_m", arm.forearm},
          {"hand_m", arm.hand},
          {"joints", joints},
          {"body", body}};
}

ordered_json capability_json(const design::HumanCapability& human) {
  return {{"seed", human.options.seed},
          {"samples", human.options.samples},
          {"effort", human.options.effort},
          {"share_clear_of_body", human.share_clear},
          {"voxel_m", human.options.voxel},
          {"volume_m3", human.volume},
          {"cells", human.cells}};
}

ordered_json hand_json(const design::HandPose& hand) {
  return {
      {"T_F_hand", pose_json(hand.T_F_hand)}, {"q_rad", array_of(hand.q)}, {"weight", hand.weight}};
}

std::string person_text(const design::HumanArm& arm) {
  return fmt::format("{}, {:.2f} m tall, {:.2f} m from the shoulder to the grip",
                     arm.sex == design::Sex::kMale ? "man" : "woman", arm.stature,
                     arm.upper_arm + arm.forearm + arm.hand);
}

// Writes the results to the file and draws the picture that were asked for; the exit code.
int write_and_draw(const ordered_json& json, const DesignArguments& arguments) {
  write_json(arguments.json, json);
  if (arguments.picture.empty()) return 0;
  return become_reports({{.results = json, .files = {{"picture.svg", arguments.picture}}}});
}

int run_arm(const DesignArguments& arguments) {
  check_writable(arguments.json, kJson);
  check_writable(arguments.picture, kSvg);
  design::CapabilityOptions options = arguments.capability;
  if (arguments.poses > 0) options.poses = arguments.poses;
  const design::HumanCapability human = design::human_capability(arm_of(arguments.person), options);
  const design::HumanArm& arm = human.arm;
  print_out("{}\n", person_text(arm));
  print_out(
      "  joint               range, degrees  speed, rad/s  acceleration, rad/s^2  torque, Nm\n");
  for (const design::ArmJoint& joint : arm.joints) {
    print_out("  {:<18}  {:>5.0f} .. {:>4.0f}   {:>11.3g}  {:>21.3g}  {:>10.2g}\n", joint.name,
              kDegrees * joint.range.lb, kDegrees * joint.range.ub, joint.dq_max, joint.ddq_max,
              joint.torque);
  }
  print_out("  reaches {:.2f} m^3 in cubes of {:g} m, {} poses of the hand apart by their cell\n",
            human.volume, options.voxel, human.cells);
  print_out("  {} joint vectors (seed {}), {} of them without entering the body\n", options.samples,
            options.seed, percent(human.share_clear));
  if (arguments.json.empty() && arguments.picture.empty()) return 0;
  ordered_json json = {{"kind", "human_arm"}, {"arm", arm_json(arm)}};
  json["capability"] = capability_json(human);
  json["poses"] = ordered_json::array();
  for (const design::HandPose& hand : human.poses) {
    ordered_json item = hand_json(hand);
    item["velocity"] = array_of(hand.velocity);
    item["turn_velocity"] = array_of(hand.turn_velocity);
    item["acceleration"] = array_of(hand.acceleration);
    item["turn_acceleration"] = array_of(hand.turn_acceleration);
    item["force"] = array_of(hand.force);
    item["torque"] = array_of(hand.torque);
    json["poses"].push_back(std::move(item));
  }
  return write_and_draw(json, arguments);
}

ordered_json quantiles_json(const design::Quantiles& quantiles) {
  return {
      {"least", quantiles.least}, {"low_5_percent", quantiles.low}, {"median", quantiles.median}};
}

ordered_json metrics_json(const design::DeviceMetrics& metrics) {
  ordered_json json = {{"poses", metrics.poses},
                       {"reached", metrics.reached},
                       {"coverage_pose", metrics.pose},
                       {"coverage_velocity", metrics.velocity},
                       {"coverage_turn_velocity", metrics.turn_velocity},
                       {"coverage_acceleration", metrics.acceleration},
                       {"coverage_turn_acceleration", metrics.turn_acceleration}};
  if (metrics.reached == 0) return json;
  if (metrics.has_torques) {
    json["force_N"] = quantiles_json(metrics.force);
    json["torque_Nm"] = quantiles_json(metrics.torque);
    json["share_50_N"] = metrics.share_force;
    json["share_10_Nm"] = metrics.share_torque;
    json["share_50_N_and_10_Nm"] = metrics.share_wrench;
  }
  json["share_regular"] = metrics.share_regular;
  json["moving_mass_kg"] = metrics.moving_mass;
  json["reflected_mass_mean_kg"] = metrics.mass_mean;
  json["reflected_mass_worst_kg"] = metrics.mass_worst;
  if (metrics.frequency_clamped > 0.0) {
    json["eigenfrequency_free_median_Hz"] = metrics.frequency_median;
    json["eigenfrequency_free_least_Hz"] = metrics.frequency_least;
    json["eigenfrequency_clamped_Hz"] = metrics.frequency_clamped;
  }
  return json;
}

ordered_json pose_metrics_json(const design::PoseMetrics& pose) {
  if (!pose.is_reached) return {{"reached", false}};
  return {{"reached", true},
          {"q", array_of(pose.q)},
          {"velocity", pose.velocity},
          {"turn_velocity", pose.turn_velocity},
          {"acceleration", pose.acceleration},
          {"turn_acceleration", pose.turn_acceleration},
          {"force_N", pose.force},
          {"torque_Nm", pose.torque},
          {"condition", pose.condition},
          {"reflected_mass_kg", pose.mass},
          {"reflected_mass_worst_kg", pose.mass_worst},
          {"eigenfrequency_Hz", pose.frequency}};
}

void print_metrics(const design::DeviceMetrics& m, const design::MetricOptions& options) {
  print_out("  poses         {} of {} reached\n", m.reached, m.poses);
  print_out("  coverage      poses {}, speed {} (turning {}), acceleration {} (turning {})\n",
            percent(m.pose), percent(m.velocity), percent(m.turn_velocity), percent(m.acceleration),
            percent(m.turn_acceleration));
  print_out("  moving mass   {:.1f} kg\n", m.moving_mass);
  if (m.reached == 0) return;
  print_out("in the poses that are reached:\n");
  if (m.has_torques) {
    print_out("  force         {:.0f} N in 95 %, median {:.0f} N; {:g} N in {}\n", m.force.low,
              m.force.median, options.force, percent(m.share_force));
    print_out(
        "  torque        {:.1f} Nm in 95 %, median {:.1f} Nm; {:g} Nm in {}, both at once in {}\n",
        m.torque.low, m.torque.median, options.torque, percent(m.share_torque),
        percent(m.share_wrench));
  } else {
    print_out("  force, torque unknown: the URDF gives no effort\n");
  }
  print_out("  regular       {}: condition number at most {:g}, lengths in {:g} m\n",
            percent(m.share_regular), options.condition_max, options.length);
  print_out("  felt mass     mean {:.1f} kg, worst direction {:.1f} kg (95 %), {}\n", m.mass_mean,
            m.mass_worst, m.frequency_clamped > 0.0 ? "motors included" : "links alone");
  if (m.frequency_clamped > 0.0) {
    print_out(
        "  first mode    handle free, motors held: {:.1f} Hz, least {:.1f} Hz; links held, motors "
        "free: {:.1f} Hz\n",
        m.frequency_median, m.frequency_least, m.frequency_clamped);
  }
}

int run_measure(const DesignArguments& arguments) {
  check_writable(arguments.json, kJson);
  check_writable(arguments.picture, kSvg);
  const config::DeviceConfig device =
      config::load_device(config::find_device(arguments.device, {}));
  design::MetricOptions options = design::metric_options(device);
  options.keeps_poses = !arguments.json.empty() || !arguments.picture.empty();
  if (arguments.grip == "across") options.grip = design::Grip::kAcross;
  if (arguments.grip == "along") options.grip = design::Grip::kAlong;
  design::CapabilityOptions capability = arguments.capability;
  capability.poses = arguments.poses;
  if (capability.poses == 0) {
    capability.poses = design::closed_form(device.model) ? kPoses : kPosesNumerically;
  }
  const design::HumanCapability human =
      design::human_capability(arm_of(arguments.person), capability);
  options.T_B_F = design::place_person(device.model, human, options);
  const design::DeviceMetrics metrics = design::measure(device.model, human, options);

  print_out("{}, for a {}\n", device.name, person_text(human.arm));
  print_metrics(metrics, options);
  print_out(
      "Of {} poses that the hand reaches (seed {}), gripping {}. How to read it: "
      "docs/concepts/human_arm.md\n",
      human.cells, capability.seed,
      options.grip == design::Grip::kAcross ? "across the handle" : "along the handle");
  if (!options.keeps_poses) return 0;
  ordered_json json = {{"kind", "device_metrics"}, {"device", device.name}};
  json["arm"] = arm_json(human.arm);
  json["capability"] = capability_json(human);
  json["T_B_F"] = pose_json(*options.T_B_F);
  json["R_hand_handle"] = array_of(design::hand_to_handle(options.grip));
  json["directions"] = options.directions;
  json["length_m"] = options.length;
  json["metrics"] = metrics_json(metrics);
  json["poses"] = ordered_json::array();
  for (std::size_t i = 0; i < human.poses.size(); ++i) {
    ordered_json item = {{"hand", hand_json(human.poses[i])}};
    item["device"] = pose_metrics_json(metrics.each[i]);
    json["poses"].push_back(std::move(item));
  }
  return write_and_draw(json, arguments);
}

void add_person(Command command, DesignArguments& arguments) {
  command
      .add_option("--person", arguments.person,
                  "SEX,PERCENTILE: male or female, percentile of the stature")
      .capture_default_str();
  command
      .add_option("--seed", arguments.capability.seed, "seed of the joint vectors that are drawn")
      .capture_default_str();
  command.add_option("--samples", arguments.capability.samples, "number of joint vectors to draw")
      .check(whole_number(1, 1e9))
      .capture_default_str();
  command
      .add_option("--effort", arguments.capability.effort,
                  "share of the largest speeds and accelerations that the person uses")
      .check(number_within(0.01, 1.0))
      .capture_default_str();
}

// `design FILE --out arm` is no `design arm`.
void refuse_search_words(Command design) {
  if (design.remaining().empty()) return;
  throw SetupError(
      fmt::format("design: '{}' before 'arm' or 'measure'; where it is the file of a problem, give "
                  "its folder another name, such as ./arm",
                  design.remaining().front()));
}

void add_arm(Command design, const std::shared_ptr<DesignArguments>& arguments, int& exit_code) {
  const Command arm = design.add_subcommand("arm", "The arm of a person: joints, reach, poses.");
  add_person(arm, *arguments);
  arm.add_option("--poses", arguments->poses, "poses of the hand in the file and the picture")
      .check(whole_number(1, 1e6));
  arm.add_option("--json", arguments->json, "write arm and poses as JSON to this file");
  arm.add_option("--picture", arguments->picture,
                 "draw reach, speeds and ranges of the joints to this SVG file");
  arm.footer("Example:\n  hapticgiant design arm --person female,5 --picture arm.svg");
  arm.callback([arguments, design, &exit_code] {
    refuse_search_words(design);
    exit_code = run_arm(*arguments);
  });
}

void add_measure(Command design, const std::shared_ptr<DesignArguments>& arguments,
                 int& exit_code) {
  const Command measure = design.add_subcommand(
      "measure", "How well a device serves a person's arm: coverage, force, mass, first mode.");
  measure.add_option("device", arguments->device, "device file, or the name of a shipped one")
      .required();
  add_person(measure, *arguments);
  measure
      .add_option("--poses", arguments->poses,
                  fmt::format("poses of the hand to judge; default {}, or {} where the device has "
                              "no closed form (0.1 s each)",
                              kPoses, kPosesNumerically))
      .check(whole_number(1, 1e6));
  measure
      .add_option("--grip", arguments->grip,
                  "how the hand holds the handle: across its z axis or along it; default across "
                  "for a HapticGiant, otherwise along")
      .one_of({"across", "along"});
  measure.add_option("--json", arguments->json, "write measures and poses as JSON to this file");
  measure.add_option("--picture", arguments->picture,
                     "draw the coverage over the hand's workspace to this SVG file");
  measure.footer(
      "Examples:\n"
      "  hapticgiant design measure haptic_giant\n"
      "  hapticgiant design measure my_device.yaml --person female,5 --json measures.json");
  measure.callback([arguments, design, &exit_code] {
    refuse_search_words(design);
    exit_code = run_measure(*arguments);
  });
}

}  // namespace

void add_design(Command app, int& exit_code) {
  const Command command = add_offline(app, "design");
  command.footer(
      "`hapticgiant design FILE` searches for a device, from requirements to one that runs:\n"
      "  hapticgiant design models/design/haptic_giant.yaml --quick --out my_giant\n"
      "Its options: -o, --out FOLDER, --seed N, --workers N, --quick, --no-feel.");
  command.require_subcommand(0, 1);
  command.allow_extras();  // of the search, which is Python's
  command.callback([command] {
    if (command.has_subcommand()) return;
    if (!command.remaining().empty()) become_python_program("design", command.remaining());
    throw SetupError(
        "design: expected 'arm', 'measure', or the file of a design problem, such as "
        "models/design/haptic_giant.yaml");
  });
  const auto arguments = std::make_shared<DesignArguments>();
  add_arm(command, arguments, exit_code);
  add_measure(command, arguments, exit_code);
}

}  // namespace hg::apps
