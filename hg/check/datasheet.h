/// Datasheet figures of a device, from its model and a survey.
#pragma once

#include <string>
#include <vector>

#include "hg/check/stopping_rule.h"
#include "hg/check/wall_force.h"
#include "hg/config/device.h"
#include "hg/workspace/survey.h"
#include "hg/workspace/workspace.h"

namespace hg::check {

struct JointLine {
  std::string name;
  bool is_angle = true;  ///< units are rad and Nm, otherwise m and N
  bool is_gantry = false;
  Interval range;
  double dq_max = kInfinity, ddq_max = kInfinity;
  double effort_max = kInfinity;  ///< effort limit of the URDF; infinite = not given
  double gravity_max = 0.0;       ///< largest effort to hold the device itself, at rest
};

/// Distribution over the postures of the survey.
struct Distribution {
  double smallest = 0.0;
  double low = 0.0;  ///< 5th percentile
  double median = 0.0;
};

/// The most often limiting joint, and how often it limits.
struct Bottleneck {
  std::string joint;
  double share = 0.0;
};

struct Bandwidth {
  double rate_Hz = 0.0;
  double synchronisation_Hz = 0.0;  ///< bandwidth of (11), sqrt(kP) / (2 pi)
  double gantry_Hz = 0.0;           ///< bandwidth of (27), k_ppu / (2 pi)
  double drive_Hz = 0.0;            ///< bandwidth of the gantry's drive, 1 / (2 pi lag)
  double wrench_delay_s = 0.0;  ///< delay of the user's wrench behind the sensor, by its low-pass
};

struct Datasheet {
  std::string name;
  workspace::SurveyOptions options;
  int postures = 0;  ///< number of postures of the percentiles
  /// Share of the postures within the joint limits that also are within the boxes
  double share_in_boxes = 0.0;
  std::vector<JointLine> joints;  ///< line per joint, gantry first
  /// Distance of the handle from the axis of the arm's first joint, m; 0 = no axis
  double reach = 0.0;
  workspace::HandleWorkspace workspace;
  bool has_ratings = false;          ///< every joint has a torque rating
  std::vector<std::string> unrated;  ///< joints without a torque rating
  Distribution force;                ///< force in the worst direction, N
  Distribution torque;               ///< torque in the worst direction, Nm
  Bottleneck force_bottleneck, torque_bottleneck;
  /// Share of postures that provide 50 N and 10 Nm at once, [HG] III-B
  double share_paper_wrench = 0.0;
  Distribution acceleration;  ///< acceleration of the handle in the worst direction, m/s^2
  Bottleneck acceleration_bottleneck;
  double free_body_mass = 0.0;  ///< mass moved by the low force with the low acceleration, kg
  double length = 1.0;          ///< length that scales the Jacobian, m
  Distribution singular_value;  ///< smallest singular value of the scaled Jacobian
  /// Median and 95th percentile of the condition number
  double condition_median = 0.0, condition_high = 0.0;
  workspace::Posture most_singular;
  Bandwidth bandwidth;
  std::vector<Stopping> stopping;  ///< stopping per axis, gantry first
  double stop_time = 0.0;          ///< stated stopping time, s
  std::vector<WallForce> walls;    ///< What the motors hold at the walls of the handle's box
};

Datasheet make_datasheet(const config::DeviceConfig& device, const workspace::Survey& survey);

}  // namespace hg::check
