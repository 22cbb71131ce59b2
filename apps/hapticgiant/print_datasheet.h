/// The datasheet of a device, for people and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hg/check/datasheet.h"

namespace hg::apps {

void print_datasheet(const check::Datasheet& sheet);
/// SI units; the keys carry them.
nlohmann::json datasheet_json(const check::Datasheet& sheet);

}  // namespace hg::apps
