/// The reference of all configuration files, docs/reference/configuration.md, from their
/// descriptions.
#pragma once

#include <string>

namespace hg::config {

std::string reference_page();

}  // namespace hg::config
