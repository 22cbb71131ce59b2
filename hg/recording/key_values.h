/// Names and texts, as in a metadata record of a recording.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hg::recording {

using KeyValues = std::vector<std::pair<std::string, std::string>>;

}  // namespace hg::recording
