#include "hg/messages/diagnostics.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace hg::messages {
namespace {

class DiagnosticsTest : public ::testing::Test {
 protected:
  static RunNames names() {
    RunNames names;
    names.limits = {{LimitKind::kManipulatorJoint, "m1", true, {-1.0, 1.0}},
                    {LimitKind::kCartesian, "elbow x", false, {-1.0, 1.0}}};
    return names;
  }

  DiagnosticsTest() {
    sample_.record.mode = Mode::kRunning;
    sample_.record.limit_count = 2;
    diagnostics_.update(sample_, 0);
  }

  // Value of `key` in the status number `status` of the present message.
  std::string value(std::size_t status, const std::string& key) {
    const auto& values = diagnostics_.update(sample_, 0).status.at(status).values;
    const auto found = std::ranges::find(values, key, &KeyValue::key);
    return found == values.end() ? "none" : found->value;
  }

  Sample sample_;
  Diagnostics diagnostics_{names()};
};

TEST_F(DiagnosticsTest, IsDueTwiceASecondAndOnChange) {
  EXPECT_FALSE(diagnostics_.is_due(sample_.record));
  CycleRecord other = sample_.record;
  other.time_s = 0.5;
  EXPECT_TRUE(diagnostics_.is_due(other));
  other = sample_.record;
  other.mode = Mode::kStopping;
  EXPECT_TRUE(diagnostics_.is_due(other));
  other = sample_.record;
  other.limits[1].state = LimitState::kUpper;
  EXPECT_TRUE(diagnostics_.is_due(other));
}

TEST_F(DiagnosticsTest, SaysModeAndFault) {
  EXPECT_EQ(value(0, "mode"), to_string(Mode::kRunning));
  EXPECT_EQ(diagnostics_.update(sample_, 0).status[0].level, 0);
  sample_.record.mode = Mode::kFault;
  sample_.record.fault.code = FaultCode::kOscillation;
  const DiagnosticStatus status = diagnostics_.update(sample_, 0).status[0];
  EXPECT_EQ(status.level, 2);
  EXPECT_NE(status.message.find(to_string(FaultCode::kOscillation)), std::string::npos);
  EXPECT_EQ(value(0, "fault"), std::to_string(static_cast<int>(FaultCode::kOscillation)));
}

TEST_F(DiagnosticsTest, CountsLateCycles) {
  sample_.operator_input.late_cycles = 2;
  sample_.cycle_time_us = 55.5;
  for (int i = 0; i < 3; ++i) diagnostics_.observe(sample_);
  const DiagnosticStatus status = diagnostics_.update(sample_, 0).status[1];
  EXPECT_EQ(status.level, 1);
  EXPECT_EQ(status.values[0].value, "6");
  EXPECT_EQ(status.values[1].value, "55.5");
}

TEST_F(DiagnosticsTest, ListsTheLimitsThatAct) {
  EXPECT_EQ(diagnostics_.update(sample_, 0).status[2].message, "none acts");
  sample_.record.limits[1] = {
      .state = LimitState::kUpper, .cause = LimitCause::kPosition, .reaction = 12.3456};
  const DiagnosticStatus status = diagnostics_.update(sample_, 0).status[2];
  EXPECT_EQ(status.message, "1 act");
  ASSERT_EQ(status.values.size(), 1u);
  EXPECT_EQ(status.values[0].key, "elbow x");
  EXPECT_NE(status.values[0].value.find("12.346 N"), std::string::npos) << status.values[0].value;
}

}  // namespace
}  // namespace hg::messages
