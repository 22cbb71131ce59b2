/// Faults and notable properties of a device: gains, limits, box, singularities, ratings.
#pragma once

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/workspace/survey.h"

namespace hg::check {

/// Inspects a device; all findings, in no particular order.
Findings inspect(const config::DeviceConfig& device, const workspace::Survey& survey);

/// Largest eigenvalue, in magnitude, of (11) in discrete time: e'' = -kD e' - kP e with the
/// acceleration held over dt. Below 1 the handle converges to the twin.
double synchronisation_pole(double kP, double kD, double dt);

}  // namespace hg::check
