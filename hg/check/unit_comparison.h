/// Numbers of a device or twin that do not fit each other by a factor that only another unit
/// explains: efforts and weights, speeds and accelerations, springs and friction.
#pragma once

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/config/twin.h"
#include "hg/workspace/survey.h"

namespace hg::check {

void compare_units(const config::DeviceConfig& device, const workspace::Survey& survey,
                   Collector& out);
/// `mass` is the smallest that a hand moves in any direction, kg; infinite: none. It is not doubted
/// once more where `out` has a doubt of the mass of a free body.
void compare_units(const config::Twin& twin, double mass, Collector& out);

/// "; suspected masses in grams" or the unit of the rating, where a joint needs `need` Nm to hold
/// the device and its rating is `rating`; empty without any.
std::string doubt_of_weight(double need, double rating);

}  // namespace hg::check
