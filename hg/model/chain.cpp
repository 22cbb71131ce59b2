#include "hg/model/chain.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/spatial.hpp>
#include <utility>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/model/tool.h"
#include "hg/model/urdf.h"
#include "hg/model/urdf_parts.h"

namespace hg::model {
namespace {

// A frame moves with the child of a joint; joint 0 is the frame B itself.
struct Frame {
  pinocchio::JointIndex joint = 0;
  pinocchio::SE3 T_joint_frame = pinocchio::SE3::Identity();
};

pinocchio::SE3 to_SE3(const Pose& pose) { return {pose.R, pose.p}; }

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

// Axis of a joint with one coordinate.
struct Axis {
  bool turns = false;
  Eigen::Vector3d e;  // in the joint's own frame
  // index of the coordinate axis and of the next two in cyclic order x, y, z; -1 = not aligned
  Eigen::Index k = -1, i = -1, j = -1;
};

Axis axis_of(const Joint& joint) {
  Axis axis = {joint.type != JointType::kPrismatic, joint.axis};
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (joint.axis != Eigen::Vector3d::Unit(k)) continue;
    axis.k = k;
    axis.i = (k + 1) % 3;
    axis.j = (k + 2) % 3;
  }
  return axis;
}

int find(std::string_view name, const std::vector<std::string>& names, const std::string& chain,
         const std::string& kind) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  throw SetupError(chain + ": " + kind + " must be one of the chain, got '" + std::string(name) +
                   "', nearest is '" + nearest_name(name, names) + "'");
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

// Parts of a chain: joints, frames and the rigid-body model.
struct Assembly {
  std::string name;
  std::vector<Joint> joints;
  std::vector<Axis> axes;  // axis per joint; meaningless for floating ones
  bool has_floating = false;
  std::vector<std::string> joint_names;
  std::vector<std::string> frame_names;
  std::vector<Frame> frames;
  pinocchio::Model model;

  pinocchio::JointIndex add_joint(pinocchio::JointIndex parent, Joint joint,
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

  pinocchio::JointIndex add_floating_root(const Pose& T_B_root) {
    return add_joint(0, {.name = "root", .type = JointType::kFloating, .position = {}},
                     pinocchio::JointModelFreeFlyer(), to_SE3(T_B_root));
  }

  void add_frame(const std::string& frame_name, pinocchio::JointIndex joint,
                 const pinocchio::SE3& T_joint_frame) {
    frame_names.push_back(frame_name);
    frames.push_back({joint, T_joint_frame});
  }
};

// Walks a URDF from root to tip and adds its joints and links to a chain.
class Builder {
 public:
  Builder(const Urdf& urdf, const ChainOptions& options) : urdf_(urdf), options_(options) {}

  Assembly build() {
    Assembly chain;
    chain.name = urdf_.name;
    const int root = root_link();
    pinocchio::JointIndex joint = 0;
    pinocchio::SE3 placement = to_SE3(options_.T_B_root);
    if (options_.floating_root) {
      joint = chain.add_floating_root(options_.T_B_root);
      placement.setIdentity();
    }

    merge_fixed(chain, joint, root, placement);
    refuse_massless(joint, link(root), options_.floating_root ? "root" : "");
    std::size_t visited = merged_.size();
    while (const UrdfJoint* next = moving_joint()) {
      joint = add(chain, joint, *next);
      merge_fixed(chain, joint, next->child, pinocchio::SE3::Identity());
      refuse_massless(joint, link(next->child), next->name);
      visited += merged_.size();
    }
    if (visited != urdf_.links.size()) fail_for_loop();
    if (chain.joints.empty()) throw SetupError(urdf_.source + ": robot has no moving joint");
    return chain;
  }

 private:
  struct Merged {
    int link;
    pinocchio::SE3 T_joint_link;
  };

  const UrdfLink& link(int index) const { return urdf_.links[static_cast<std::size_t>(index)]; }

  [[noreturn]] void fail(int line, const std::string& what) const {
    throw SetupError(urdf_.source + ":" + std::to_string(line) + ": " + what);
  }

  int root_link() const {
    std::vector<const UrdfJoint*> holder(urdf_.links.size(), nullptr);
    for (const UrdfJoint& j : urdf_.joints) {
      const UrdfJoint*& first = holder[static_cast<std::size_t>(j.child)];
      if (first != nullptr) {
        fail(j.line, "joint " + j.name + ": link " + link(j.child).name +
                         " is the child of joint " + first->name + " already");
      }
      first = &j;
    }
    int root = -1;
    for (int i = 0; i < static_cast<int>(holder.size()); ++i) {
      if (holder[static_cast<std::size_t>(i)] != nullptr) continue;
      if (root >= 0) {
        fail(link(i).line, "link " + link(i).name + ": is not connected to link " +
                               link(root).name + ", a chain has one root");
      }
      root = i;
    }
    if (root < 0) fail_for_loop();
    return root;
  }

  [[noreturn]] void fail_for_loop() const {
    fail(urdf_.joints.front().line, "robot: joints form a loop, a chain has a root and a tip");
  }

  // Collects the links that are fixed to `first`, gives them to the body of `joint` and lists
  // frames.
  void merge_fixed(Assembly& chain, pinocchio::JointIndex joint, int first,
                   const pinocchio::SE3& placement) {
    merged_ = {{first, placement}};
    mass_ = 0.0;
    for (std::size_t i = 0; i < merged_.size(); ++i) {
      const Merged at = merged_[i];
      chain.add_frame(link(at.link).name, joint, at.T_joint_link);
      if (const auto& inertial = link(at.link).inertial; inertial && joint > 0) {
        // a point mass must be fixed to a body with inertia
        const bool is_point = i > 0 && inertial->mass > 0.0 && inertial->inertia.isZero(0.0);
        const std::string& fault = link(at.link).inertial_fault;
        if (!fault.empty() && !is_point) throw SetupError(fault);
        chain.model.appendBodyToJoint(joint, to_inertia(*inertial), at.T_joint_link);
        mass_ += inertial->mass;
      }
      for (const UrdfJoint& j : urdf_.joints) {
        if (j.parent != at.link || j.type != UrdfJointType::kFixed) continue;
        merged_.push_back({j.child, at.T_joint_link * to_SE3(j.T_parent_joint)});
      }
    }
  }

  // The joint that carries the rest of the chain; nullptr at the tip.
  const UrdfJoint* moving_joint() {
    const UrdfJoint* found = nullptr;
    for (const Merged& at : merged_) {
      for (const UrdfJoint& j : urdf_.joints) {
        if (j.parent != at.link || j.type == UrdfJointType::kFixed) continue;
        if (found != nullptr) {
          fail(j.line, "link " + link(at.link).name + ": branches into the joints " + found->name +
                           " and " + j.name +
                           "; name the last link of the chain with tip_link (and its first "
                           "with root_link): the other joints then stand still");
        }
        found = &j;
        T_joint_next_ = at.T_joint_link * to_SE3(j.T_parent_joint);
      }
    }
    return found;
  }

  pinocchio::JointIndex add(Assembly& chain, pinocchio::JointIndex parent,
                            const UrdfJoint& j) const {
    if (j.mimic_line > 0)
      fail(j.mimic_line, "joint " + j.name + ": mimic joints are not supported");
    if (j.type != UrdfJointType::kPlanar) return add(chain, parent, j, T_joint_next_, "");
    pinocchio::SE3 placement = T_joint_next_;
    for (const UrdfJoint& part : planar_parts(j)) {
      parent = add(chain, parent, part, placement, j.name);
      placement.setIdentity();
    }
    return parent;
  }

  static pinocchio::JointIndex add(Assembly& chain, pinocchio::JointIndex parent,
                                   const UrdfJoint& j, const pinocchio::SE3& placement,
                                   const std::string& planar) {
    Joint joint = {.name = j.name,
                   .position = j.position,
                   .velocity_max = j.velocity_max,
                   .effort_max = j.effort_max,
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
    if (joint == 0 || mass_ > 0.0) return;
    fail(body.line, "link " + body.name + ": moves with joint " + joint_name +
                        " but has no mass; give it an <inertial> or make the joint fixed");
  }

  const Urdf& urdf_;
  const ChainOptions& options_;
  std::vector<Merged> merged_;  // links of the current body
  double mass_ = 0.0;           // of the current body
  pinocchio::SE3 T_joint_next_ = pinocchio::SE3::Identity();
};

Assembly build(const Urdf& urdf, const ChainOptions& options) {
  Urdf part = serial_part(urdf, options.root_link, options.tip_link);
  if (options.tool) attach(*options.tool, part);
  for (const PassiveJoint& joint : options.passive)
    insert_behind(joint.behind, joint.name, joint.axis, part);
  Assembly chain = Builder(part, options).build();
  if (chain.model.nv > kMaxTwin || chain.model.nq > kMaxTwinCoords) {
    throw SetupError(urdf.source + ": a chain has at most " + std::to_string(kMaxTwin) +
                     " degrees of freedom, got " + std::to_string(chain.model.nv));
  }
  if (!options.gravity) chain.model.gravity.setZero();
  return chain;
}

Assembly build(const FreeBody& body, const ChainOptions& options) {
  const Inertial inertial = {body.mass, body.p_handle_com, body.inertia};
  check_inertial(inertial, "free body");
  Assembly chain;
  chain.name = "free_body";
  const pinocchio::JointIndex root = chain.add_floating_root(options.T_B_root);
  chain.model.appendBodyToJoint(root, to_inertia(inertial), pinocchio::SE3::Identity());
  chain.add_frame("handle", root, pinocchio::SE3::Identity());
  if (!options.gravity) chain.model.gravity.setZero();
  return chain;
}

// The library's forward and backward passes, bitwise equal, for chains of one-coordinate joints:
// no dispatch on the joint type, and M and c share poses and twists.
class Passes {
 public:
  Passes(const Assembly& parts, pinocchio::Data& data) noexcept
      : axes_(parts.axes), model_(parts.model), data_(data) {}

  void poses(const VectorIn& q) noexcept {
    for (std::size_t i = 1; i <= axes_.size(); ++i) place(i, q[index(i)]);
  }

  void kinematics(const VectorIn& q, const VectorIn& dq) noexcept {
    data_.a[0].setZero();
    for (std::size_t i = 1; i <= axes_.size(); ++i) {
      place(i, q[index(i)]);
      move(i, dq[index(i)], data_.a);
    }
  }

  // M: the upper triangle
  void dynamics(const VectorIn& q, const VectorIn& dq) noexcept {
    data_.a_gf[0] = -model_.gravity;
    for (std::size_t i = 1; i <= axes_.size(); ++i) {
      place(i, q[index(i)]);
      move(i, dq[index(i)], data_.a_gf);
      const pinocchio::Inertia& body = model_.inertias[i];
      data_.oYcrb[i] = data_.oMi[i].act(body);
      data_.f[i] = body * data_.a_gf[i] + body.vxiv(data_.v[i]);
    }
    for (std::size_t i = axes_.size(); i > 0; --i) {
      const Eigen::Index row = index(i);
      auto momentum = data_.Ag.col(row);
      pinocchio::motionSet::inertiaAction(data_.oYcrb[i], data_.J.col(row), momentum);
      for (Eigen::Index k = row; k < model_.nv; ++k) {
        data_.M(row, k) = data_.J.col(row).dot(data_.Ag.col(k));
      }
      const Axis& axis = axes_[i - 1];
      data_.nle[row] = (axis.turns ? data_.f[i].angular() : data_.f[i].linear()).dot(axis.e);
      if (i == 1) continue;
      data_.oYcrb[i - 1] += data_.oYcrb[i];
      data_.f[i - 1] += data_.liMi[i].act(data_.f[i]);
    }
  }

 private:
  static Eigen::Index index(std::size_t joint) noexcept {
    return static_cast<Eigen::Index>(joint) - 1;
  }

  void place(std::size_t joint, double q) noexcept {
    const Axis& axis = axes_[joint - 1];
    const Eigen::Matrix3d& R = model_.jointPlacements[joint].rotation();
    pinocchio::SE3& T = data_.liMi[joint];
    auto& R_T = T.rotation();
    T.translation() = model_.jointPlacements[joint].translation();
    double sine = 0.0, cosine = 0.0;
    if (axis.turns) pinocchio::SINCOS(q, &sine, &cosine);
    if (!axis.turns) {
      R_T = R;
      T.translation() += R * (q * axis.e);
    } else if (axis.k >= 0) {
      R_T.col(axis.k) = R.col(axis.k);
      R_T.col(axis.i) = cosine * R.col(axis.i) + sine * R.col(axis.j);
      R_T.col(axis.j) = R_T.col(axis.k).cross(R_T.col(axis.i));
    } else {
      Eigen::Matrix3d turned;
      pinocchio::toRotationMatrix(axis.e, cosine, sine, turned);
      R_T.noalias() = R * turned;
    }
    pinocchio::SE3& T_B = data_.oMi[joint];
    if (joint == 1) {
      T_B = T;
      return;
    }
    const pinocchio::SE3& parent = data_.oMi[joint - 1];
    T_B.rotation().noalias() = parent.rotation() * R_T;
    T_B.translation() = parent.translation() + parent.rotation() * T.translation();
  }

  // column of the Jacobian, v, and accelerations `a` at ddq = 0
  template <typename Motions>
  void move(std::size_t joint, double dq, Motions& a) noexcept {
    const Axis& axis = axes_[joint - 1];
    const pinocchio::SE3& T_B = data_.oMi[joint];
    const Eigen::Vector3d along = T_B.rotation() * axis.e;
    auto column = data_.J.col(index(joint));
    if (axis.turns) {
      column << T_B.translation().cross(along), along;
    } else {
      column << along, Eigen::Vector3d::Zero();
    }

    const pinocchio::SE3& T = data_.liMi[joint];
    pinocchio::Motion& v = data_.v[joint];
    v.setZero();
    (axis.turns ? v.angular() : v.linear()) = axis.e * dq;
    if (joint > 1) v += T.actInv(data_.v[joint - 1]);

    // v x the joint's own twist
    a[joint].setZero();
    if (axis.turns) a[joint].linear() = v.linear().cross(axis.e) * dq;
    (axis.turns ? a[joint].angular() : a[joint].linear()) = v.angular().cross(axis.e) * dq;
    a[joint] += T.actInv(a[joint - 1]);
  }

  const std::vector<Axis>& axes_;
  const pinocchio::Model& model_;
  pinocchio::Data& data_;
};

}  // namespace

struct Chain::Impl {
  explicit Impl(Assembly assembly)
      : parts(std::move(assembly)),
        results(parts.frames.size()),
        data(parts.model),
        scratch(parts.model),
        zero(Eigen::VectorXd::Zero(parts.model.nv)) {}

  Passes passes() noexcept { return {parts, data}; }

  const Frame& frame(int index) const noexcept {
    assert(index >= 0 && index < static_cast<int>(parts.frames.size()));
    return parts.frames[static_cast<std::size_t>(index)];
  }

  // Cached results of a frame, each with the number of the update that it belongs to.
  struct Results {
    std::uint64_t pose_of = 0, twist_of = 0, jacobian_of = 0, bias_of = 0;
    Pose pose;
    Vector6 twist, bias;
    Jacobian J;
  };
  Results& results_of(int index) noexcept { return results[static_cast<std::size_t>(index)]; }

  Assembly parts;
  std::uint64_t updates = 1;
  std::vector<Results> results;  // by frame
  pinocchio::Data data;          // results of update()
  pinocchio::Data scratch;       // workspace of inverse_dynamics()
  Eigen::VectorXd zero;          // (nv)
};

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

Chain::Chain(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
Chain::Chain(const Chain& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
Chain::Chain(Chain&& other) noexcept = default;
Chain& Chain::operator=(const Chain& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
Chain& Chain::operator=(Chain&& other) noexcept = default;
Chain::~Chain() = default;

Chain Chain::from_urdf_file(const std::filesystem::path& file, const ChainOptions& options) {
  return Chain(std::make_unique<Impl>(build(read_urdf_file(file), options)));
}

Chain Chain::from_urdf_text(std::string_view text, std::string_view source,
                            const ChainOptions& options) {
  return Chain(std::make_unique<Impl>(build(read_urdf_text(text, source), options)));
}

Chain Chain::free_body(const FreeBody& body, const ChainOptions& options) {
  return Chain(std::make_unique<Impl>(build(body, options)));
}

const std::string& Chain::name() const noexcept { return impl_->parts.name; }
int Chain::nq() const noexcept { return impl_->parts.model.nq; }
int Chain::nv() const noexcept { return impl_->parts.model.nv; }
const std::vector<Joint>& Chain::joints() const noexcept { return impl_->parts.joints; }
const std::vector<std::string>& Chain::frame_names() const noexcept {
  return impl_->parts.frame_names;
}

int Chain::frame(std::string_view name) const {
  return find(name, impl_->parts.frame_names, impl_->parts.name, "frame");
}

int Chain::joint(std::string_view name) const {
  return find(name, impl_->parts.joint_names, impl_->parts.name, "joint");
}

ConfigurationA Chain::neutral() const noexcept {
  ConfigurationA q = ConfigurationA::Zero(nq());
  for (const Joint& joint : impl_->parts.joints) {
    if (joint.type == JointType::kFloating) q[joint.q_index + 6] = 1.0;
  }
  return q;
}

ConfigurationA Chain::integrate(const VectorIn& q, const VectorIn& step) const noexcept {
  assert(q.size() == nq() && step.size() == nv());
  ConfigurationA q_next(nq());
  for (const Joint& joint : impl_->parts.joints) {
    if (joint.type == JointType::kFloating) {
      q_next.segment<7>(joint.q_index) =
          integrate_floating(q.segment<7>(joint.q_index), step.segment<6>(joint.v_index));
    } else {
      q_next[joint.q_index] = q[joint.q_index] + step[joint.v_index];
    }
  }
  return q_next;
}

void Chain::update_poses(const VectorIn& q) noexcept {
  assert(q.size() == nq());
  ++impl_->updates;
  if (!impl_->parts.has_floating) return impl_->passes().poses(q);
  pinocchio::forwardKinematics(impl_->parts.model, impl_->data, q);
}

void Chain::update_kinematics(const VectorIn& q, const VectorIn& dq) noexcept {
  assert(q.size() == nq() && dq.size() == nv());
  ++impl_->updates;
  if (!impl_->parts.has_floating) return impl_->passes().kinematics(q, dq);
  const VectorIn ddq(impl_->zero);
  pinocchio::forwardKinematics(impl_->parts.model, impl_->data, q, dq, ddq);
  pinocchio::computeJointJacobians(impl_->parts.model, impl_->data);
}

Loads Chain::default_loads() const noexcept {
  return {.mass = 1.0, .gravity = impl_->parts.model.gravity.linear().isZero(0.0) ? 0.0 : 1.0};
}

void Chain::update(const VectorIn& q, const VectorIn& dq, const Loads& loads) noexcept {
  assert(q.size() == nq() && dq.size() == nv());
  ++impl_->updates;
  const pinocchio::Model& model = impl_->parts.model;
  pinocchio::Data& data = impl_->data;

  // poses, Jacobians, M; velocities, c, and accelerations at ddq = 0 in a frame that falls with
  // gravity
  if (impl_->parts.has_floating) {
    pinocchio::crba(model, data, q, pinocchio::Convention::WORLD);
    pinocchio::nonLinearEffects(model, data, q, dq);
  } else {
    impl_->passes().dynamics(q, dq);
  }
  data.M.triangularView<Eigen::StrictlyLower>() = data.M.transpose();
  const Eigen::Vector3d g = model.gravity.linear();
  for (pinocchio::JointIndex i = 1; i < data.a.size(); ++i) {
    data.a[i] = data.a_gf[i];
    data.a[i].linear() += data.oMi[i].rotation().transpose() * g;
  }

  // each joint carries the weight of all bodies beyond it
  const Eigen::Vector3d g_earth(0.0, 0.0, -9.81);
  for (pinocchio::JointIndex i = 1; i < data.oYcrb.size(); ++i) {
    const Eigen::Vector3d weight = data.oYcrb[i].mass() * g_earth;
    Vector6 wrench;
    wrench << weight, data.oYcrb[i].lever().cross(weight);
    const int v_index = model.idx_vs[i];
    const int size = model.nvs[i];
    data.g.segment(v_index, size).noalias() =
        -data.J.middleCols(v_index, size).transpose() * wrench;
  }
  const double gravity_change = loads.gravity - default_loads().gravity;
  if (gravity_change != 0.0) data.nle += gravity_change * data.g;
  data.nle *= loads.mass;
  data.M *= loads.mass;
  data.g *= loads.mass * loads.gravity;
}

const Pose& Chain::pose(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  if (std::exchange(results.pose_of, impl_->updates) == impl_->updates) return results.pose;
  const Frame& f = impl_->frame(frame);
  const pinocchio::SE3& T_B_joint = impl_->data.oMi[f.joint];
  results.pose.p = T_B_joint.translation() + T_B_joint.rotation() * f.T_joint_frame.translation();
  results.pose.R.noalias() = T_B_joint.rotation() * f.T_joint_frame.rotation();
  return results.pose;
}

const Vector6& Chain::twist(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  if (std::exchange(results.twist_of, impl_->updates) == impl_->updates) return results.twist;
  const Frame& f = impl_->frame(frame);
  const Eigen::Matrix3d& R_B_joint = impl_->data.oMi[f.joint].rotation();
  const pinocchio::Motion& v = impl_->data.v[f.joint];
  results.twist << R_B_joint * (v.linear() + v.angular().cross(f.T_joint_frame.translation())),
      R_B_joint * v.angular();
  return results.twist;
}

const Jacobian& Chain::jacobian(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  Jacobian& J = results.J;
  if (std::exchange(results.jacobian_of, impl_->updates) == impl_->updates) return J;
  const Frame& f = impl_->frame(frame);
  const Eigen::Vector3d p_B_frame = impl_->data.oMi[f.joint].act(f.T_joint_frame.translation());

  // joints beyond the frame do not move it
  const int columns = impl_->parts.model.idx_vs[f.joint] + impl_->parts.model.nvs[f.joint];
  J.resize(6, nv());
  for (int i = 0; i < columns; ++i) {
    // columns of data.J are twists at the origin of B
    const Eigen::Vector3d v = impl_->data.J.col(i).head<3>();
    const Eigen::Vector3d omega = impl_->data.J.col(i).tail<3>();
    J.col(i) << v + omega.cross(p_B_frame), omega;
  }
  J.rightCols(nv() - columns).setZero();
  return J;
}

const Vector6& Chain::bias_acceleration(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  if (std::exchange(results.bias_of, impl_->updates) == impl_->updates) return results.bias;
  const Frame& f = impl_->frame(frame);
  const Eigen::Matrix3d& R_B_joint = impl_->data.oMi[f.joint].rotation();
  const Eigen::Vector3d& p = f.T_joint_frame.translation();
  const pinocchio::Motion& v = impl_->data.v[f.joint];
  const pinocchio::Motion& a = impl_->data.a[f.joint];

  // spatial to classical acceleration of the frame's origin
  const Eigen::Vector3d v_frame = v.linear() + v.angular().cross(p);
  const Eigen::Vector3d a_frame = a.linear() + a.angular().cross(p) + v.angular().cross(v_frame);
  results.bias << R_B_joint * a_frame, R_B_joint * a.angular();
  return results.bias;
}

const Eigen::MatrixXd& Chain::M() const noexcept { return impl_->data.M; }
const Eigen::VectorXd& Chain::c() const noexcept { return impl_->data.nle; }
const Eigen::VectorXd& Chain::gravity() const noexcept { return impl_->data.g; }

double Chain::potential_energy() const noexcept {
  const pinocchio::Model& model = impl_->parts.model;
  double energy = 0.0;
  for (pinocchio::JointIndex i = 1; i < impl_->data.oMi.size(); ++i) {
    const pinocchio::Inertia& body = model.inertias[i];
    energy -= body.mass() * impl_->data.oMi[i].act(body.lever()).dot(model.gravity.linear());
  }
  return energy;
}

VectorA Chain::inverse_dynamics(const VectorIn& q, const VectorIn& dq,
                                const VectorIn& ddq) noexcept {
  assert(q.size() == nq() && dq.size() == nv() && ddq.size() == nv());
  return pinocchio::rnea(impl_->parts.model, impl_->scratch, q, dq, ddq);
}

}  // namespace hg::model
