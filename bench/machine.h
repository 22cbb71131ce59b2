/// Measurement conditions of figures: date, machine and sources.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hg::bench {

/// JSON with date (UTC), cpu, cores, compiler, flags, commit.
nlohmann::ordered_json describe_machine();

}  // namespace hg::bench
