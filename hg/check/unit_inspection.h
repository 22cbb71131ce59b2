/// Numbers of a file that can only be in another unit: angles in degrees, lengths in millimetres,
/// masses in grams. What needs the whole device or twin is in unit_comparison.h.
#pragma once

#include <string>
#include <vector>

#include "hg/check/findings.h"
#include "hg/model/chain_model.h"

namespace hg::check {

/// Adds a warning per such number of the URDFs and YAML files among `sources`. Of a URDF only the
/// joints with these names count; without names all.
void inspect_units(const std::vector<config::SourceText>& sources,
                   const std::vector<std::string>& joints, Collector& out);

/// Names of the joints of a chain that move, also of those that follow others.
std::vector<std::string> joint_names(const model::ChainModel& chain);

}  // namespace hg::check
