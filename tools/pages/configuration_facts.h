/// Keys of all configuration files, from their descriptions in hg/config, for
/// docs/reference/configuration.md.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hg::pages {

/// Per file its keys: rows of key, default, allowed values and meaning.
nlohmann::ordered_json configuration_facts();

}  // namespace hg::pages
