/// Set-up data of the reaction to contacts of the arm.
#pragma once

namespace hg::compliance {

/// Set-up data.
struct ComplianceConfig {
  bool is_on = false;
};

}  // namespace hg::compliance
