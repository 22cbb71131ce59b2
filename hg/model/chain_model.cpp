#include "hg/model/chain_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "hg/core/input_fault.h"
#include "hg/core/nearest_name.h"
#include "hg/model/chain_parts.h"
#include "hg/model/closed_loop.h"
#include "hg/model/tool.h"
#include "hg/model/urdf.h"
#include "hg/model/urdf_parts.h"

namespace hg::model {
namespace {

pinocchio::SE3 to_placement(const Pose& pose) { return {pose.R, pose.p}; }

pinocchio::Inertia to_inertia(const Inertial& i) { return {i.mass, i.p_com, i.inertia}; }

// axes along x, y, z: cheaper specialised joints
pinocchio::JointModel scalar_joint(bool turns, const Eigen::Vector3d& axis) {
  if (axis == Eigen::Vector3d::UnitX()) {
    return turns ? pinocchio::JointModel(pinocchio::JointModelRX())
                 : pinocchio::JointModel(pinocchio::JointModelPX());
  }
  if (axis == Eigen::Vector3d::UnitY()) {
    return turns ? pinocchio::JointModel(pinocchio::JointModelRY())
                 : pinocchio::JointModel(pinocchio::JointModelPY());
  }
  if (axis == Eigen::Vector3d::UnitZ()) {
    return turns ? pinocchio::JointModel(pinocchio::JointModelRZ())
                 : pinocchio::JointModel(pinocchio::JointModelPZ());
  }
  return turns ? pinocchio::JointModel(pinocchio::JointModelRevoluteUnaligned(axis))
               : pinocchio::JointModel(pinocchio::JointModelPrismaticUnaligned(axis));
}
ChainParts::Axis axis_of(const Joint& joint) {
  ChainParts::Axis axis = {!joint.is_slide(), joint.axis};
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (joint.axis != Eigen::Vector3d::Unit(k)) continue;
    axis.k = k;
    axis.i = (k + 1) % 3;
    axis.j = (k + 2) % 3;
  }
  return axis;
}

// Index of a name; `place` is the file or chain that has the names.
int find(std::string_view name, const std::vector<std::string>& names, const std::string& kind,
         InputFault place) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  place.what = kind + " must be one of the chain, got '" + std::string(name) + "', nearest is '" +
               nearest_name(name, names) + "'";
  throw InputError(std::move(place));
}

// The pose q after moving along the twist `step` of the body for one unit of time.
Eigen::Matrix<double, 7, 1> integrate_floating(const Eigen::Matrix<double, 7, 1>& q,
                                               const Vector6& step) noexcept {
  const Eigen::Quaterniond R(q[6], q[3], q[4], q[5]);
  const Eigen::Vector3d omega = step.tail<3>();
  const double half = 0.5 * omega.norm();

  // sin(x) / x to the last digit also where x is small
  const double sinc = half > 1e-4 ? std::sin(half) / half : 1.0 - half * half / 6.0;
  Eigen::Quaterniond turn;
  turn.w() = std::cos(half);
  turn.vec() = 0.5 * sinc * omega;

  const pinocchio::SE3 moved = pinocchio::exp6(pinocchio::Motion(step));
  Eigen::Matrix<double, 7, 1> q_next;
  q_next << q.head<3>() + R * moved.translation(), (R * turn).normalized().coeffs();
  return q_next;
}

}  // namespace

pinocchio::JointIndex ChainParts::add_joint(pinocchio::JointIndex parent, Joint joint,
                                            const pinocchio::JointModel& kind,
                                            const pinocchio::SE3& placement) {
  const pinocchio::JointIndex index = model.addJoint(parent, kind, placement, joint.name);
  joint.q_index = model.idx_qs[index];
  joint.v_index = model.idx_vs[index];
  joint.nq = model.nqs[index];
  joint.nv = model.nvs[index];
  joint_names.push_back(joint.name);
  axes.push_back(axis_of(joint));
  has_floating = has_floating || joint.type == JointType::kFloating;
  joints.push_back(std::move(joint));
  return index;
}

pinocchio::JointIndex ChainParts::add_floating_root(const Pose& T_B_root) {
  const bool is_on_base = has_moving_base;
  return add_joint(is_on_base ? 1 : 0,
                   {.name = "root", .type = JointType::kFloating, .position = {}},
                   pinocchio::JointModelFreeFlyer(), to_placement(is_on_base ? Pose{} : T_B_root));
}

pinocchio::JointIndex ChainParts::add_moving_base(const Pose& T_B_rest) {
  has_moving_base = true;
  T_B_base = T_B_rest;
  axes.push_back({});
  return model.addJoint(0, pinocchio::JointModelFreeFlyer(), pinocchio::SE3::Identity(),
                        "moving base");
}

void ChainParts::add_frame(const std::string& frame_name, pinocchio::JointIndex joint,
                           const pinocchio::SE3& T_joint_frame) {
  frame_names.push_back(frame_name);
  frames.push_back({joint, T_joint_frame});
}

namespace {

// Walks a URDF from root to tip and adds its joints and links to a chain.
class Builder {
 public:
  Builder(const Urdf& urdf, const ChainOptions& options) : urdf_(urdf), options_(options) {}

  ChainParts build() {
    ChainParts chain;
    chain.name = urdf_.name;
    const int root = root_link();
    pinocchio::JointIndex joint = 0;
    pinocchio::SE3 placement = to_placement(options_.T_B_root);
    if (options_.moving_base) {
      base_ = joint = chain.add_moving_base(options_.T_B_root);
      placement.setIdentity();
    }
    if (options_.floating_root) {
      joint = chain.add_floating_root(options_.T_B_root);
      placement.setIdentity();
    }

    merge_fixed(chain, joint, root, placement);
    refuse_massless(joint, link(root), options_.floating_root ? "root" : "");
    add_branches(chain, joint);
    while (const UrdfJoint* next = moving_joint()) {
      joint = add_body(chain, joint, *next);
      add_branches(chain, joint);
    }
    if (chain.frames.size() != urdf_.links.size()) fail_for_loop();
    if (chain.joints.empty()) {
      throw InputError(InputFault{.file = urdf_.source, .what = "robot has no moving joint"});
    }
    return chain;
  }

 private:
  struct Merged {
    int link;
    pinocchio::SE3 T_joint_link;
  };

  const UrdfLink& link(int index) const { return urdf_.links[index]; }

  [[noreturn]] void fail(int line, const std::string& item, const std::string& what) const {
    throw InputError(InputFault{.file = urdf_.source, .line = line, .item = item, .what = what});
  }

  int root_link() const {
    std::vector<const UrdfJoint*> holder(urdf_.links.size(), nullptr);
    for (const UrdfJoint& j : urdf_.joints) {
      const UrdfJoint*& first = holder[j.child];
      if (first != nullptr) {
        fail(j.line, "joint " + j.name,
             "link " + link(j.child).name + " is the child of joint " + first->name + " already");
      }
      first = &j;
    }
    int root = -1;
    for (int i = 0; i < static_cast<int>(holder.size()); ++i) {
      if (holder[i] != nullptr) continue;
      if (root >= 0) {
        fail(link(i).line, "link " + link(i).name,
             "is not connected to link " + link(root).name + ", a chain has one root");
      }
      root = i;
    }
    if (root < 0) fail_for_loop();
    return root;
  }

  [[noreturn]] void fail_for_loop() const {
    fail(urdf_.joints.front().line, "robot", "joints form a loop, a chain has a root and a tip");
  }

  // Exporters give a frame a mass of nearly nothing and an inertia that is none, or no mass and any
  // inertia: it is left out.
  bool is_frame(const UrdfLink& link) const {
    constexpr double kMassShare = 1e-6;  // of the body that it is fixed to
    constexpr double kInertia = 1e-6;    // kg m^2
    if (!link.inertial_fault) return false;
    if (link.inertial->mass == 0.0) return true;
    return std::abs(link.inertial->mass) <= kMassShare * mass_ &&
           link.inertial->inertia.norm() <= kInertia;
  }

  // Collects the links that are fixed to `first`, gives them to the body of `joint` and lists
  // frames.
  void merge_fixed(ChainParts& chain, pinocchio::JointIndex joint, int first,
                   const pinocchio::SE3& placement) {
    merged_ = {{first, placement}};
    mass_ = 0.0;
    for (std::size_t i = 0; i < merged_.size(); ++i) {
      const Merged at = merged_[i];
      chain.add_frame(link(at.link).name, joint, at.T_joint_link);
      const auto& inertial = link(at.link).inertial;
      if (inertial && joint > base_ && !(i > 0 && is_frame(link(at.link)))) {
        // a point mass must be fixed to a body with inertia
        const bool is_point = i > 0 && is_point_mass(link(at.link));
        const std::optional<InputFault>& fault = link(at.link).inertial_fault;
        if (fault && !is_point) throw InputError(*fault);
        chain.model.appendBodyToJoint(joint, to_inertia(*inertial), at.T_joint_link);
        mass_ += inertial->mass;
      }
      for (const UrdfJoint& j : urdf_.joints) {
        if (j.parent != at.link || j.type != UrdfJointType::kFixed) continue;
        merged_.push_back({j.child, at.T_joint_link * to_placement(j.T_parent_joint)});
      }
    }
  }

  pinocchio::JointIndex add_body(ChainParts& chain, pinocchio::JointIndex parent,
                                 const UrdfJoint& j) {
    const pinocchio::JointIndex joint = add(chain, parent, j);
    merge_fixed(chain, joint, j.child, pinocchio::SE3::Identity());
    refuse_massless(joint, link(j.child), j.name);
    return joint;
  }

  // The bodies beside the chain that move with it, before those with which the chain continues: the
  // library numbers joints depth first. Keeps the links of the current body.
  void add_branches(ChainParts& chain, pinocchio::JointIndex joint) {
    const std::vector<Merged> body = merged_;
    for (const Merged& at : body) {
      for (const UrdfJoint& j : urdf_.joints) {
        if (j.parent != at.link || !j.is_branch) continue;
        T_joint_next_ = at.T_joint_link * to_placement(j.T_parent_joint);
        add_branches(chain, add_body(chain, joint, j));
        chain.has_branch = true;
      }
    }
    merged_ = body;
  }

  // The joint that carries the rest of the chain; nullptr at the tip.
  const UrdfJoint* moving_joint() {
    const UrdfJoint* found = nullptr;
    for (const Merged& at : merged_) {
      for (const UrdfJoint& j : urdf_.joints) {
        if (j.parent != at.link || j.type == UrdfJointType::kFixed || j.is_branch) continue;
        if (found != nullptr) {
          fail(j.line, "link " + link(at.link).name,
               "branches into the joints " + found->name + " and " + j.name +
                   "; name the last link of the chain with tip_link (and its first "
                   "with root_link): the other joints then stand still");
        }
        found = &j;
        T_joint_next_ = at.T_joint_link * to_placement(j.T_parent_joint);
      }
    }
    return found;
  }

  pinocchio::JointIndex add(ChainParts& chain, pinocchio::JointIndex parent,
                            const UrdfJoint& j) const {
    const bool is_scalar = j.type != UrdfJointType::kPlanar && j.type != UrdfJointType::kFloating;
    if (j.mimic && !is_scalar) {
      fail(j.line, "joint " + j.name, "only joints with one coordinate can follow another one");
    }
    if (j.type != UrdfJointType::kPlanar) return add(chain, parent, j, T_joint_next_, "");
    pinocchio::SE3 placement = T_joint_next_;
    for (const UrdfJoint& part : planar_parts(j)) {
      parent = add(chain, parent, part, placement, j.name);
      placement.setIdentity();
    }
    return parent;
  }

  static pinocchio::JointIndex add(ChainParts& chain, pinocchio::JointIndex parent,
                                   const UrdfJoint& j, const pinocchio::SE3& placement,
                                   const std::string& planar) {
    Joint joint = {.name = j.name,
                   .position = j.position,
                   .velocity_max = j.velocity_max,
                   .effort_max = j.effort_max,
                   .damping = j.damping,
                   .friction = j.friction,
                   .axis = j.axis,
                   .planar = planar};
    if (j.type == UrdfJointType::kFloating) {
      joint.type = JointType::kFloating;
      return chain.add_joint(parent, joint, pinocchio::JointModelFreeFlyer(), placement);
    }
    joint.type = j.type == UrdfJointType::kPrismatic    ? JointType::kPrismatic
                 : j.type == UrdfJointType::kContinuous ? JointType::kContinuous
                                                        : JointType::kRevolute;
    const bool turns = j.type != UrdfJointType::kPrismatic;
    return chain.add_joint(parent, joint, scalar_joint(turns, j.axis), placement);
  }

  void refuse_massless(pinocchio::JointIndex joint, const UrdfLink& body,
                       const std::string& joint_name) const {
    if (joint == base_ || mass_ > 0.0) return;
    fail(body.line, "link " + body.name,
         "moves with joint " + joint_name +
             " but has no mass; give it an <inertial> or make the joint fixed");
  }

  const Urdf& urdf_;
  const ChainOptions& options_;
  pinocchio::JointIndex base_ = 0;  // joint of the fixed or moved base
  std::vector<Merged> merged_;      // links of the current body
  double mass_ = 0.0;               // of the current body
  pinocchio::SE3 T_joint_next_ = pinocchio::SE3::Identity();
};

// Takes the coordinates of joints that follow others out of a chain.
class Coupler {
 public:
  Coupler(const Urdf& urdf, ChainParts& chain) : urdf_(urdf), chain_(chain) {}

  void couple() {
    std::vector<const UrdfMimic*> mimics;
    for (const Joint& joint : chain_.joints) mimics.push_back(mimic_of(joint));
    const auto is_own = [](const UrdfMimic* mimic) { return mimic == nullptr; };
    if (std::ranges::all_of(mimics, is_own) && !chain_.has_moving_base) return;
    const std::vector<Joint> all = std::exchange(chain_.joints, {});
    chain_.joint_names.clear();
    chain_.nq = chain_.nv = 0;
    chain_.q_from.assign(chain_.model.nq, {-1});
    chain_.v_from.assign(chain_.model.nv, {-1});
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (mimics[i] == nullptr) keep(all[i]);
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (mimics[i] != nullptr) follow(all[i], *mimics[i]);
    }
  }

 private:
  const UrdfMimic* mimic_of(const Joint& joint) const {
    const auto found = std::ranges::find(urdf_.joints, joint.name, &UrdfJoint::name);
    return found != urdf_.joints.end() && found->mimic ? &*found->mimic : nullptr;
  }

  void keep(Joint joint) {
    for (int k = 0; k < joint.nq; ++k) chain_.q_from[joint.q_index + k] = {chain_.nq + k};
    for (int k = 0; k < joint.nv; ++k) chain_.v_from[joint.v_index + k] = {chain_.nv + k};
    joint.q_index = std::exchange(chain_.nq, chain_.nq + joint.nq);
    joint.v_index = std::exchange(chain_.nv, chain_.nv + joint.nv);
    chain_.joint_names.push_back(joint.name);
    chain_.joints.push_back(std::move(joint));
  }

  [[noreturn]] void fail(const UrdfMimic& mimic, const std::string& joint,
                         const std::string& what) const {
    throw InputError(InputFault{
        .file = urdf_.source, .line = mimic.line, .item = "joint " + joint, .what = what});
  }

  std::string nearest_text(const std::string& name) const {
    const std::string nearest = nearest_name(name, chain_.joint_names);
    return nearest.empty() ? "" : ", nearest is '" + nearest + "'";
  }

  // The leader's share of what the joint has: limits, damping, friction.
  void follow(const Joint& joint, const UrdfMimic& mimic) {
    const auto leader = std::ranges::find(chain_.joints, mimic.joint, &Joint::name);
    if (leader == chain_.joints.end()) {
      fail(mimic, joint.name,
           "must follow a joint that moves on its own between root and tip, got '" + mimic.joint +
               "'" + nearest_text(mimic.joint));
    }
    if (leader->nv != 1) {
      fail(mimic, joint.name, "cannot follow the floating joint " + leader->name);
    }
    if (mimic.curve) return follow_curve(joint, mimic, *leader);
    const double ratio = mimic.multiplier;
    if (ratio == 0.0) fail(mimic, joint.name, "multiplier must not be 0");
    const double a = (joint.position.lb - mimic.offset) / ratio;
    const double b = (joint.position.ub - mimic.offset) / ratio;
    leader->position = intersect(leader->position, {std::min(a, b), std::max(a, b)});
    if (!(leader->position.lb < leader->position.ub)) {
      fail(mimic, joint.name, "its limits leave no range to joint " + leader->name);
    }
    leader->velocity_max = std::min(leader->velocity_max, joint.velocity_max / std::abs(ratio));
    leader->damping += ratio * ratio * joint.damping;
    leader->friction += std::abs(ratio) * joint.friction;
    chain_.q_from[joint.q_index] = {leader->q_index, ratio, mimic.offset};
    chain_.v_from[joint.v_index] = {leader->v_index, ratio, 0.0};
    chain_.couplings.push_back({joint.name, leader->name, ratio, mimic.offset});
  }

  // What the joint has does not depend on the posture; what it is for the leader does.
  void follow_curve(const Joint& joint, const UrdfMimic& mimic, Joint& leader) {
    if (joint.damping != 0.0 || joint.friction != 0.0) {
      fail(mimic, joint.name,
           "damping and friction of a joint on a curve belong to the joint that leads it, " +
               leader.name);
    }
    leader.position = intersect(leader.position, mimic.curve->range());
    leader.velocity_max =
        std::min(leader.velocity_max, joint.velocity_max / mimic.curve->steepest());
    chain_.q_from[joint.q_index] = {leader.q_index, 1.0, 0.0, mimic.curve.get(), leader.q_index};
    chain_.v_from[joint.v_index] = {leader.v_index, 1.0, 0.0, mimic.curve.get(), leader.q_index};
    chain_.couplings.push_back({joint.name, leader.name, 1.0, 0.0, mimic.curve});
    chain_.has_curve = true;
  }

  const Urdf& urdf_;
  ChainParts& chain_;
};

void add_couplings(const std::vector<Coupling>& couplings, Urdf& urdf) {
  for (const Coupling& coupling : couplings) {
    std::vector<std::string> names;
    for (const UrdfJoint& joint : urdf.joints) names.push_back(joint.name);
    const int index = find(coupling.joint, names, "coupled joint", {.file = urdf.source});
    urdf.joints[index].mimic = {coupling.leader, coupling.ratio, coupling.offset, 0,
                                coupling.curve};
  }
}

void finish(const ChainOptions& options, ChainParts& chain) {
  chain.nq = chain.model.nq;
  chain.nv = chain.model.nv;
  if (!options.gravity) chain.model.gravity.setZero();
}

ChainParts build(Urdf urdf, const ChainOptions& options) {
  add_couplings(options.couplings, urdf);
  for (const ClosedLoop& loop : options.loops) add_couplings(close_loop(urdf, loop), urdf);
  Urdf part = serial_part(urdf, options.root_link, options.tip_link);
  for (const UrdfJoint& joint : part.joints) {
    if (joint.fault) throw InputError(*joint.fault);
  }
  if (options.tool) attach(*options.tool, part);
  for (const PassiveJoint& joint : options.passive)
    insert_behind(joint.behind, joint.name, joint.axis, part);
  ChainParts chain = Builder(part, options).build();
  const int nv = chain.model.nv - (chain.has_moving_base ? 6 : 0);
  if (nv > kMaxTwin || chain.model.nq - (chain.has_moving_base ? 7 : 0) > kMaxTwinCoords) {
    throw InputError(InputFault{.file = urdf.source,
                                .what = "a chain has at most " + std::to_string(kMaxTwin) +
                                        " degrees of freedom, got " + std::to_string(nv)});
  }
  finish(options, chain);
  Coupler(part, chain).couple();
  return chain;
}

ChainParts build(const FreeBody& body, const ChainOptions& options) {
  const Inertial inertial = {body.mass, body.p_handle_com, body.inertia};
  check_inertial(inertial, "free body");
  ChainParts chain;
  chain.name = "free_body";
  if (options.moving_base) chain.add_moving_base(options.T_B_root);
  const pinocchio::JointIndex root = chain.add_floating_root(options.T_B_root);
  chain.model.appendBodyToJoint(root, to_inertia(inertial), pinocchio::SE3::Identity());
  chain.add_frame("handle", root, pinocchio::SE3::Identity());
  finish(options, chain);
  Coupler(Urdf{}, chain).couple();
  return chain;
}

}  // namespace

std::string_view to_string(JointType type) noexcept {
  switch (type) {
    case JointType::kRevolute:
      return "revolute";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kPrismatic:
      return "prismatic";
    case JointType::kFloating:
      return "floating";
  }
  return "unknown";
}

ChainModel::ChainModel(ChainParts parts)
    : parts_(std::make_shared<const ChainParts>(std::move(parts))) {}

ChainModel ChainModel::from_urdf_file(const std::filesystem::path& file,
                                      const ChainOptions& options) {
  return ChainModel(build(read_urdf_file(file), options));
}

ChainModel ChainModel::from_urdf_text(std::string_view text, std::string_view source,
                                      const ChainOptions& options) {
  return ChainModel(build(read_urdf_text(text, source), options));
}

ChainModel ChainModel::free_body(const FreeBody& body, const ChainOptions& options) {
  return ChainModel(build(body, options));
}

const std::string& ChainModel::name() const noexcept { return parts_->name; }
int ChainModel::nq() const noexcept { return parts_->nq; }
int ChainModel::nv() const noexcept { return parts_->nv; }
const std::vector<Joint>& ChainModel::joints() const noexcept { return parts_->joints; }
const std::vector<Coupling>& ChainModel::couplings() const noexcept { return parts_->couplings; }
const std::vector<std::string>& ChainModel::frame_names() const noexcept {
  return parts_->frame_names;
}

int ChainModel::frame(std::string_view name) const {
  return find(name, parts_->frame_names, "frame", {.item = parts_->name});
}

int ChainModel::joint(std::string_view name) const {
  return find(name, parts_->joint_names, "joint", {.item = parts_->name});
}

ConfigurationA ChainModel::neutral() const noexcept {
  ConfigurationA q = ConfigurationA::Zero(nq());
  for (const Joint& joint : parts_->joints) {
    if (joint.type == JointType::kFloating) q[joint.q_index + 6] = 1.0;
  }
  return q;
}

ConfigurationA ChainModel::integrate(const VectorIn& q, const VectorIn& step) const noexcept {
  assert(q.size() == nq() && step.size() == nv());
  ConfigurationA q_next(nq());
  for (const Joint& joint : parts_->joints) {
    if (joint.type == JointType::kFloating) {
      q_next.segment<7>(joint.q_index) =
          integrate_floating(q.segment<7>(joint.q_index), step.segment<6>(joint.v_index));
    } else {
      q_next[joint.q_index] = q[joint.q_index] + step[joint.v_index];
    }
  }
  return q_next;
}
Loads ChainModel::default_loads() const noexcept {
  return {.mass = 1.0, .gravity = parts_->model.gravity.linear().isZero(0.0) ? 0.0 : 1.0};
}

}  // namespace hg::model
