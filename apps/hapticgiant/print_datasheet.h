/// The datasheet of a device, for people and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hg/commissioning/checks/datasheet.h"

namespace hg::apps {

void print_datasheet(const checks::Datasheet& sheet);
/// SI units; the keys carry them.
nlohmann::json datasheet_json(const checks::Datasheet& sheet);

}  // namespace hg::apps
