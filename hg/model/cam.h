/// Cams: a joint whose position is a smooth function of that of another joint, through points.
///
/// Between the points the function is a cubic spline: continuous with slope and curvature. Where it
/// repeats it is so from the last point to the first of the next turn, too; where it does not, it
/// ends without curvature and continues straight.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hg/core/interval.h"
#include "hg/model/coupling_curve.h"

namespace hg::model {

/// Where the joint that follows is while its leader is at `leader`; rad or m.
struct CamPoint {
  double leader = 0.0;
  double follower = 0.0;
};

inline constexpr int kMaxCamPoints = 200;

/// What is wrong with the points of a cam; empty = nothing. `period` is the distance of the leader
/// after which they begin again, infinite = they do not.
std::string cam_fault(const std::vector<CamPoint>& points, double period = kInfinity);

struct Cam {
  std::shared_ptr<const CouplingCurve> curve;
  Interval travel;  ///< Of the joint that follows, rad or m
};

/// The cam through these points. Points at equal distances are met exactly, others within 1e-5 of
/// the travel. Throws SetupError with cam_fault().
Cam make_cam(const std::vector<CamPoint>& points, double period = kInfinity);

}  // namespace hg::model
