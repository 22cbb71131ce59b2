/// The numbers of a YAML text with their places, whatever kind of file it is.
#pragma once

#include <string>
#include <vector>

#include "hg/config/sources.h"

namespace hg::config {

struct YamlNumber {
  std::string item;  ///< path of its key, "joints.m1.q_max_rad" or "payload.centre_of_mass_m[2]"
  std::string key;   ///< the innermost key, "q_max_rad" or "centre_of_mass_m"
  Place place;
  double value = 0.0;
};

/// All finite numbers, in the order of the text; none if it is not YAML.
std::vector<YamlNumber> numbers_in(const std::string& text);

}  // namespace hg::config
