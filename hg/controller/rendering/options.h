/// Parameters of the rendering law.
#pragma once

#include <cstdint>
#include <string_view>

namespace hg::rendering {

/// How limits become forces; docs/concepts/law.md.
enum class Law : std::uint8_t {
  kGauss,  ///< Gauss' principle of least constraint as the last level
  kPaper,  ///< [HG] (20)-(26) with constraint torques as unknowns; needs six manipulator joints
};

/// How limits become bounds on accelerations.
enum class Bounds : std::uint8_t {
  kRecoverable,  ///< bounds R
  kPaper,        ///< [HG]: A for joints, C for virtual joints and frames, B as levels of their own
};

/// Source of the gantry's motion.
enum class Gantry : std::uint8_t {
  kLaw,   ///< Law gauss: gantry accelerations are unknowns, the rule is their aim; else the rule
  kRule,  ///< [HG] (27)
};

/// Braking of the motors before limits of the device.
enum class Braking : std::uint8_t {
  kAlone,     ///< before each limit separately, with its rating
  kTogether,  ///< before all at once, where motors are known and bounds recoverable; else alone
};

constexpr std::string_view to_string(Law law) noexcept {
  switch (law) {
    case Law::kGauss:
      return "gauss";
    case Law::kPaper:
      return "paper";
  }
  return "";
}
constexpr std::string_view to_string(Bounds bounds) noexcept {
  switch (bounds) {
    case Bounds::kRecoverable:
      return "recoverable";
    case Bounds::kPaper:
      return "paper";
  }
  return "";
}
constexpr std::string_view to_string(Gantry gantry) noexcept {
  switch (gantry) {
    case Gantry::kLaw:
      return "law";
    case Gantry::kRule:
      return "rule";
  }
  return "";
}
constexpr std::string_view to_string(Braking braking) noexcept {
  switch (braking) {
    case Braking::kAlone:
      return "alone";
    case Braking::kTogether:
      return "together";
  }
  return "";
}

struct RenderingOptions {
  Law law = Law::kGauss;
  Bounds bounds = Bounds::kRecoverable;
  Gantry gantry = Gantry::kRule;
  Braking braking = Braking::kTogether;
  double T_C = 20e-3;    ///< horizon of bounds C, s; the period, as printed in (8), bounces
  double kP_tran = 400;  ///< synchronisation (11), 1/s^2; double pole at 20 rad/s with kD
  double kD_tran = 40;   ///< Synchronisation, translational damping, 1/s
  double kP_rot = 400;   ///< Synchronisation, rotational stiffness, 1/s^2
  double kD_rot = 40;    ///< Synchronisation, rotational damping, 1/s
  /// Stiffness of joints that the task leaves free, 1/s^2; double pole at 5 rad/s.
  double kP_posture = 25;
  double kD_posture = 10;  ///< Damping of joints that the task leaves free, 1/s
  int slow_solve = 100;    ///< active sets from which on a solve is kept; a warm start needs 1 or 2
  /// Active sets after which a solve is ended, with the device's limits kept; 0 = no budget.
  double solver_budget = 0;
};

}  // namespace hg::rendering
