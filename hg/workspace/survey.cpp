#include "hg/workspace/survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "hg/model/chain_data.h"
#include "hg/model/joint_range.h"

namespace hg::workspace {
namespace {

constexpr double kAtLimit = 0.2;  // chance of a joint to stand at a limit
constexpr int kTries = 1000;

double draw_coordinate(const JointRanges& ranges, Eigen::Index k, bool at_limits, Random& random) {
  double share = random.next();
  if (at_limits && random.next() < kAtLimit) share = share < 0.5 ? 0.0 : 1.0;
  return ranges.lower[k] + share * (ranges.upper[k] - ranges.lower[k]);
}

struct Scene {
  const config::DeviceConfig& device;
  JointRanges ranges;
  model::ChainData chain;
  Eigen::VectorXd zero;
  Eigen::VectorXd effort, ddq_max;
};

Scene make_scene(const config::DeviceConfig& device) {
  const DeviceModel& model = device.model;
  Scene scene = {device,
                 joint_ranges(device),
                 model::ChainData(model.chain),
                 Eigen::VectorXd::Zero(model.chain.nv()),
                 {},
                 {}};
  scene.effort.resize(model.chain.nv());
  for (int i = 0; i < model.chain.nv(); ++i) {
    scene.effort[i] = model.chain.joints()[i].effort_max;
  }
  scene.ddq_max.resize(model.n_m);
  for (int i = 0; i < model.n_m; ++i) {
    scene.ddq_max[i] = model.joint_limits[i].ddq_max;
  }
  return scene;
}

// scene.chain: after update() at q
Posture examine(const Scene& scene, const Eigen::VectorXd& q, double length) {
  const DeviceModel& model = scene.device.model;
  const model::Jacobian J = scene.chain.jacobian(model.handle);
  const model::Jacobian J_m = J.rightCols(model.n_m);
  const Eigen::VectorXd available = scene.effort - scene.chain.gravity().cwiseAbs();
  Posture posture;
  posture.q = q;
  posture.handle = scene.chain.pose(model.handle).p;
  posture.force = model::worst_direction(J.topRows<3>(), available);
  posture.torque = model::worst_direction(J.bottomRows<3>(), available);
  posture.acceleration = model::worst_acceleration(J_m, scene.ddq_max);
  posture.conditioning = model::conditioning(J_m, length);
  posture.has_paper_wrench =
      model::holds_wrench(J, available, model::kPaperForce, model::kPaperTorque);
  return posture;
}

double characteristic_length(Scene& scene, Random& random) {
  constexpr int kPostures = 200;
  const DeviceModel& model = scene.device.model;
  double sum = 0.0;
  for (int i = 0; i < kPostures; ++i) {
    const auto q = draw(scene.device, scene.ranges, false, random);
    if (!q) return 1.0;
    scene.chain.update_kinematics(*q, scene.zero);
    const model::Jacobian J = manipulator_jacobian(model, scene.chain, model.handle);
    sum += J.topRows<3>().norm() / std::max(1e-9, J.bottomRows<3>().norm());
  }
  return std::max(1e-3, sum / kPostures);
}

void survey_postures(Scene& scene, Random& random, Survey& result) {
  result.gravity_max.setZero(scene.zero.size());
  const int drawn_max = 20 * result.options.postures;
  while (static_cast<int>(result.postures.size()) < result.options.postures &&
         result.drawn < drawn_max) {
    const auto q = draw(scene.device, scene.ranges, false, random);
    if (!q) return;
    ++result.drawn;
    scene.chain.update_kinematics(*q, scene.zero);
    if (!permits_boxes(scene.device.model, scene.chain)) continue;
    scene.chain.update(*q, scene.zero);
    result.gravity_max = result.gravity_max.cwiseMax(scene.chain.gravity().cwiseAbs());
    result.postures.push_back(examine(scene, *q, result.length));
  }
}

// A gantry of prismatic joints shifts everything by J_p q_p: positions without further kinematics.
bool gantry_only_shifts(const DeviceModel& model) {
  const std::span joints(model.chain.joints().data(), model.n_p);
  return model.n_p > 0 &&
         std::ranges::all_of(joints, [](const model::Joint& joint) { return joint.is_slide(); });
}

bool is_inside(const CartesianLimit& limit, const Eigen::Vector3d& p) {
  for (int axis = 0; axis < 3; ++axis) {
    const limits::JointLimits& range = limit.axes[axis];
    if (p[axis] < range.q_min || p[axis] > range.q_max) return false;
  }
  return true;
}

// Adds what one posture of the arm reaches alone and with other positions of the gantry;
// scene.chain: after update() at q.
void add_positions(const Scene& scene, const Eigen::VectorXd& q, int copies, bool at_limits,
                   Random& random, Cloud& cloud) {
  const DeviceModel& model = scene.device.model;
  const auto n_p = static_cast<Eigen::Index>(model.n_p);
  const Eigen::Matrix3Xd J = scene.chain.jacobian(model.handle).topRows<3>();
  const Eigen::VectorXd available = scene.effort - scene.chain.gravity().cwiseAbs();
  const double force = model::worst_direction(J, available).value;
  const Eigen::Vector3d handle = scene.chain.pose(model.handle).p;
  for (int copy = 0; copy < copies; ++copy) {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; copy > 0 && k < n_p; ++k) {
      shift += J.col(k) * (draw_coordinate(scene.ranges, k, at_limits, random) - q[k]);
    }
    bool is_permitted = true;
    for (std::size_t k = 0; k < model.cartesian_limits.size(); ++k) {
      const CartesianLimit& limit = model.cartesian_limits[k];
      const Eigen::Vector3d p = scene.chain.pose(limit.frame).p + shift;
      cloud.frames[k].extend(p);
      is_permitted = is_permitted && is_inside(limit, p);
    }
    if (is_permitted) cloud.positions.push_back({handle + shift, force});
  }
}

// Pattern search: steps of single joints that lower the smallest singular value, halved when none
// does.
Posture descend(Scene& scene, const Posture& from, double length) {
  constexpr int kRounds = 100;
  const DeviceModel& model = scene.device.model;
  const auto smallest = [&](const Eigen::VectorXd& q) {
    scene.chain.update_kinematics(q, scene.zero);
    return model::conditioning(manipulator_jacobian(model, scene.chain, model.handle), length)
        .smallest;
  };
  Eigen::VectorXd q = from.q;
  double best = from.conditioning.smallest;
  double step = 0.2;
  for (int round = 0; round < kRounds && step > 1e-4; ++round) {
    bool is_better = false;
    for (Eigen::Index i = model.n_p; i < q.size(); ++i) {
      for (const double signed_step : {-step, step}) {
        Eigen::VectorXd next = q;
        next[i] = std::clamp(q[i] + signed_step, scene.ranges.lower[i], scene.ranges.upper[i]);
        if (!permits_virtual_joints(model, next)) continue;
        const double value = smallest(next);
        if (value >= best || !permits_boxes(model, scene.chain)) continue;
        best = value;
        q = next;
        is_better = true;
        break;
      }
    }
    if (!is_better) step *= 0.5;
  }
  scene.chain.update(q, scene.zero);
  return examine(scene, q, length);
}

void find_most_singular(Scene& scene, Survey& result) {
  constexpr std::size_t kStarts = 6;
  std::vector<const Posture*> worst;
  for (const Posture& posture : result.postures) worst.push_back(&posture);
  const std::size_t count = std::min(kStarts, worst.size());
  std::ranges::partial_sort(worst, worst.begin() + static_cast<std::ptrdiff_t>(count), {},
                            [](const Posture* p) { return p->conditioning.smallest; });
  for (std::size_t i = 0; i < count; ++i) {
    const Posture found = descend(scene, *worst[i], result.length);
    if (i == 0 || found.conditioning.smallest < result.most_singular.conditioning.smallest) {
      result.most_singular = found;
    }
  }
}

}  // namespace

JointRanges joint_ranges(const config::DeviceConfig& device) {
  const DeviceModel& model = device.model;
  const int n = model.chain.nv();
  JointRanges ranges = {Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) {
    const model::Joint& joint = model.chain.joints()[i];
    Interval range = joint.position;
    if (i < model.n_p) {
      range = device.model.gantry_range[i];
    } else {
      const auto& limits = model.joint_limits[i - model.n_p];
      range = {limits.q_min, limits.q_max};
    }
    range = model::finite_range(range, !joint.is_slide());
    ranges.lower[i] = range.lb;
    ranges.upper[i] = range.ub;
  }
  return ranges;
}

bool permits_virtual_joints(const DeviceModel& model, const Eigen::VectorXd& q) {
  return std::ranges::all_of(model.virtual_joints, [&](const VirtualJoint& joint) {
    const double sum = joint.weights.dot(q.tail(model.n_m));
    return sum >= joint.limits.q_min && sum <= joint.limits.q_max;
  });
}

bool permits_boxes(const DeviceModel& model, const model::ChainData& chain) {
  return std::ranges::all_of(model.cartesian_limits, [&](const CartesianLimit& limit) {
    return is_inside(limit, chain.pose(limit.frame).p);
  });
}

std::optional<Eigen::VectorXd> draw(const config::DeviceConfig& device, const JointRanges& ranges,
                                    bool at_limits, Random& random) {
  Eigen::VectorXd q(ranges.lower.size());
  for (int i = 0; i < kTries; ++i) {
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      q[k] = draw_coordinate(ranges, k, at_limits, random);
    }
    if (permits_virtual_joints(device.model, q)) return q;
  }
  return {};
}

Cloud cloud(const config::DeviceConfig& device, int postures, bool at_limits, Random& random,
            const Adjust& adjust) {
  constexpr int kCopies = 8;  // gantry positions per posture of the arm
  const DeviceModel& model = device.model;
  Scene scene = make_scene(device);
  const int copies = gantry_only_shifts(model) ? kCopies : 1;
  const model::Joint& first = model.chain.joints()[model.n_p];
  Cloud result;
  result.frames.assign(model.cartesian_limits.size(), Eigen::AlignedBox3d());
  for (int i = 0; i < postures; ++i) {
    std::optional<Eigen::VectorXd> q = draw(device, scene.ranges, at_limits, random);
    if (!q) break;
    if (adjust && !adjust(scene.chain, *q)) continue;
    scene.chain.update(*q, scene.zero);
    if (!first.is_slide()) {
      const Eigen::Vector3d lever = scene.chain.jacobian(model.handle).col(model.n_p).head<3>();
      result.reach = std::max(result.reach, lever.norm());
    }
    add_positions(scene, *q, copies, at_limits, random, result);
  }
  return result;
}

Survey survey(const config::DeviceConfig& device, const SurveyOptions& options) {
  Survey result;
  result.options = options;
  Random random(options.seed);
  Scene scene = make_scene(device);
  result.length = characteristic_length(scene, random);
  survey_postures(scene, random, result);
  result.cloud = cloud(device, options.positions, true, random);
  find_most_singular(scene, result);
  return result;
}

model::Jacobian manipulator_jacobian(const DeviceModel& model, const model::ChainData& chain,
                                     int frame) {
  return chain.jacobian(frame).rightCols(model.n_m);
}

}  // namespace hg::workspace
