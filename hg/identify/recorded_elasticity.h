/// Elasticity of the joints and delay of the drives of a device from a recording of its motion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hg/identify/drive_delay.h"
#include "hg/identify/joint_elasticity.h"
#include "hg/identify/joint_recording.h"

namespace hg::identify {

struct IdentifiedJoint {
  std::string name;
  JointElasticity elasticity;  ///< empty where RecordedElasticity::has_both_sides is false
  ActuatorModel nominal;       ///< as the files of the device say
  DriveDelay delay;            ///< empty where RecordedElasticity::follows_positions is false
};

struct RecordedElasticity {
  std::vector<recording::Loss> losses;  ///< damaged parts of the recording
  double used_s = 0.0;                  ///< time with the drives on, s
  bool has_both_sides = false;          ///< joints, motors and joint torques are in the recording
  bool follows_positions = false;       ///< the drives follow commanded positions
  std::vector<IdentifiedJoint> joints;
  Figure delay;  ///< of all drives together, s
  /// `latency_s` of a simulation with that delay, s: without the period at whose end a command asks
  /// for its position, and the step by which the simulated drives look ahead
  Figure latency;
  double nominal_delay = 0.0, nominal_latency = 0.0;  ///< as the simulation file says, s
};

/// Identifies what the recording shows; `device` empty = the one that it was made with. Throws
/// SetupError, also where the device reports too little for either.
RecordedElasticity identify_recorded_elasticity(
    const std::string& file, std::optional<config::SimulatedDeviceConfig> device);

}  // namespace hg::identify
