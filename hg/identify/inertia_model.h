/// Torques of a device's joints as a linear function of the inertial parameters of its links.
///
/// Parameters of a link, in its own frame and about its origin, in the order of Pinocchio:
///   m, m c_x, m c_y, m c_z, I_xx, I_xy, I_yy, I_xz, I_yz, I_zz
/// Links that are fixed to another one, and the tool, belong to the known part. SI units.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/model/chain_data.h"
#include "hg/model/urdf.h"

namespace hg::identify {

inline constexpr Eigen::Index kLinkParameters = 10;

using LinkParameters = Eigen::Matrix<double, kLinkParameters, 1>;

LinkParameters parameters_of(const model::Inertial& inertial);
Eigen::Matrix3d inertia_about_origin(const LinkParameters& parameters);
model::Inertial inertial_of(const LinkParameters& parameters);

/// Name of parameter `i` of a link, such as "m c_x".
const char* parameter_name(Eigen::Index i);

/// Angles, speeds and accelerations of all joints of the chain, and the reading of the sensor.
struct Moment {
  Eigen::VectorXd q, dq, ddq;
  Vector6 wrench_S;  ///< force first
};

class InertiaModel {
 public:
  /// Throws SetupError where the URDF of the device is not among its texts.
  explicit InertiaModel(const config::DeviceConfig& device);

  const std::vector<std::string>& links() const { return links_; }  ///< links that joints move
  /// Parameters of these links by the URDF, one link after the other.
  const Eigen::VectorXd& nominal() const { return nominal_; }

  /// Moves to a moment; the other functions speak of it.
  void update(const Moment& moment);
  /// Torques of the manipulator's joints by the device's files, without the user's wrench, Nm.
  Eigen::VectorXd nominal_torques() const;
  /// Torques of these joints per unit of each parameter of the links.
  Eigen::MatrixXd regressor() const;
  /// Torques of these joints per unit of the user's wrench at the sensor, in S: minus J^T.
  Eigen::MatrixXd wrench_columns() const;
  /// The user's wrench at the sensor by its reading and the payload of the files, in S.
  Vector6 user_wrench() const;

 private:
  struct Motion {
    Eigen::Vector3d a, omega, alpha;  // a: without gravity, all in the axes of the frame
  };
  Motion motion_of(int frame) const;

  model::ChainData chain_;
  int n_p_, n_m_, handle_;
  Pose T_H_S_;
  Payload payload_;
  std::vector<std::string> links_;
  std::vector<int> frames_;
  Eigen::VectorXd nominal_;
  Moment moment_;
  Eigen::VectorXd tau_;
};

/// Which combinations of the parameters show in the torques at all, whatever the motion.
struct BaseParameters {
  std::vector<Eigen::Index> chosen;  ///< one parameter for each combination
  /// base = combination * parameters, (base x parameters)
  Eigen::MatrixXd combination;
  std::vector<std::string> names;  ///< such as "link2 I_yy + 0.316 link3 m c_x"
};

/// By the rank of the regressors of random motions: a parameter that depends on those before it is
/// none of its own. `joints`: of the manipulator, `nv`: velocities of the chain.
BaseParameters base_parameters(InertiaModel model, int joints, Eigen::Index nv);

}  // namespace hg::identify
