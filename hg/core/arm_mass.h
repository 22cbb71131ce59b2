/// What a person's arm weighs at the hand.
#pragma once

namespace hg {

/// Effective mass of a hand and an arm that hold on, [HANDBOOK] 5.1: left-right and vertical, kg.
inline constexpr double kArmMass = 1.5;

}  // namespace hg
