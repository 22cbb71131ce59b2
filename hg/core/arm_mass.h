/// Effective mass of a person's arm at the hand.
#pragma once

namespace hg {

/// Effective mass of a gripping hand with its arm, [HANDBOOK] 5.1: left-right and vertical, kg.
inline constexpr double kArmMass = 1.5;

}  // namespace hg
