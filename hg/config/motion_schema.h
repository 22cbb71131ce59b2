/// Description of the law and of the gantry's motion in device.yaml.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "hg/config/device_draft.h"
#include "hg/config/law_names.h"
#include "hg/config/schema.h"

namespace hg::config {

inline constexpr JointKey kBrake = {"ddq_brake_rad_per_s2", "ddq_brake_m_per_s2"};

template <class V>
void describe(V& v, rendering::RenderingOptions& options, std::size_t manipulator_joints) {
  LawPreset law = LawPreset::kTogether;
  v.choice("law", law, kLawPresets,
           "preset of the law; paper and paper_bounds need six joints, see docs/concepts/law.md");
  set_parts(options, law);
  v.choice("bounds", options.bounds, kBounds,
           "for experiments, instead of the preset's: how limits become bounds on accelerations");
  v.choice("gantry", options.gantry, kGantries,
           "for experiments, instead of the preset's: what moves the gantry");
  v.choice("braking", options.braking, kBrakings,
           "for experiments, instead of the preset's: whether motors brake before each limit "
           "separately or before all that are near together");
  v.number("T_C_s", options.T_C, kPositive,
           "bounds paper: time within which virtual joints and frames return, at least a period");
  v.number("solver_budget", options.solver_budget, kCount,
           "active sets after which the solver of a cycle ends with what it has, all limits of the "
           "device kept; 0: it continues until its result is proven");
  v.rule(options.solver_budget == std::floor(options.solver_budget), "solver_budget",
         "must be a whole number", model::to_text(options.solver_budget));
  v.number("kP_posture_1_per_s2", options.kP_posture, kNotNegative,
           "of a seventh joint, towards its goal");
  v.number("kD_posture_1_per_s", options.kD_posture, kNotNegative, "of a seventh joint, damping");
  v.rule(options.law != rendering::Law::kPaper || manipulator_joints <= 6, "law",
         "the law of the paper needs six manipulator joints: use gauss");
}

template <class V>
void describe_prepositioning(V& v, DeviceDraft& d) {
  // values not given stay within the drive's limits
  d.device.prepositioning.dq_max =
      std::min(d.device.prepositioning.dq_max, d.device.model.drive.dq_max);
  d.device.prepositioning.ddq_max =
      std::min(d.device.prepositioning.ddq_max, d.device.model.drive.ddq_max);
  v.group(
      "prepositioning",
      [&](auto& child) {
        child.number("k_ppu_1_per_s", d.device.prepositioning.k_ppu, kPositive, "gain, eq. (27)");
        child.joint_number(kSpeed, d.gantry_unit, d.device.prepositioning.dq_max, kPositive,
                           "largest speed used, never above that of the drive");
        child.joint_number(
            kBrake, d.gantry_unit, d.device.prepositioning.ddq_max, kPositive,
            "deceleration that can be relied on, never above the drive's acceleration");
        child.rule(d.device.prepositioning.dq_max <= d.device.model.drive.dq_max,
                   kSpeed.of(d.gantry_unit),
                   "must not exceed the speed of the drive, " +
                       model::to_text(d.device.model.drive.dq_max),
                   model::to_text(d.device.prepositioning.dq_max));
        child.rule(d.device.prepositioning.ddq_max <= d.device.model.drive.ddq_max,
                   kBrake.of(d.gantry_unit),
                   "must not exceed the acceleration of the drive, " +
                       model::to_text(d.device.model.drive.ddq_max),
                   model::to_text(d.device.prepositioning.ddq_max));
      },
      "how the gantry moves along with the hand");
}

}  // namespace hg::config
