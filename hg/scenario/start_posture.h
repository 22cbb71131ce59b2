/// Start of a run: the twin at its start, the device with its handle there.
#pragma once

#include <string>
#include <utility>

#include "hg/config/device.h"
#include "hg/config/twin.h"
#include "hg/controller/rendering/twin_model.h"
#include "hg/core/error.h"
#include "hg/core/types.h"

namespace hg::scenario {

struct Start {
  Pose T_B_H;   ///< pose of the handle = end effector of the twin at its start
  VectorP q_p;  ///< gantry positions
  VectorM q_m;  ///< manipulator positions
};

/// A device that cannot be where a twin starts. The message has advice for the author of the files;
/// `why` is what is in the way, for people who only choose among them.
struct StartError : SetupError {
  StartError(const std::string& message, const config::DeviceConfig& of_device,
             const config::Twin& of_twin, std::string reason)
      : SetupError(message), device(of_device.name), twin(of_twin.name), why(std::move(reason)) {}
  std::string device, twin;  ///< their names
  std::string why;
};

/// Pose of the twin's end effector at its start.
Pose handle_start(const rendering::TwinModel& twin);

/// The device in its best posture with the handle where the twin's end effector starts. Throws
/// StartError with a suggested change when the device cannot be there within its limits and above
/// its floor.
Start find_start(const config::DeviceConfig& device, const config::Twin& twin);

}  // namespace hg::scenario
