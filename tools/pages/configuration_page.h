/// Writes docs/reference/configuration.md, the reference of all configuration files, from their
/// descriptions in hg/config.
#pragma once

#include <string>

namespace hg::pages {

std::string configuration_page();

}  // namespace hg::pages
