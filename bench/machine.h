/// What figures have to be read with: when, on what, and from which sources they were measured.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hg::bench {

/// date (UTC), cpu, cores, compiler, flags, commit.
nlohmann::ordered_json describe_machine();

}  // namespace hg::bench
