/// The catalogue of all limits of a device and a twin: the order of the rows of tasks 2 to 6.
#pragma once

#include "hg/rendering/device_model.h"
#include "hg/rendering/twin_model.h"
#include "hg/signals/limit.h"

namespace hg::rendering {

/// Manipulator joints, virtual joints, x y z of each Cartesian frame, then one entry per degree of
/// freedom of the twin. Quantities without limits are listed, too: their range is unbounded.
LimitCatalogue make_catalogue(const DeviceModel& device, const TwinModel& twin);

}  // namespace hg::rendering
