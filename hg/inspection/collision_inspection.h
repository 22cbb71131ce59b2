/// Which pairs of a device are watched for collisions, and which are not, in one line.
#pragma once

#include "hg/config/device.h"
#include "hg/inspection/findings.h"
#include "hg/inspection/survey.h"

namespace hg::inspection {

/// One finding: a note, or a warning where parts of the device move unwatched.
void inspect_collisions(const config::Device& device, Collector& out);

/// A floor above all places of the handle, or that holds a part of the device wherever it moves.
void inspect_floor(const config::Device& device, const Survey& survey, Collector& out);

}  // namespace hg::inspection
