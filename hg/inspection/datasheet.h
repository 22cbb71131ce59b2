/// The figures of a device that one would look for in a datasheet, from its model and a survey.
#pragma once

#include <string>
#include <vector>

#include "hg/config/device.h"
#include "hg/inspection/stopping_rule.h"
#include "hg/inspection/survey.h"
#include "hg/inspection/workspace.h"

namespace hg::inspection {

struct JointLine {
  std::string name;
  bool is_angle = true;  ///< rad and Nm, otherwise m and N
  bool is_gantry = false;
  Interval range;
  double dq_max = kInfinity, ddq_max = kInfinity;
  double effort_max = kInfinity;  ///< of the URDF; infinite = not given
  double gravity_max = 0.0;       ///< to hold the device itself, at rest
};

/// Over the postures of the survey.
struct Distribution {
  double smallest = 0.0;
  double low = 0.0;  ///< 5 % are below
  double median = 0.0;
};

/// The joint that most often is the one that limits, and how often.
struct Bottleneck {
  std::string joint;
  double share = 0.0;
};

struct Bandwidth {
  double rate_Hz = 0.0;
  double synchronisation_Hz = 0.0;  ///< of (11), sqrt(kP) / (2 pi)
  double gantry_Hz = 0.0;           ///< of (27), k_ppu / (2 pi)
  double drive_Hz = 0.0;            ///< of the gantry's drive, 1 / (2 pi lag)
  double wrench_delay_s = 0.0;      ///< of the user's wrench behind the sensor, by its low-pass
};

struct Datasheet {
  std::string name;
  SurveyOptions options;
  int postures = 0;               ///< that the percentiles are of
  double share_in_boxes = 0.0;    ///< of the postures that the joint limits permit
  std::vector<JointLine> joints;  ///< gantry first
  double reach = 0.0;             ///< m, handle from the axis of the arm's first joint; 0 = no axis
  Workspace workspace;
  bool has_ratings = false;  ///< some joint has a torque rating
  Distribution force;        ///< N, in the worst direction
  Distribution torque;       ///< Nm, in the worst direction
  Bottleneck force_bottleneck, torque_bottleneck;
  double share_paper_wrench = 0.0;  ///< postures that give 50 N and 10 Nm at once, [HG] III-B
  Distribution acceleration;        ///< m/s^2, of the handle in the worst direction
  Bottleneck acceleration_bottleneck;
  double free_body_mass = 0.0;  ///< kg that the low force moves with the low acceleration
  double length = 1.0;          ///< m, that scales the Jacobian
  Distribution singular_value;  ///< smallest, of the scaled Jacobian
  double condition_median = 0.0, condition_high = 0.0;  ///< 95 % are below the second
  Posture most_singular;
  Bandwidth bandwidth;
  std::vector<Stopping> stopping;  ///< gantry first
  double stop_time = 0.0;          ///< s, stated
};

Datasheet make_datasheet(const config::Device& device, const Survey& survey);

}  // namespace hg::inspection
