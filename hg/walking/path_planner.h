/// Path transformation of motion compression: the path in the room that has the length and the
/// turns of a predicted path and deviates from its curvature as little as possible.
///
/// Source: [Nitzsche, Hanebeck, Schmidt 2004], path transformation. Heading phi, deviation of
/// curvature u, its slope w along the way s, and the control j:
///     x' = cos phi,  y' = sin phi,  phi' = kappa(s) + u,  u' = w,  w' = j,
/// with kappa the curvature of the predicted path. The cost is the integral of u^2, of small
/// weights on w^2 and j^2, and of what is nearer to a wall than `margin`: a person who turns there
/// without notice needs room to be led away. So u has a continuous slope, and with a person's
/// velocity the transformation a continuous second derivative. Solved by differential dynamic
/// programming over a horizon, from the last plan and from bends to either side. No allocation
/// after set-up.
#pragma once

#include <Eigen/Core>
#include <array>

#include "hg/walking/rectangle.h"

namespace hg::walking {

struct PlannerConfig {
  Rectangle room;                ///< where the path may be
  double margin = 0.9;           ///< m
  double margin_weight = 20.0;   ///< 1/m^4, on the square of what is nearer
  double wall_weight = 300.0;    ///< 1/m^4, on the square of what is beyond the room
  double largest_bend = 8.0;     ///< u beyond it costs much, 1/m
  double slope_weight = 2e-3;    ///< on w^2, m^2
  double control_weight = 4e-7;  ///< on j^2, m^4
};

/// State of a path in the room: x, y (m), phi (rad), u (1/m), w (1/m^2).
using PathState = Eigen::Matrix<double, 5, 1>;

class PathPlanner {
 public:
  static constexpr int kSteps = 40;
  static constexpr double kStep = 0.1;          ///< m
  using Turns = std::array<double, kSteps>;     ///< of the predicted path in each step, rad
  using Controls = std::array<double, kSteps>;  ///< j, 1/m^3

  explicit PathPlanner(const PlannerConfig& config) : config_(config) {}

  /// Plans from a state; the last plan, moved on by `walked` steps, is where it begins.
  void plan(const PathState& state, const Turns& turns, int walked) noexcept;

  /// Control at the distance s from the state of the last plan.
  double control(double s) const noexcept;
  double cost() const noexcept { return best_.cost; }
  const PathState& state(int step) const noexcept { return best_.states[step]; }

 private:
  struct Candidate {
    Controls controls{};
    std::array<PathState, kSteps + 1> states;
    double cost = 0.0;
  };
  struct Gains {
    std::array<double, kSteps> offset;
    std::array<Eigen::Matrix<double, 1, 5>, kSteps> feedback;
  };

  void bend_to(double u, const PathState& state, const Turns& turns, Candidate& candidate) noexcept;
  void roll(const PathState& state, const Turns& turns, Candidate& candidate) noexcept;
  void improve(const Turns& turns, int iterations, Candidate& candidate) noexcept;
  void backward(const Turns& turns, const Candidate& candidate, double damping) noexcept;
  bool forward(const Turns& turns, Candidate& candidate) noexcept;
  void expand(const PathState& x, PathState& slope,
              Eigen::Matrix<double, 5, 5>& curvature) const noexcept;

  PlannerConfig config_;
  Candidate best_, tried_, other_;
  Gains gains_;
};

/// Cost of a step from the state x.
double path_cost(const PlannerConfig& config, const PathState& x, double j) noexcept;

/// The state after a way of length h along which the predicted path turns by `turn`.
PathState moved(const PathState& x, double j, double turn, double h) noexcept;

}  // namespace hg::walking
