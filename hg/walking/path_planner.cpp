#include "hg/walking/path_planner.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hg::walking {
namespace {

using Vector5 = PathState;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr double kBendWeight = 50.0;  // on the square of a bend beyond the largest one
constexpr double kStepShrink = 0.5;

double positive(double x) noexcept { return std::max(x, 0.0); }

// Heading in the middle of a step, where the position is moved.
double middle_heading(const Vector5& x, double turn, double h) noexcept {
  return x[2] + 0.5 * turn + 0.5 * h * x[3] + 0.125 * h * h * x[4];
}

}  // namespace

PathState moved(const PathState& x, double j, double turn, double h) noexcept {
  const double phi = middle_heading(x, turn, h);
  return {x[0] + h * std::cos(phi), x[1] + h * std::sin(phi),
          x[2] + turn + h * (x[3] + 0.5 * h * x[4]), x[3] + h * (x[4] + 0.5 * h * j), x[4] + h * j};
}

double path_cost(const PlannerConfig& config, const PathState& x, double j) noexcept {
  double cost = x[3] * x[3] + config.slope_weight * x[4] * x[4] + config.control_weight * j * j +
                kBendWeight * std::pow(positive(std::abs(x[3]) - config.largest_bend), 2);
  for (int i = 0; i < 2; ++i) {
    for (const double clearance : {x[i] - config.room.lower[i], config.room.upper[i] - x[i]}) {
      cost += config.margin_weight * std::pow(positive(config.margin - clearance), 2) +
              config.wall_weight * std::pow(positive(-clearance), 2);
    }
  }
  return 0.5 * PathPlanner::kStep * cost;
}

// Derivatives of path_cost() by the state.
void PathPlanner::expand(const PathState& x, PathState& slope, Matrix5& curvature) const noexcept {
  slope.setZero();
  curvature.setZero();
  slope[3] = x[3];
  curvature(3, 3) = 1.0;
  const double beyond = positive(std::abs(x[3]) - config_.largest_bend);
  if (beyond > 0.0) {
    slope[3] += std::copysign(kBendWeight * beyond, x[3]);
    curvature(3, 3) += kBendWeight;
  }
  slope[4] = config_.slope_weight * x[4];
  curvature(4, 4) = config_.slope_weight;
  for (int i = 0; i < 2; ++i) {
    for (const double side : {-1.0, 1.0}) {
      const double clearance =
          side < 0.0 ? x[i] - config_.room.lower[i] : config_.room.upper[i] - x[i];
      for (const auto& [least, weight] : {std::pair(config_.margin, config_.margin_weight),
                                          std::pair(0.0, config_.wall_weight)}) {
        if (clearance >= least) continue;
        slope[i] += side * weight * (least - clearance);
        curvature(i, i) += weight;
      }
    }
  }
  slope *= kStep;
  curvature *= kStep;
}

void PathPlanner::roll(const PathState& state, const Turns& turns, Candidate& candidate) noexcept {
  candidate.states[0] = state;
  candidate.cost = 0.0;
  for (int k = 0; k < kSteps; ++k) {
    candidate.cost += path_cost(config_, candidate.states[k], candidate.controls[k]);
    candidate.states[k + 1] = moved(candidate.states[k], candidate.controls[k], turns[k], kStep);
  }
  candidate.cost += path_cost(config_, candidate.states[kSteps], 0.0);
}

// Controls that lead u to a value within a few steps and keep it there.
void PathPlanner::bend_to(double u, const PathState& state, const Turns& turns,
                          Candidate& candidate) noexcept {
  constexpr double kRate = 5.0;  // 1/m
  PathState x = state;
  for (int k = 0; k < kSteps; ++k) {
    candidate.controls[k] = kRate * kRate * (u - x[3]) - 2.0 * kRate * x[4];
    x = moved(x, candidate.controls[k], turns[k], kStep);
  }
  roll(state, turns, candidate);
}

void PathPlanner::backward(const Turns& turns, const Candidate& candidate,
                           double damping) noexcept {
  const double h = kStep;
  const Vector5 B(0.0, 0.0, 0.0, 0.5 * h * h, h);
  Vector5 slope, value_slope;
  Matrix5 curvature, value;
  expand(candidate.states[kSteps], value_slope, value);
  for (int k = kSteps - 1; k >= 0; --k) {
    const Vector5& x = candidate.states[k];
    const double phi = middle_heading(x, turns[k], h);
    const Vector5 of_phi(0.0, 0.0, 1.0, 0.5 * h, 0.125 * h * h);
    Matrix5 A = Matrix5::Identity();
    A.row(0) -= h * std::sin(phi) * of_phi.transpose();
    A.row(1) += h * std::cos(phi) * of_phi.transpose();
    A(2, 3) = A(3, 4) = h;
    A(2, 4) = 0.5 * h * h;
    expand(x, slope, curvature);
    // the motion is curved in phi; what would make the problem concave is left out
    const double bent = -h * (std::cos(phi) * value_slope[0] + std::sin(phi) * value_slope[1]);
    curvature += positive(bent) * of_phi * of_phi.transpose();
    const Eigen::Matrix<double, 1, 5> V_B = B.transpose() * value;
    const double of_j = h * config_.control_weight * candidate.controls[k] + B.dot(value_slope);
    const double of_jj = h * config_.control_weight + V_B.dot(B) + damping;
    const Eigen::Matrix<double, 1, 5> of_jx = V_B * A;
    gains_.offset[k] = -of_j / of_jj;
    gains_.feedback[k] = -of_jx / of_jj;
    value_slope = slope + A.transpose() * value_slope + gains_.offset[k] * of_jx.transpose();
    value = curvature + A.transpose() * value * A + of_jx.transpose() * gains_.feedback[k];
    value = (0.5 * (value + value.transpose())).eval();
  }
}

// Takes the longest step that lowers the cost; false if there is none.
bool PathPlanner::forward(const Turns& turns, Candidate& candidate) noexcept {
  for (double share = 1.0; share > 0.02; share *= kStepShrink) {
    other_.states[0] = candidate.states[0];
    other_.cost = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      other_.controls[k] = candidate.controls[k] + share * gains_.offset[k] +
                           gains_.feedback[k].dot(other_.states[k] - candidate.states[k]);
      other_.cost += path_cost(config_, other_.states[k], other_.controls[k]);
      other_.states[k + 1] = moved(other_.states[k], other_.controls[k], turns[k], kStep);
    }
    other_.cost += path_cost(config_, other_.states[kSteps], 0.0);
    if (other_.cost < candidate.cost) {
      std::swap(candidate, other_);
      return true;
    }
  }
  return false;
}

void PathPlanner::improve(const Turns& turns, int iterations, Candidate& candidate) noexcept {
  constexpr double kEnough = 1e-4;  // share of the cost
  double damping = 1e-9;
  for (int i = 0; i < iterations; ++i) {
    const double before = candidate.cost;
    backward(turns, candidate, damping);
    if (forward(turns, candidate)) {
      if (before - candidate.cost < kEnough * before) return;
      damping = std::max(1e-9, 0.3 * damping);
    } else {
      damping *= 10.0;
      if (damping > 1e-3) return;
    }
  }
}

void PathPlanner::plan(const PathState& state, const Turns& turns, int walked) noexcept {
  constexpr int kFromLast = 6, kFromNothing = 12;
  Candidate best;
  for (int k = 0; k + walked < kSteps; ++k) best.controls[k] = best_.controls[k + walked];
  roll(state, turns, best);
  improve(turns, kFromLast, best);
  for (const double u : {1.2, -1.2, 4.0, -4.0}) {
    bend_to(u, state, turns, tried_);
    improve(turns, kFromNothing, tried_);
    if (tried_.cost < best.cost) best = tried_;
  }
  best_ = best;
}

double PathPlanner::control(double s) const noexcept {
  return best_.controls[std::clamp(static_cast<int>(s / kStep), 0, kSteps - 1)];
}

}  // namespace hg::walking
