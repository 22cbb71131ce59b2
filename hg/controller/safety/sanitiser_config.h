/// Set-up data of the last check of the command.
#pragma once

namespace hg::safety {

/// Set-up data.
struct SanitiserConfig {
  bool is_strict = false;      ///< Cuts to 0 instead of to the holding torque
  double margin = 5e-3;        ///< Margin beyond the limit of a revolute joint, rad
  double slide_margin = 5e-3;  ///< Margin beyond the limit of a prismatic joint, m
  /// Rise time from zero to peak torque, s; slower would alter valid commands.
  double torque_rise = 3e-4;
};

}  // namespace hg::safety
