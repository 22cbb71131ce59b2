/// What tune changes of a device, as its file calls it.
#pragma once

#include <span>
#include <string_view>

#include "hg/tuning/handle_loop.h"

namespace hg::tuning {

struct Knob {
  std::string_view section, key;   ///< of device.yaml
  double least = 0.0, most = 0.0;  ///< of the search
  double (*get)(const Device&);
  void (*set)(Device&, double);
};

std::span<const Knob> knobs();

/// One value per knob.
using Values = Eigen::VectorXd;

Values values_of(const Device& device);
/// Values out of the search's range come to its end.
Device with_values(Device device, const Values& values);

/// Places of values within the range of each knob, 0 to 1 and on a logarithmic axis where the range
/// has one, and back.
Eigen::VectorXd place_of(const Values& values);
Values values_at(const Eigen::VectorXd& place);

}  // namespace hg::tuning
