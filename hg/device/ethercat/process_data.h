/// Between the process data of one slave and the frames of a device. No allocation, noexcept.
#pragma once

#include <cstdint>
#include <vector>

#include "hg/device/ethercat/machine.h"
#include "hg/signals/frames.h"

namespace hg::ethercat {

/// What is known of one slave in operation.
struct Station {
  std::vector<std::uint8_t> outputs, inputs;
  std::uint16_t status = 0;     ///< status word of a drive
  std::uint16_t error = 0;      ///< error code of a drive, fault of a sensor
  std::uint8_t mode_now = 0;    ///< mode of a drive; 0: not reported
  std::uint32_t samples = 0;    ///< counter of a sensor
  bool has_new_samples = true;  ///< it has counted on, or does not count
};

/// Takes what a slave reports into its station and into a frame with `n_p` gantry axes and `n_m`
/// joints.
void take_inputs(const Slave& slave, int n_p, int n_m, Station& station,
                 SensorFrame& frame) noexcept;

/// Commands to all slaves.
struct Orders {
  const CommandFrame* command = nullptr;  ///< null: none has come yet
  bool enables = false;                   ///< its targets are those of the drives
  bool opens_brakes = false;
  std::uint16_t control_word = 0;  ///< of this drive
};

/// Puts commands to a slave into its station. `last` is the last frame: a drive that is not
/// enabled is commanded to stay.
void put_outputs(const Slave& slave, int n_p, const Orders& orders, const SensorFrame& last,
                 Station& station) noexcept;

}  // namespace hg::ethercat
