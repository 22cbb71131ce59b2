/// Rows for the friction fit from a trace of one joint, and the fitted model; see friction.h for
/// both.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "hg/identify/friction.h"

namespace hg::identify::friction {

enum Parameter {
  kCoulomb,
  kLoad,
  kStiction,
  kStribeck,    // logarithm of the Stribeck speed
  kPresliding,  // logarithm of the presliding
  kDamping,     // damping ratio of a rotor on its bristles
  kViscous,
  kOffset,
  kGain,
  kInertia,  // inertia error over the rotor inertia
  kParameters
};
using Parameters = Eigen::Matrix<double, kParameters, 1>;
/// Flags of the fitted parameters; the others stay.
using Free = std::array<bool, kParameters>;

/// Fitted model: values of all parameters.
struct Model {
  Parameters p = Parameters::Zero();
  int elements = 1;
};

inline constexpr double kRigid = 2e-6;  ///< presliding used for friction without presliding, rad
inline constexpr int kSmoothing = 10;   ///< half width of the smoothing, samples
inline constexpr int kSamplesPerRow = 5;

/// One row per kSamplesPerRow samples of a joint that moves.
class Rows {
 public:
  Rows(const FrictionTrace& trace, double rotor_inertia);

  Eigen::Index size() const { return y_.size(); }
  const Eigen::VectorXd& y() const { return y_; }
  const Eigen::VectorXd& speed() const { return v_; }
  const Eigen::VectorXd& spring() const { return tau_; }
  /// Per row: 1 where the joint moves one way during the whole smoothing window, else 0.
  const Eigen::VectorXd& slides() const { return slides_; }
  /// First row of each block, and the number of rows.
  const std::vector<Eigen::Index>& block_begins() const { return block_begins_; }
  double row_s() const { return kSamplesPerRow * trace_.period_s; }

  /// Dry friction of all rows, Nm.
  Eigen::VectorXd dry(const Model& model) const;

  /// Regressors of the linear parameters, a column each.
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
  double J_m_;
  std::vector<double> speed_;
  std::vector<std::size_t> at_;
  Eigen::VectorXd y_, v_, tau_, ddtheta_, slides_;
  std::vector<int> blocks_;
  std::vector<Eigen::Index> block_begins_;
};

}  // namespace hg::identify::friction
