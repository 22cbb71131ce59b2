/// Parameters of the rendering law.
#pragma once

#include <cstdint>
#include <string_view>

namespace hg::rendering {

/// How limits become forces; docs/law.md.
enum class Law : std::uint8_t {
  kGauss,  ///< Gauss' principle of least constraint as the last level
  kPaper,  ///< [HG] (20)-(26) with constraint torques as unknowns; needs six manipulator joints
};

/// How limits become bounds on accelerations.
enum class Bounds : std::uint8_t {
  kRecoverable,  ///< bounds R
  kPaper,        ///< [HG]: A for joints, C for virtual joints and frames, B as levels of their own
};

/// What moves the gantry.
enum class Gantry : std::uint8_t {
  kLaw,   ///< law gauss: its accelerations are unknowns with the rule as their aim; else the rule
  kRule,  ///< [HG] (27)
};

/// Before which limits of the device its motors brake.
enum class Braking : std::uint8_t {
  kAlone,     ///< before each by itself, with its rating
  kTogether,  ///< before all at once; where motors are known and bounds are recoverable, else alone
};

constexpr std::string_view to_string(Law law) noexcept {
  return law == Law::kPaper ? "paper" : "gauss";
}
constexpr std::string_view to_string(Bounds bounds) noexcept {
  return bounds == Bounds::kPaper ? "paper" : "recoverable";
}

constexpr std::string_view to_string(Gantry gantry) noexcept {
  return gantry == Gantry::kRule ? "rule" : "law";
}

constexpr std::string_view to_string(Braking braking) noexcept {
  return braking == Braking::kTogether ? "together" : "alone";
}

struct Options {
  Law law = Law::kGauss;
  Bounds bounds = Bounds::kRecoverable;
  Gantry gantry = Gantry::kRule;
  Braking braking = Braking::kAlone;
  double T_C = 20e-3;      ///< horizon of bounds C, s; the period, as printed in (8), bounces
  double dt = 1e-3;        ///< nominal period, s; integration uses it
  double kP_tran = 400;    ///< synchronisation (11), 1/s^2; double pole at 20 rad/s with kD
  double kD_tran = 40;     ///< 1/s
  double kP_rot = 400;     ///< 1/s^2
  double kD_rot = 40;      ///< 1/s
  double kP_posture = 25;  ///< of joints that the task leaves free, 1/s^2; double pole at 5 rad/s
  double kD_posture = 10;  ///< 1/s
  int slow_solve = 100;    ///< active sets from which on a solve is kept; a warm start needs 1 or 2
  /// Active sets after which a solve is ended, with the limits of the device kept; 0: none.
  double solver_budget = 0;
};

}  // namespace hg::rendering
