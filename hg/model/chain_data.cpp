#include "hg/model/chain_data.h"

#include <cassert>
#include <cstdint>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <utility>
#include <vector>

#include "hg/model/chain_parts.h"

namespace hg::model {
namespace {

// The library's forward and backward passes, bitwise equal, for chains of one-coordinate joints:
// no dispatch on the joint type, and M and c share poses and twists.
class Passes {
 public:
  Passes(const ChainParts& parts, pinocchio::Data& data) noexcept
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
      const ChainParts::Axis& axis = axes_[i - 1];
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
    const ChainParts::Axis& axis = axes_[joint - 1];
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
    const ChainParts::Axis& axis = axes_[joint - 1];
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

  const std::vector<ChainParts::Axis>& axes_;
  const pinocchio::Model& model_;
  pinocchio::Data& data_;
};

}  // namespace

struct ChainData::Impl {
  explicit Impl(ChainModel shared)
      : model(std::move(shared)),
        parts(*model.parts_),
        results(parts.frames.size()),
        data(parts.model),
        scratch(parts.model),
        all(parts),
        all_later(parts),
        own_M(parts.nv, parts.nv),
        own_c(parts.nv),
        own_g(parts.nv) {
    move_base(parts.T_B_base, Vector6::Zero(), Vector6::Zero());
  }

  void move_base(const Pose& T, const Vector6& twist, const Vector6& acceleration) noexcept {
    if (!parts.has_moving_base) return;
    const Eigen::Vector3d v = twist.head<3>(), omega = twist.tail<3>();
    for (Expansion* to : {&all, &all_later}) {
      // its joint has the pose in B, and velocities and their changes resolved in the base
      to->q.head<7>() << T.p, Eigen::Quaterniond(T.R).coeffs();
      to->dq.head<6>() << T.R.transpose() * v, T.R.transpose() * omega;
      to->ddq.head<6>() << T.R.transpose() * (acceleration.head<3>() - omega.cross(v)),
          T.R.transpose() * acceleration.tail<3>();
    }
  }

  bool is_coupled() const noexcept { return !parts.q_from.empty(); }
  // whether the passes above do not know such a chain
  bool needs_library() const noexcept {
    return parts.has_floating || parts.has_branch || has_known_accelerations();
  }
  // Whether bodies accelerate without a change of the chain's velocities.
  bool has_known_accelerations() const noexcept { return parts.has_curve || parts.has_moving_base; }

  // With couplings or a moving base only: values of the rigid-body model.
  struct Expansion {
    explicit Expansion(const ChainParts& parts)
        : q(parts.model.nq),
          dq(Eigen::VectorXd::Zero(parts.model.nv)),
          ddq(Eigen::VectorXd::Zero(parts.model.nv)),
          ratio(parts.model.nv) {
      for (std::size_t i = 0; i < parts.v_from.size(); ++i) {
        ratio[static_cast<Eigen::Index>(i)] = parts.v_from[i].ratio;
      }
    }

    Eigen::VectorXd q, dq;
    Eigen::VectorXd ddq;    // where the velocities of the chain do not change
    Eigen::VectorXd ratio;  // by velocity: its change over that of its leader
  };

  VectorIn expanded_q(const VectorIn& own, Expansion& to) const noexcept {
    if (!is_coupled()) return own;
    for (std::size_t i = 0; i < parts.q_from.size(); ++i) {
      const ChainParts::Source& from = parts.q_from[i];
      if (from.index < 0) continue;
      to.q[static_cast<Eigen::Index>(i)] = from.curve != nullptr
                                               ? from.curve->at(own[from.leader]).value
                                               : from.ratio * own[from.index] + from.offset;
    }
    return to.q;
  }

  VectorIn expanded_dq(const VectorIn& own_q, const VectorIn& own, Expansion& to) const noexcept {
    if (!is_coupled()) return own;
    for (std::size_t i = 0; i < parts.v_from.size(); ++i) {
      const ChainParts::Source& from = parts.v_from[i];
      const Eigen::Index k = static_cast<Eigen::Index>(i);
      if (from.index < 0) continue;
      if (from.curve != nullptr) {
        const CouplingCurve::Point point = from.curve->at(own_q[from.leader]);
        to.ratio[k] = point.slope;
        to.ddq[k] = point.curvature * own[from.index] * own[from.index];
      }
      to.dq[k] = to.ratio[k] * own[from.index];
    }
    return to.dq;
  }

  // Torques of the chain from those of the rigid-body model: power is the same.
  template <typename Own>
  void reduce(const Eigen::VectorXd& torques, const Expansion& by, Own& own) const noexcept {
    own.setZero();
    for (std::size_t i = 0; i < parts.v_from.size(); ++i) {
      const Eigen::Index k = static_cast<Eigen::Index>(i);
      if (parts.v_from[i].index < 0) continue;
      own[parts.v_from[i].index] += by.ratio[k] * torques[k];
    }
  }

  void reduce_dynamics() noexcept {
    if (has_known_accelerations()) data.nle.noalias() += data.M * all.ddq;
    reduce(data.nle, all, own_c);
    reduce(data.g, all, own_g);
    own_M.setZero();
    const Eigen::Index first = parts.has_moving_base ? 6 : 0;
    for (Eigen::Index i = first; i < data.M.rows(); ++i) {
      for (Eigen::Index k = first; k < data.M.cols(); ++k) {
        own_M(parts.v_from[i].index, parts.v_from[k].index) +=
            all.ratio[i] * all.ratio[k] * data.M(i, k);
      }
    }
  }

  // What curves and the base add to accelerations at ddq = 0: each joint's passes on to the joints
  // beyond it.
  void add_known_accelerations() noexcept {
    for (pinocchio::JointIndex i = 1; i < data.a.size(); ++i) {
      const ChainParts::Axis& axis = parts.axes[i - 1];
      added[i].setZero();
      if (i == 1 && parts.has_moving_base) {
        added[i] = pinocchio::Motion(Vector6(all.ddq.head<6>()));
      } else if (parts.model.nvs[i] == 1) {
        (axis.turns ? added[i].angular() : added[i].linear()) =
            axis.e * all.ddq[parts.model.idx_vs[i]];
      }
      if (parts.model.parents[i] > 0)
        added[i] += data.liMi[i].actInv(added[parts.model.parents[i]]);
      data.a[i] += added[i];
    }
  }

  Passes passes() noexcept { return {parts, data}; }

  const ChainParts::Frame& frame(int index) const noexcept {
    assert(index >= 0 && index < static_cast<int>(parts.frames.size()));
    return parts.frames[index];
  }

  // Cached results of a frame, each with the number of the update that it belongs to.
  struct Results {
    std::uint64_t pose_of = 0, twist_of = 0, jacobian_of = 0, bias_of = 0;
    Pose pose;
    Vector6 twist, bias;
    Jacobian J;
  };
  Results& results_of(int index) noexcept { return results[index]; }

  ChainModel model;
  const ChainParts& parts;  // of the model
  std::uint64_t updates = 1;
  std::vector<Results> results;  // by frame
  pinocchio::Data data;          // results of update()
  pinocchio::Data scratch;       // workspace of inverse_dynamics()
  // what curves and the base add to the accelerations of the bodies
  std::vector<pinocchio::Motion> added = std::vector<pinocchio::Motion>(parts.model.njoints);
  Expansion all, all_later;  // of updates, and of inverse_dynamics()
  // with couplings or a moving base only: results of the chain
  Eigen::MatrixXd own_M;
  Eigen::VectorXd own_c, own_g;
};

ChainData::ChainData(ChainModel model) : impl_(std::make_unique<Impl>(std::move(model))) {}
ChainData::ChainData(const ChainData& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
ChainData::ChainData(ChainData&& other) noexcept = default;
ChainData& ChainData::operator=(const ChainData& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
ChainData& ChainData::operator=(ChainData&& other) noexcept = default;
ChainData::~ChainData() = default;

const ChainModel& ChainData::model() const noexcept { return impl_->model; }

void ChainData::move_base(const Pose& T_B_base, const Vector6& twist,
                          const Vector6& acceleration) noexcept {
  impl_->move_base(T_B_base, twist, acceleration);
}

void ChainData::update_poses(const VectorIn& own_q) noexcept {
  assert(own_q.size() == model().nq());
  ++impl_->updates;
  const VectorIn q = impl_->expanded_q(own_q, impl_->all);
  if (!impl_->needs_library()) return impl_->passes().poses(q);
  pinocchio::forwardKinematics(impl_->parts.model, impl_->data, q);
}

void ChainData::update_kinematics(const VectorIn& own_q, const VectorIn& own_dq) noexcept {
  assert(own_q.size() == model().nq() && own_dq.size() == model().nv());
  ++impl_->updates;
  const VectorIn q = impl_->expanded_q(own_q, impl_->all);
  const VectorIn dq = impl_->expanded_dq(own_q, own_dq, impl_->all);
  if (!impl_->needs_library()) return impl_->passes().kinematics(q, dq);
  const VectorIn ddq(impl_->all.ddq);
  pinocchio::forwardKinematics(impl_->parts.model, impl_->data, q, dq, ddq);
  pinocchio::computeJointJacobians(impl_->parts.model, impl_->data);
}

void ChainData::update(const VectorIn& q, const VectorIn& dq) noexcept {
  update(q, dq, impl_->model.default_loads());
}

void ChainData::update(const VectorIn& own_q, const VectorIn& own_dq, const Loads& loads) noexcept {
  assert(own_q.size() == model().nq() && own_dq.size() == model().nv());
  ++impl_->updates;
  const VectorIn q = impl_->expanded_q(own_q, impl_->all);
  const VectorIn dq = impl_->expanded_dq(own_q, own_dq, impl_->all);
  const pinocchio::Model& model = impl_->parts.model;
  pinocchio::Data& data = impl_->data;

  // poses, Jacobians, M; velocities, c, and accelerations at ddq = 0 in a frame that falls with
  // gravity
  if (impl_->needs_library()) {
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
  if (impl_->has_known_accelerations()) impl_->add_known_accelerations();

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
  const double gravity_change = loads.gravity - impl_->model.default_loads().gravity;
  if (gravity_change != 0.0) data.nle += gravity_change * data.g;
  data.nle *= loads.mass;
  data.M *= loads.mass;
  data.g *= loads.mass * loads.gravity;
  if (impl_->is_coupled()) impl_->reduce_dynamics();
}

const Pose& ChainData::pose(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  if (std::exchange(results.pose_of, impl_->updates) == impl_->updates) return results.pose;
  const ChainParts::Frame& f = impl_->frame(frame);
  const pinocchio::SE3& T_B_joint = impl_->data.oMi[f.joint];
  results.pose.p = T_B_joint.translation() + T_B_joint.rotation() * f.T_joint_frame.translation();
  results.pose.R.noalias() = T_B_joint.rotation() * f.T_joint_frame.rotation();
  return results.pose;
}

const Vector6& ChainData::twist(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  if (std::exchange(results.twist_of, impl_->updates) == impl_->updates) return results.twist;
  const ChainParts::Frame& f = impl_->frame(frame);
  const Eigen::Matrix3d& R_B_joint = impl_->data.oMi[f.joint].rotation();
  const pinocchio::Motion& v = impl_->data.v[f.joint];
  results.twist << R_B_joint * (v.linear() + v.angular().cross(f.T_joint_frame.translation())),
      R_B_joint * v.angular();
  return results.twist;
}

const Jacobian& ChainData::jacobian(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  Jacobian& J = results.J;
  if (std::exchange(results.jacobian_of, impl_->updates) == impl_->updates) return J;
  const ChainParts::Frame& f = impl_->frame(frame);
  const Eigen::Vector3d p_B_frame = impl_->data.oMi[f.joint].act(f.T_joint_frame.translation());

  const auto column = [&](Eigen::Index i) {
    // columns of data.J are twists at the origin of B
    const Eigen::Vector3d v = impl_->data.J.col(i).head<3>();
    const Eigen::Vector3d omega = impl_->data.J.col(i).tail<3>();
    Vector6 twist;
    twist << v + omega.cross(p_B_frame), omega;
    return twist;
  };
  if (impl_->is_coupled()) {
    J.setZero(6, impl_->parts.nv);
    for (const pinocchio::JointIndex joint : impl_->parts.model.supports[f.joint]) {
      const int first = impl_->parts.model.idx_vs[joint];
      for (int i = first; i < first + impl_->parts.model.nvs[joint]; ++i) {
        if (impl_->parts.v_from[i].index < 0) continue;
        J.col(impl_->parts.v_from[i].index) += impl_->all.ratio[i] * column(i);
      }
    }
    return J;
  }

  // joints beyond the frame do not move it
  const int columns = impl_->parts.model.idx_vs[f.joint] + impl_->parts.model.nvs[f.joint];
  const int n = impl_->parts.model.nv;
  J.resize(6, n);
  for (int i = 0; i < columns; ++i) J.col(i) = column(i);
  J.rightCols(n - columns).setZero();
  return J;
}

Vector6 ChainData::carried_twist(int frame) const noexcept {
  if (!impl_->parts.has_moving_base) return Vector6::Zero();
  const Eigen::Matrix3d& R = impl_->data.oMi[1].rotation();
  const Eigen::Vector3d v = R * impl_->all.dq.head<3>();
  const Eigen::Vector3d omega = R * impl_->all.dq.segment<3>(3);
  const Eigen::Vector3d lever = pose(frame).p - impl_->data.oMi[1].translation();
  Vector6 twist;
  twist << v + omega.cross(lever), omega;
  return twist;
}

const Vector6& ChainData::bias_acceleration(int frame) const noexcept {
  Impl::Results& results = impl_->results_of(frame);
  if (std::exchange(results.bias_of, impl_->updates) == impl_->updates) return results.bias;
  const ChainParts::Frame& f = impl_->frame(frame);
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

const Eigen::MatrixXd& ChainData::M() const noexcept {
  return impl_->is_coupled() ? impl_->own_M : impl_->data.M;
}
const Eigen::VectorXd& ChainData::c() const noexcept {
  return impl_->is_coupled() ? impl_->own_c : impl_->data.nle;
}
const Eigen::VectorXd& ChainData::gravity() const noexcept {
  return impl_->is_coupled() ? impl_->own_g : impl_->data.g;
}

double ChainData::potential_energy() const noexcept {
  const pinocchio::Model& model = impl_->parts.model;
  double energy = 0.0;
  for (pinocchio::JointIndex i = 1; i < impl_->data.oMi.size(); ++i) {
    const pinocchio::Inertia& body = model.inertias[i];
    energy -= body.mass() * impl_->data.oMi[i].act(body.lever()).dot(model.gravity.linear());
  }
  return energy;
}

VectorA ChainData::inverse_dynamics(const VectorIn& own_q, const VectorIn& own_dq,
                                    const VectorIn& own_ddq) noexcept {
  assert(own_q.size() == model().nq() && own_dq.size() == model().nv() &&
         own_ddq.size() == model().nv());
  const ChainParts& parts = impl_->parts;
  if (!impl_->is_coupled()) {
    return pinocchio::rnea(parts.model, impl_->scratch, own_q, own_dq, own_ddq);
  }
  Impl::Expansion& all = impl_->all_later;
  impl_->expanded_q(own_q, all);
  impl_->expanded_dq(own_q, own_dq, all);
  for (std::size_t i = 0; i < parts.v_from.size(); ++i) {
    const Eigen::Index k = static_cast<Eigen::Index>(i);
    if (parts.v_from[i].index < 0) continue;
    const double curved = parts.v_from[i].curve != nullptr ? all.ddq[k] : 0.0;
    all.ddq[k] = all.ratio[k] * own_ddq[parts.v_from[i].index] + curved;
  }
  VectorA torque(parts.nv);
  impl_->reduce(pinocchio::rnea(parts.model, impl_->scratch, all.q, all.dq, all.ddq), all, torque);
  return torque;
}

}  // namespace hg::model
