/// Poses for payload identification: chosen for a device, and measured on its simulation.
#pragma once

#include <vector>

#include "hg/config/simulation/simulation.h"
#include "hg/core/types.h"
#include "hg/identify/payload.h"

namespace hg::identify {

/// `count` postures of the manipulator within all limits, gantry at 0: as different as possible in
/// the direction of gravity in the sensor. The same for the same device; fewer when it has fewer.
std::vector<VectorM> static_postures(const config::DeviceConfig& device, int count);

/// Measurement of the simulated device at rest in such a posture, brakes closed, handle free: the
/// mean over a second, a second after the start.
StaticPose measure_simulated(const config::SimulatedDeviceConfig& device, const VectorM& q_m);

/// Reads one pose per row of a CSV text; rows with the same value in a column `pose` are averaged.
/// Columns by name, in any order: a_x a_y a_z (acceleration minus gravity, m/s^2), f_x f_y f_z (N),
/// n_x n_y n_z (Nm), all in S. Throws SetupError with `name`:line and the fault.
std::vector<StaticPose> read_static_poses(const std::string& name, const std::string& text);

}  // namespace hg::identify
