/// Random starts of an arm, and for each a push of the hand that leads out of what is in its way.
///
/// Starts inside the ranges; on limits, 1e-6 to 20e-3 rad or m beyond them, or in front of them
/// with a push towards them; in singular postures and as near to them; at the faces of the box;
/// within the safe distance of the arm's own parts. A push W = M J dq, with dq away from all of
/// these, is what a hand does to move the free twin with mass matrix M by J dq. Set-up only:
/// allocates.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/safety/collision/nearest.h"
#include "hg/core/random.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/start_posture.h"

namespace hg {

enum class StartKind {
  kInside,
  kOnLimits,
  kBeyondLimits,
  kPushedOut,
  kSingular,
  kNearSingular,
  kSingularBeyond,
  kBeyondBox,
  kNearParts,
};
inline constexpr int kStartKinds = 9;
std::string_view to_string(StartKind kind);

/// Mass and inertia of the free twin of every start; its handle is at its centre of mass.
inline constexpr double kTwinMass = 6.0, kTwinInertia = 0.06;

struct DrawnStart {
  config::Scenario scenario;  ///< With the limits and the twin's start of this one
  scenario::Start start;
  Vector6 push;                    ///< Wrench on the handle that leads out, at H, resolved in B
  bool is_pushed_out = false;      ///< Pushed the other way before
  std::string place;               ///< What it is at or beyond
  double smallest_singular = 0.0;  ///< Of the handle's Jacobian, rotations at 0.3 m, m
};

class StartDraw {
 public:
  /// `arm`: a scenario of a free twin on the arm; must outlive this.
  StartDraw(const config::Scenario& arm, std::uint64_t seed);

  /// A start of this kind; none where none is found, as at the end of a joint without ends.
  std::optional<DrawnStart> draw(StartKind kind);

 private:
  struct Row {
    Eigen::VectorXd gradient;  // of what may only grow, by the joints
  };

  double sample_size();
  double smallest_singular(const Eigen::VectorXd& q);
  double distance(const Eigen::VectorXd& q);
  void widen_limits();
  Eigen::VectorXd inside();
  bool go_to_singular(Eigen::VectorXd& q);
  bool place_at_limits(StartKind kind, Eigen::VectorXd& q);
  void fit_limit(Eigen::VectorXd& q);
  void fit_box(const Eigen::VectorXd& q);
  bool go_near_parts(Eigen::VectorXd& q);
  bool is_permitted(StartKind kind, const Eigen::VectorXd& q);
  bool keep_away(const Eigen::VectorXd& q);
  std::optional<Vector6> push_out(const Eigen::VectorXd& q);
  std::optional<DrawnStart> attempt(StartKind kind);

  const config::Scenario& arm_;
  Random random_;
  model::ChainData chain_;
  collision::Nearest parts_;
  config::Scenario scenario_;
  std::vector<Row> rows_;  // away from what the start is at
  std::string place_;
};

}  // namespace hg
