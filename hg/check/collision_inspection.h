/// Pairs of a device that are watched for collisions, and pairs that are not, in one line.
#pragma once

#include "hg/check/findings.h"
#include "hg/config/device.h"
#include "hg/workspace/survey.h"

namespace hg::check {

/// Adds a note, warnings where parts of the device move unwatched, and one for each pair of parts
/// that touch in the device's posture.
void inspect_collisions(const config::DeviceConfig& device, Collector& out);

/// Adds findings on a floor above all places of the handle, or one that contains a part of the
/// device in all postures.
void inspect_floor(const config::DeviceConfig& device, const workspace::Survey& survey,
                   Collector& out);

}  // namespace hg::check
