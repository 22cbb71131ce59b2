#include "hg/device/ethercat/drive_state.h"

#include <gtest/gtest.h>

namespace hg::ethercat {
namespace {

TEST(DriveState, IsReadFromTheStatusWord) {
  // with bits that belong to no state: voltage, remote, warning
  EXPECT_EQ(state_of(0x0250), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(state_of(0x0231), DriveState::kReadyToSwitchOn);
  EXPECT_EQ(state_of(0x0233), DriveState::kSwitchedOn);
  EXPECT_EQ(state_of(0x0237), DriveState::kOperationEnabled);
  EXPECT_EQ(state_of(0x0217), DriveState::kQuickStopActive);
  EXPECT_EQ(state_of(0x021F), DriveState::kFaultReactionActive);
  EXPECT_EQ(state_of(0x0218), DriveState::kFault);
  EXPECT_EQ(state_of(0x0200), DriveState::kNotReady);
  EXPECT_FALSE(is_following(0x0237));  // its brake is closed
  EXPECT_TRUE(is_following(0x1237));
}

// the state that a drive reaches by a control word, one transition at a time
DriveState after(DriveState state, std::uint16_t control) {
  switch (control) {
    case kShutDown:
      return DriveState::kReadyToSwitchOn;
    case kSwitchOn:
      return DriveState::kSwitchedOn;
    case kEnableOperation:
      return state == DriveState::kSwitchedOn ? DriveState::kOperationEnabled : state;
    default:
      return DriveState::kSwitchOnDisabled;
  }
}

TEST(DriveState, LeadsToSwitchedOnAndFurtherOnlyIfEnabled) {
  DriveState state = DriveState::kSwitchOnDisabled;
  for (int i = 0; i < 5; ++i) state = after(state, control_word(state, false));
  EXPECT_EQ(state, DriveState::kSwitchedOn);
  state = after(state, control_word(state, true));
  EXPECT_EQ(state, DriveState::kOperationEnabled);
  EXPECT_EQ(control_word(state, true), kEnableOperation);
  state = after(state, control_word(state, false));
  EXPECT_EQ(state, DriveState::kSwitchedOn);
}

TEST(DriveState, OfAFaultIsLeftByAResetOnly) {
  EXPECT_EQ(control_word(DriveState::kFault, true), kDisableVoltage);
  EXPECT_EQ(control_word(DriveState::kFaultReactionActive, true), kDisableVoltage);
}

}  // namespace
}  // namespace hg::ethercat
