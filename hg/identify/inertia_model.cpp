#include "hg/identify/inertia_model.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "hg/core/cross.h"
#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/signals/payload.h"

namespace hg::identify {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kGravity = 9.81;  // as in the model of the device

// I v = matrix (I_xx, I_xy, I_yy, I_xz, I_yz, I_zz)
Eigen::Matrix<double, 3, 6> times_inertia(const Vector3d& v) {
  Eigen::Matrix<double, 3, 6> m;
  m << v.x(), v.y(), 0, v.z(), 0, 0,  //
      0, v.x(), v.y(), 0, v.z(), 0,   //
      0, 0, 0, v.x(), v.y(), v.z();
  return m;
}

model::Urdf urdf_of(const config::DeviceConfig& device) {
  for (const config::SourceText& text : device.sources) {
    const std::filesystem::path name = text.name;
    if (name == device.urdf || name.filename() == device.urdf.filename()) {
      return model::read_urdf_text(text.content, text.name);
    }
  }
  throw SetupError(device.urdf.string() + ": is not among the files of the device");
}

}  // namespace

LinkParameters parameters_of(const model::Inertial& inertial) {
  const Vector3d& c = inertial.p_com;
  const Matrix3d I = inertial.inertia - inertial.mass * cross_matrix(c) * cross_matrix(c);
  LinkParameters p;
  p << inertial.mass, inertial.mass * c, I(0, 0), I(0, 1), I(1, 1), I(0, 2), I(1, 2), I(2, 2);
  return p;
}

Matrix3d inertia_about_origin(const LinkParameters& p) {
  Matrix3d I;
  I << p[4], p[5], p[7], p[5], p[6], p[8], p[7], p[8], p[9];
  return I;
}

model::Inertial inertial_of(const LinkParameters& p) {
  model::Inertial inertial;
  inertial.mass = p[0];
  inertial.p_com = p.segment<3>(1) / p[0];
  inertial.inertia =
      inertia_about_origin(p) + p[0] * cross_matrix(inertial.p_com) * cross_matrix(inertial.p_com);
  return inertial;
}

const char* parameter_name(Eigen::Index i) {
  constexpr std::array<const char*, kLinkParameters> kNames = {
      "m", "m c_x", "m c_y", "m c_z", "I_xx", "I_xy", "I_yy", "I_xz", "I_yz", "I_zz"};
  return kNames.at(static_cast<std::size_t>(i));
}

InertiaModel::InertiaModel(const config::DeviceConfig& device)
    : chain_(device.model.chain),
      n_p_(device.model.n_p),
      n_m_(device.model.n_m),
      handle_(device.model.handle),
      T_H_S_(device.model.T_H_S),
      payload_(device.estimation.wrench.payload) {
  const model::Urdf urdf = urdf_of(device);
  for (int i = 0; i < n_m_; ++i) {
    const std::string& joint = device.model.manipulator_joint(i);
    const auto at = std::ranges::find(urdf.joints, joint, &model::UrdfJoint::name);
    if (at == urdf.joints.end()) throw SetupError("joint " + joint + ": is not in the URDF");
    const model::UrdfLink& link = urdf.links[static_cast<std::size_t>(at->child)];
    if (!link.inertial) continue;
    links_.push_back(link.name);
    frames_.push_back(chain_.model().frame(link.name));
    nominal_.conservativeResize(nominal_.size() + kLinkParameters);
    nominal_.tail<kLinkParameters>() = parameters_of(*link.inertial);
  }
}

void InertiaModel::update(const Moment& moment) {
  moment_ = moment;
  chain_.update(moment.q, moment.dq);
  tau_ = chain_.inverse_dynamics(moment.q, moment.dq, moment.ddq);
}

VectorXd InertiaModel::nominal_torques() const { return tau_.segment(n_p_, n_m_); }

InertiaModel::Motion InertiaModel::motion_of(int frame) const {
  const Matrix3d& R = chain_.pose(frame).R;
  const Vector6 acceleration =
      chain_.jacobian(frame) * moment_.ddq + chain_.bias_acceleration(frame);
  const Vector3d up(0.0, 0.0, kGravity);
  return {R.transpose() * (acceleration.head<3>() + up),
          R.transpose() * chain_.twist(frame).tail<3>(), R.transpose() * acceleration.tail<3>()};
}

// Newton and Euler about the origin of the link:
//   f = m a + (alpha x + omega x omega x) m c,  n = m c x a + I alpha + omega x I omega
MatrixXd InertiaModel::regressor() const {
  MatrixXd columns(n_m_, nominal_.size());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const Motion m = motion_of(frames_[i]);
    Eigen::Matrix<double, 6, kLinkParameters> wrench =
        Eigen::Matrix<double, 6, kLinkParameters>::Zero();
    wrench.block<3, 1>(0, 0) = m.a;
    wrench.block<3, 3>(0, 1) =
        cross_matrix(m.alpha) + cross_matrix(m.omega) * cross_matrix(m.omega);
    wrench.block<3, 3>(3, 1) = -cross_matrix(m.a);
    wrench.block<3, 6>(3, 4) =
        times_inertia(m.alpha) + cross_matrix(m.omega) * times_inertia(m.omega);
    const Matrix3d& R = chain_.pose(frames_[i]).R;
    const model::Jacobian& J = chain_.jacobian(frames_[i]);
    MatrixXd J_link(6, J.cols());
    J_link << R.transpose() * J.topRows<3>(), R.transpose() * J.bottomRows<3>();
    columns.middleCols(static_cast<Eigen::Index>(i) * kLinkParameters, kLinkParameters) =
        J_link.middleCols(n_p_, n_m_).transpose() * wrench;
  }
  return columns;
}

MatrixXd InertiaModel::wrench_columns() const {
  const Matrix3d& R_B_H = chain_.pose(handle_).R;
  const Matrix3d R_B_S = R_B_H * T_H_S_.R;
  const model::Jacobian& J_H = chain_.jacobian(handle_);
  MatrixXd J_S = J_H;
  J_S.topRows<3>() -= cross_matrix(R_B_H * T_H_S_.p) * J_H.bottomRows<3>();
  MatrixXd in_S(6, J_S.cols());
  in_S << R_B_S.transpose() * J_S.topRows<3>(), R_B_S.transpose() * J_S.bottomRows<3>();
  return -in_S.middleCols(n_p_, n_m_).transpose();
}

Vector6 InertiaModel::user_wrench() const {
  const Motion H = motion_of(handle_);
  const Vector3d& r = T_H_S_.p;
  const Vector3d a = H.a + H.alpha.cross(r) + H.omega.cross(H.omega.cross(r));
  const Matrix3d R_S_H = T_H_S_.R.transpose();
  return moment_.wrench_S - payload_wrench(payload_, R_S_H * a, R_S_H * H.omega, R_S_H * H.alpha);
}

namespace {

// Regressors of random motions, one below the other.
MatrixXd random_regressors(InertiaModel& model, Eigen::Index nv, int joints) {
  constexpr int kMoments = 60;
  Random random(1);
  const auto draw = [&] {
    return VectorXd(
        VectorXd::NullaryExpr(nv, [&](Eigen::Index) { return random.between(-1.5, 1.5); }));
  };
  MatrixXd stacked(kMoments * joints, model.nominal().size());
  for (int k = 0; k < kMoments; ++k) {
    const VectorXd q = draw(), dq = draw(), ddq = 3.0 * draw();
    model.update({q, dq, ddq, Vector6::Zero()});
    stacked.middleRows(k * joints, joints) = model.regressor();
  }
  return stacked;
}

std::string name_of(const InertiaModel& model, Eigen::Index parameter) {
  return model.links()[static_cast<std::size_t>(parameter / kLinkParameters)] + " " +
         parameter_name(parameter % kLinkParameters);
}

}  // namespace

BaseParameters base_parameters(InertiaModel model, int joints, Eigen::Index nv) {
  constexpr double kDepends = 1e-7;  // of a column
  const MatrixXd Y = random_regressors(model, nv, joints);
  BaseParameters base;
  MatrixXd Q(Y.rows(), 0);  // orthonormal columns of the chosen parameters
  for (Eigen::Index i = 0; i < Y.cols(); ++i) {
    VectorXd rest = Y.col(i);
    for (int round = 0; round < 2; ++round) rest -= Q * (Q.transpose() * rest);
    if (rest.norm() <= kDepends * std::max(1.0, Y.col(i).norm())) continue;
    base.chosen.push_back(i);
    Q.conservativeResize(Eigen::NoChange, Q.cols() + 1);
    Q.rightCols<1>() = rest.normalized();
  }
  const MatrixXd chosen = Y(Eigen::all, base.chosen);
  base.combination = chosen.colPivHouseholderQr().solve(Y);
  for (Eigen::Index b = 0; b < base.combination.rows(); ++b) {
    const Eigen::Index own = base.chosen[static_cast<std::size_t>(b)];
    std::string name = name_of(model, own);
    for (Eigen::Index i = 0; i < base.combination.cols(); ++i) {
      double& share = base.combination(b, i);
      if (std::abs(share) < 1e-9) share = 0.0;
      if (i == own || share == 0.0) continue;
      name +=
          fmt::format(" {} {:.4g} {}", share < 0.0 ? "-" : "+", std::abs(share), name_of(model, i));
    }
    base.names.push_back(std::move(name));
  }
  return base;
}

}  // namespace hg::identify
