/// A trace of one joint made ready for the fit of its friction, and the model that is fitted; see
/// friction.h for both.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "hg/identification/friction.h"

namespace hg::identification::friction {

enum Parameter {
  kCoulomb,
  kLoad,
  kStiction,
  kStribeck,    // logarithm
  kPresliding,  // logarithm
  kDamping,     // ratio, of a rotor on its bristles
  kViscous,
  kOffset,
  kGain,
  kInertia,  // error, over that of the rotor
  kParameters
};
using Parameters = Eigen::Matrix<double, kParameters, 1>;
/// Which parameters are fitted; the others stay.
using Free = std::array<bool, kParameters>;

/// What is fitted: values of all parameters.
struct Model {
  Parameters p = Parameters::Zero();
  int elements = 1;
};

inline constexpr double kRigid = 2e-6;  ///< rad: presliding of friction that has none
inline constexpr int kSmoothing = 10;   ///< samples on either side
inline constexpr int kSamplesPerRow = 5;

/// One row per kSamplesPerRow samples of a joint that moves.
class Rows {
 public:
  Rows(const FrictionTrace& trace, double rotor_inertia);

  Eigen::Index size() const { return y_.size(); }
  const Eigen::VectorXd& y() const { return y_; }
  const Eigen::VectorXd& speed() const { return v_; }
  const Eigen::VectorXd& spring() const { return tau_; }
  /// 1 where the joint moves one way all the time that the smoothing sees, else 0.
  const Eigen::VectorXd& slides() const { return slides_; }
  /// First row of each block, and the number of rows.
  const std::vector<Eigen::Index>& block_begins() const { return block_begins_; }
  double row_s() const { return kSamplesPerRow * trace_.period_s; }

  /// Dry friction of all rows, Nm.
  Eigen::VectorXd dry(const Model& model) const;

  /// What the linear parameters are multiplied with, a column each.
  Eigen::MatrixXd linear() const;

  int reversals() const;

 private:
  template <typename Do>
  void for_each_part(Do&& take) const;
  double smoothed(const std::vector<double>& x, std::size_t k) const;
  double way(std::size_t k) const;
  bool slides(std::size_t k) const;

  const FrictionTrace& trace_;
  std::array<double, 2 * kSmoothing + 1> window_;
  double Jm_;
  std::vector<double> speed_;
  std::vector<std::size_t> at_;
  Eigen::VectorXd y_, v_, tau_, ddtheta_, slides_;
  std::vector<int> blocks_;
  std::vector<Eigen::Index> block_begins_;
};

}  // namespace hg::identification::friction
