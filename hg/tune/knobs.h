/// Parameters of a device that `tune` changes, named as in its file.
#pragma once

#include <span>
#include <string_view>

#include "hg/handle_loop/handle_loop.h"

namespace hg::tune {

using handle_loop::LoopDevice;

struct Knob {
  std::string_view section, key;   ///< section and key in device.yaml
  double least = 0.0, most = 0.0;  ///< range of the search
  double (*get)(const LoopDevice&);
  void (*set)(LoopDevice&, double);
};

std::span<const Knob> knobs();

/// One value per knob.
using Values = Eigen::VectorXd;

Values values_of(const LoopDevice& device);
/// The device with these values; values outside the search range are clamped.
LoopDevice with_values(LoopDevice device, const Values& values);

/// Normalised values within the range of each knob, 0 to 1, logarithmic where the range is, and
/// back.
Eigen::VectorXd place_of(const Values& values);
Values values_at(const Eigen::VectorXd& place);

}  // namespace hg::tune
