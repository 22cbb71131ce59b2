/// What is wrong with a device, or will surprise: gains, limits, box, singularities, ratings.
#pragma once

#include "hg/config/device.h"
#include "hg/inspection/findings.h"
#include "hg/inspection/survey.h"

namespace hg::inspection {

/// All findings, in no particular order.
Findings inspect(const config::Device& device, const Survey& survey);

/// Largest eigenvalue, in magnitude, of (11) in discrete time: e'' = -kD e' - kP e with the
/// acceleration held over dt. Below 1 the handle comes to the twin.
double synchronisation_pole(double kP, double kD, double dt);

}  // namespace hg::inspection
