#include "hg/design/design_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hg/config/loader.h"
#include "hg/controller/safety/collision/distance.h"
#include "hg/controller/safety/collision/shapes.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"
#include "hg/model/chain_model.h"
#include "hg/model/urdf.h"

namespace hg::design {
namespace {

using config::Need;

// Of variables that make no device; a requirement counts 1 at most.
constexpr double kFaultViolation = 10.0;

constexpr std::array<config::Choice<Sex>, 2> kSexes = {
    {{"female", Sex::kFemale}, {"male", Sex::kMale}}};
constexpr std::array<config::Choice<Burden>, 2> kBurdens = {
    {{"moving_mass", Burden::kMovingMass}, {"price", Burden::kPrice}}};

template <std::size_t kCount>
std::vector<std::string> names_of(const std::array<const char*, kCount>& names) {
  return {names.begin(), names.end()};
}

std::vector<std::string> joint_names() { return {"m1", "m2", "m3", "m4", "m5", "m6"}; }

void read_requirements(config::Loader& loader, Requirements& out) {
  loader.number("force_N", out.force, config::kPositive, "in any direction");
  loader.number("torque_Nm", out.torque, config::kPositive, "in any direction");
  loader.number("moving_mass_kg", out.moving_mass, config::kPositive,
                "largest mass at the gantry's flange");
  loader.number("price", out.price, {.lb = 1.0, .ub = 1e12}, "largest price");
  loader.number("clearance_m", out.clearance, config::kNotNegative,
                "from the arm to the person's body");
  loader.number("clear_share", out.clear_share, {.lb = 0.0, .ub = 1.0},
                "of the poses that have this clearance");
  loader.number("walk_m2", out.walk_area, {.lb = 0.0, .ub = 1e4}, "area of the hand's box");
}

void read_search(config::Loader& loader, SearchOptions& out) {
  const auto whole = [&](const char* key, int& value, int least, int most, const char* text) {
    double number = value;
    loader.number(key, number, {.lb = static_cast<double>(least), .ub = static_cast<double>(most)},
                  text);
    loader.rule(number == std::floor(number), key, "must be a whole number");
    value = static_cast<int>(number);
  };
  whole("population", out.population, 8, 2000, "candidates per island");
  loader.rule(out.population % 4 == 0, "population", "must be a multiple of 4");
  whole("generations", out.generations, 10, 10000, "of each island");
  loader.rule(out.generations % 10 == 0, "generations", "must be a multiple of 10");
  whole("islands", out.islands, 1, 64, "that exchange their best");
  whole("poses", out.poses, 20, 100000, "of the hand that each candidate is judged with");
  whole("seed", out.seed, 0, 1000000000, "the same seed gives the same design");
}

// Area of the box that the hand may be in, m^2.
double walk_area(const DeviceModel& device) {
  const std::array<limits::JointLimits, 3> box = handle_limits(device);
  return (box[0].q_max - box[0].q_min) * (box[1].q_max - box[1].q_min);
}

collision::Shape shape_of(const Capsule& capsule) {
  const Eigen::Vector3d along = capsule.to - capsule.from;
  collision::Shape shape = {.name = "person", .is_surrounding = true};
  shape.T_frame_shape.p = 0.5 * (capsule.from + capsule.to);
  shape.T_frame_shape.R =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
  shape.radius = capsule.radius;
  shape.half_length = 0.5 * along.norm();
  return shape;
}

// How far `is` misses `needed`, as a share.
double missing(double is, double needed) {
  return needed > 0.0 && std::isfinite(needed) ? std::max(0.0, 1.0 - is / needed) : 0.0;
}
double excess(double is, double most) {
  return std::isfinite(most) ? std::max(0.0, is / most - 1.0) : 0.0;
}

// A problem file; base and catalogue are paths, and the joints of the base names.
struct ProblemDraft {
  /// Its base comes last
  DesignProblem problem = {
      .base = {.device = {.model = {.chain = model::ChainModel::free_body({})}}}};
  std::filesystem::path base, catalogue;
  std::array<std::string, kDesignJoints> sizes;
  std::array<double, kDesignJoints> ratios{};
};

void read_base(config::Loader& loader, ProblemDraft& draft) {
  loader.words("name", draft.problem.name, "name of the device", Need::kRequired);
  const std::string& name = draft.problem.name;
  const bool is_plain = name.find_first_of("\"\\\n\r<>&") == std::string::npos &&
                        name.find("--") == std::string::npos;
  loader.rule(is_plain, "name", "must be one line without \" \\ < > & and --");
  loader.path("base", draft.base, "device whose structure is kept", Need::kRequired);
  loader.path("catalogue", draft.catalogue, "joint sizes", Need::kRequired);
  const std::vector<std::string> joints = joint_names();
  std::size_t count = 0;
  loader.groups_by_name(
      "base_joints", joints, "a joint of the arm",
      [&](config::Loader& child, int joint) {
        ++count;
        const auto k = static_cast<std::size_t>(joint);
        child.words("size", draft.sizes[k], "name in the catalogue", Need::kRequired);
        child.number("ratio", draft.ratios[k], {.lb = 1.0, .ub = 1e4}, "transmission ratio",
                     Need::kRequired);
      },
      "what the base is made of");
  loader.rule(count == joints.size(), "base_joints", "must have m1 to m6");
}

void read_person(config::Loader& loader, DesignProblem& problem) {
  loader.choice("sex", problem.sex, config::Choices<Sex>(kSexes), "of the person");
  loader.number("stature_percentile", problem.stature_percentile, {.lb = 1.0, .ub = 99.0},
                "of that population");
}

void read_bounds(config::Loader& loader, DesignProblem& problem) {
  const std::vector<std::string> variables = names_of(kContinuous);
  std::size_t count = 0;
  loader.groups_by_name(
      "variables", variables, "a variable",
      [&](config::Loader& child, int index) {
        ++count;
        Interval& range = problem.bounds[static_cast<std::size_t>(index)];
        child.number("from_m", range.lb, config::kPositive, "smallest", Need::kRequired);
        child.number("to_m", range.ub, config::kPositive, "largest", Need::kRequired);
        child.rule(range.lb <= range.ub, "to_m", "must not be below from_m");
      },
      "bounds of the continuous variables");
  loader.rule(count == variables.size(), "variables",
              "must have L1, L2, D3, L4, D6, gantry_x, gantry_y and mount_height");
}

void read_weights(config::Loader& loader, DesignProblem& problem) {
  const std::vector<std::string> terms = names_of(kTerms);
  loader.numbers_by_name(
      "weights", terms, "a term of the capability", {.lb = 0.0, .ub = 1e6},
      [&](int index, double weight) { problem.weights[static_cast<std::size_t>(index)] = weight; },
      "of the terms of the capability");
  double sum = 0.0;
  for (double weight : problem.weights) sum += weight;
  loader.rule(sum > 0.0, "weights", "one must be above zero");
}

}  // namespace

DesignProblem load_problem(const std::filesystem::path& path) {
  config::SourceReader reader;
  config::LoaderFile file = {path, reader, config::Faults(path.generic_string())};
  ProblemDraft draft;
  DesignProblem& problem = draft.problem;
  problem.weights.fill(0.0);
  load_file(file, [&](config::Loader& loader) {
    read_base(loader, draft);
    loader.group(
        "person", [&](config::Loader& child) { read_person(child, problem); },
        "whose arm is to be served");
    read_bounds(loader, problem);
    loader.group(
        "requirements",
        [&](config::Loader& child) { read_requirements(child, problem.requirements); },
        "that a design must meet", Need::kRequired);
    read_weights(loader, problem);
    loader.choice("front_against", problem.burden, config::Choices<Burden>(kBurdens),
                  "what the front sets against the capability");
    loader.group(
        "search", [&](config::Loader& child) { read_search(child, problem.search); },
        "size and seed of the search");
  });
  problem.catalogue = load_catalogue(draft.catalogue, reader);
  problem.base = load_base(draft.base, problem.catalogue, draft.sizes, draft.ratios);
  return std::move(problem);
}

Judge::Judge(const DesignProblem& problem, bool keeps_poses)
    : problem_(problem),
      keeps_poses_(keeps_poses),
      human_(human_capability(human_arm(problem.sex, problem.stature_percentile),
                              {.samples = 200'000, .poses = problem.search.poses})) {}

DesignScore Judge::operator()(const DesignVariables& variables) const {
  DesignScore score;
  try {
    const DeviceDesign design = make_device(problem_.base, problem_.catalogue, variables,
                                            problem_.name, problem_.prices, false);
    MetricOptions options = metric_options(design.device);
    options.force = problem_.requirements.force;
    options.torque = problem_.requirements.torque;
    options.keeps_poses = true;
    options.T_B_F = place_person(design.device.model, human_, options);
    score.metrics = measure(design.device.model, human_, options);
    score.moving_mass = design.moving_mass;
    score.price = design.price;
    score.clear_share = clear_share(design, score.metrics, *options.T_B_F);
    if (!keeps_poses_) score.metrics.each.clear();

    const DeviceMetrics& metrics = score.metrics;
    const Requirements& needed = problem_.requirements;
    const double walk = walk_area(design.device.model);
    const double force = missing(metrics.force.low, needed.force);
    const double torque = missing(metrics.torque.low, needed.torque);
    score.terms = {metrics.pose,
                   metrics.velocity,
                   metrics.turn_velocity,
                   metrics.acceleration,
                   metrics.turn_acceleration,
                   1.0 - force,
                   1.0 - torque,
                   1.0 - missing(walk, needed.walk_area)};
    double sum = 0.0;
    for (std::size_t i = 0; i < score.terms.size(); ++i) {
      score.capability += problem_.weights[i] * score.terms[i];
      sum += problem_.weights[i];
    }
    score.capability /= sum;
    score.violation = 0.0;
    for (const double broken :
         {force, torque, excess(score.moving_mass, needed.moving_mass),
          excess(score.price, needed.price), missing(score.clear_share, needed.clear_share),
          missing(walk, needed.walk_area)}) {
      score.violation += std::min(1.0, broken);
    }
  } catch (const SetupError& error) {
    score.fault = error.what();
    score.violation = kFaultViolation;
  }
  return score;
}

// The arm in each reached pose against head, trunk and legs; the gantry's frame is not near.
double Judge::clear_share(const DeviceDesign& design, const DeviceMetrics& metrics,
                          const Pose& T_B_F) const {
  constexpr int kFirstMoving = 3;  // joints that move the first link of the arm: gantry, m1
  const DeviceModel& device = design.device.model;
  struct Near {
    int frame;
    collision::Distance distance;
  };
  std::vector<Near> pairs;
  const collision::Geometry geometry = collision::read_geometry(
      model::read_urdf_text(design.files.urdf, "device.urdf"), device.chain);
  for (const collision::Shape& shape : geometry.shapes) {
    if (shape.body < kFirstMoving || shape.is_surrounding) continue;
    for (const Capsule& part : human_.arm.body) {
      pairs.push_back({shape.frame, collision::Distance(shape, shape_of(part))});
    }
  }
  model::ChainData chain(device.chain);
  double reached = 0.0, clear = 0.0;
  for (std::size_t i = 0; i < metrics.each.size(); ++i) {
    const PoseMetrics& pose = metrics.each[i];
    if (!pose.is_reached) continue;
    reached += human_.poses[i].weight;
    chain.update_poses(pose.q);
    // the person as seen from a gantry that stands still
    Pose T_B_person = T_B_F;
    T_B_person.p += chain.pose(device.handle).p - (T_B_F * human_.poses[i].T_F_hand).p;
    const bool is_clear = std::ranges::all_of(pairs, [&](const Near& near) {
      return near.distance(chain.pose(near.frame), T_B_person) >= problem_.requirements.clearance;
    });
    if (is_clear) clear += human_.poses[i].weight;
  }
  return reached > 0.0 ? clear / reached : 0.0;
}

std::vector<double> to_point(const DesignVariables& variables) {
  const model::haptic_giant::Lengths& lengths = variables.lengths;
  std::vector<double> point = {
      lengths.L1, lengths.L2,         lengths.D3,         lengths.L4,
      lengths.D6, variables.gantry_x, variables.gantry_y, variables.mount_height};
  point.insert(point.end(), variables.size.begin(), variables.size.end());
  point.insert(point.end(), variables.ratio.begin(), variables.ratio.end());
  return point;
}

DesignVariables to_variables(const DesignProblem& problem, const std::vector<double>& point) {
  DesignVariables variables;
  variables.lengths = {
      .L1 = point[0], .L2 = point[1], .D3 = point[2], .L4 = point[3], .D6 = point[4]};
  variables.gantry_x = point[5];
  variables.gantry_y = point[6];
  variables.mount_height = point[7];
  for (std::size_t i = 0; i < kDesignJoints; ++i) {
    variables.size[i] = static_cast<int>(std::lround(point[kContinuous.size() + i]));
  }
  std::ranges::sort(variables.size, std::greater<>());
  for (std::size_t i = 0; i < kDesignJoints; ++i) {
    const auto& ratios =
        problem.catalogue.sizes[static_cast<std::size_t>(variables.size[i])].ratios;
    const auto wanted =
        static_cast<int>(std::lround(point[kContinuous.size() + kDesignJoints + i]));
    variables.ratio[i] = std::min(wanted, static_cast<int>(ratios.size()) - 1);
  }
  return variables;
}

std::vector<double> lower_point(const DesignProblem& problem) {
  std::vector<double> point;
  for (const Interval& range : problem.bounds) point.push_back(range.lb);
  point.resize(kContinuous.size() + 2 * kDesignJoints, 0.0);
  return point;
}

std::vector<double> upper_point(const DesignProblem& problem) {
  std::vector<double> point;
  for (const Interval& range : problem.bounds) point.push_back(range.ub);
  std::size_t ratios = 0;
  for (const JointSize& size : problem.catalogue.sizes) {
    ratios = std::max(ratios, size.ratios.size());
  }
  point.insert(point.end(), kDesignJoints, static_cast<double>(problem.catalogue.sizes.size() - 1));
  point.insert(point.end(), kDesignJoints, static_cast<double>(ratios - 1));
  return point;
}

}  // namespace hg::design
