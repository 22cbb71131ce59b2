#include "hg/start_test/simulated_operator.h"

#include <array>
#include <cmath>

namespace hg::start_test {
namespace {

constexpr double kDelay = 0.3;  // s from a request to the action
constexpr double kReset = 0.2;  // s from the release of an input to the reset, which lasts as long
constexpr double kPush = 1.5;   // s in each direction
constexpr double kWay = 0.25;   // m beyond the handle
constexpr double kTwist = 2.0;  // rad

}  // namespace

void SimulatedOperator::prompt(Act act) noexcept {
  next_ = act;
  is_asked_ = true;
  next_s_ = -1.0;
}

void SimulatedOperator::begin(Act act) noexcept {
  act_ = act;
  switch (act) {
    case Act::kTurnKeyOn:
    case Act::kTurnKeyOff:
      panel_.override_key = act == Act::kTurnKeyOn;
      return;
    case Act::kEnterField:
    case Act::kLeaveField:
      panel_.person_in_field = act == Act::kEnterField;
      return;
    case Act::kPressStop:
    case Act::kReleaseStop:
      panel_.emergency_stop = act == Act::kPressStop;
      return;
    case Act::kLetGoOfSwitch:
    case Act::kHoldSwitch:
      panel_.operator_enable = act == Act::kHoldSwitch;
      return;
    case Act::kNone:
    case Act::kTakeHandle:
    case Act::kLetGoOfHandle:
    case Act::kLean:
      return;
  }
}

// One direction after the other, with a twist about it.
HandTarget SimulatedOperator::lean(double for_s) const noexcept {
  const auto turn = static_cast<int>(for_s / kPush) % 6;
  const double side = turn % 2 == 0 ? 1.0 : -1.0;
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(turn / 2);
  HandTarget target;
  target.active = target.turns = true;
  target.p_B = start_.p + side * kWay * axis;
  target.R_B = start_.R * Eigen::AngleAxisd(side * kTwist, axis).toRotationMatrix();
  return target;
}

void SimulatedOperator::operate(double time_s, const Pose& T_B_H, CommandFrame& command) noexcept {
  if (!has_seen_) start_ = T_B_H;
  has_seen_ = true;
  if (is_asked_ && next_s_ < 0.0) next_s_ = time_s + kDelay;
  if (is_asked_ && time_s >= next_s_) {
    is_asked_ = false;
    since_s_ = time_s;
    begin(next_);
  }
  const double for_s = time_s - since_s_;
  const bool presses_reset = act_ == Act::kReleaseStop || act_ == Act::kLeaveField ||
                             act_ == Act::kHoldSwitch || act_ == Act::kTurnKeyOff;
  panel_.reset = presses_reset && for_s > kReset && for_s < 2.0 * kReset;
  command.panel = panel_;
  command.hand_target.active = true;
  command.hand_target.p_B = start_.p;
  if (act_ == Act::kLean) command.hand_target = lean(for_s);
}

}  // namespace hg::start_test
