/// Rows of the regression of inertia.h, from the motion of all joints.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hg/identify/block_regression.h"
#include "hg/identify/inertia.h"

namespace hg::identify {

class InertiaRows {
 public:
  InertiaRows(InertiaModel& model, const BaseParameters& base,
              const std::vector<JointMotion>& parts, const DeviceModel& device,
              const VectorM& gear_ratio);

  int blocks() const { return static_cast<int>(begins_.size()); }
  /// Name and motion of each joint.
  std::vector<JointFit> motion() const;
  /// Solves for the base parameters, then all others; fills in what the torques leave unexplained.
  Regressed solve(std::vector<JointFit>& joints) const;

 private:
  struct Row {
    Eigen::MatrixXd A;
    Eigen::VectorXd y;
  };
  void add(const JointMotion& part, const DeviceModel& device);
  Series ripples(const JointMotion& part) const;
  Row row_of(const Moment& moment, const Eigen::VectorXd& tau, const Eigen::VectorXd& ripple,
             const Vector6& wrench_rate) const;
  Regressed solve(const Eigen::VectorXd& deviation) const;
  Eigen::VectorXd deviation_by_files() const;
  Eigen::VectorXd residuals(const Eigen::VectorXd& x) const;

  InertiaModel& model_;
  const BaseParameters& base_;
  Eigen::Index bases_, n_m_, n_p_;
  VectorM gear_ratio_;
  std::vector<Row> rows_;
  std::vector<std::size_t> begins_;  // first row of each block
  std::vector<JointFit> joints_;
  Eigen::VectorXd least_, largest_, squares_;  // positions; accelerations
};

}  // namespace hg::identify
