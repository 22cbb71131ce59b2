/// The results of a search as JSON, for the report.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "hg/design/design_problem.h"

namespace hg::search {

/// Variables by name, with names of sizes and ratios.
nlohmann::ordered_json to_json(const design::DesignProblem& problem,
                               const design::DesignVariables& variables);

/// Terms, capability, burdens and metrics; not finite values are null.
nlohmann::ordered_json to_json(const design::DesignScore& score);

/// What one percent more of each length, and one step of each size and ratio, changes.
nlohmann::ordered_json sensitivity(const design::DesignProblem& problem, const design::Judge& judge,
                                   const design::DesignVariables& variables);

/// Each pose of the hand in the frame of the person, and how it is served.
nlohmann::ordered_json coverage(const design::Judge& judge, const design::DesignScore& score);

}  // namespace hg::search
