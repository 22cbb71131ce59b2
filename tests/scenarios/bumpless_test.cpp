// Rendering begins and ends without a bump, also when a person leans on the handle.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/scenarios/scenario_run.h"

namespace hg {
namespace {

constexpr double kPush = 20.0;  // N

/// A simulated device whose requests the test makes, with a hand that leans on the handle.
class Leaning {
 public:
  Leaning() : Leaning(shipped("free_space")) {}

  const Sample& step(ModeRequest request) {
    session_.request(request);
    session_.input().hand_target = target_;
    session_.advance();
    return session_.sample();
  }

  // Tared, armed and held, with a hand that pushes with kPush.
  void prepare() {
    while (session_.record().mode != Mode::kArmed) session_.advance();
    while (!sample().sensors.dead_man) step(ModeRequest::kNone);
    target_.active = true;
    Eigen::Vector3d offset(0.1, 0.0, 0.0);
    for (int attempt = 0; attempt < 3; ++attempt) {
      target_.p_B = sample().record.T_B_H.p + offset;
      for (int k = 0; k < 1000; ++k) step(ModeRequest::kNone);
      offset *= kPush / force();
    }
    ASSERT_NEAR(force(), kPush, 1.5);
  }

  double force() const { return sample().truth.w_H.head<3>().norm(); }
  const Sample& sample() const { return session_.sample(); }

 private:
  explicit Leaning(config::Scenario scenario)
      : session_((scenario.person = person::PersonKind::kMouse, scenario)) {}

  scenario::Session session_;
  HandTarget target_;
};

TEST(Bumpless, ALeaningHandMakesNoJerkWhenRenderingBegins) {
  Leaning run;
  run.prepare();
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  double largest_change = 0.0, after_50_ms = 0.0, largest = 0.0;
  for (int k = 0; k < 400; ++k) {
    const Sample& sample = run.step(k < 5 ? ModeRequest::kRun : ModeRequest::kNone);
    if (sample.record.mode != Mode::kRunning) {
      ASSERT_LT(k, 5);
      continue;
    }
    const Eigen::Vector3d a_H = sample.record.a_H;
    largest_change = std::max(largest_change, (a_H - last).norm());
    last = a_H;
    largest = std::max(largest, a_H.norm());
    if (k < 50) after_50_ms = std::max(after_50_ms, a_H.norm());
  }
  RecordProperty("largest_change", std::to_string(largest_change));
  // the hand moves off, but it takes its time
  EXPECT_GT(largest, 0.5);
  EXPECT_LT(largest_change, 0.05);  // m/s^2 in a cycle; 0.025 when written
  EXPECT_LT(after_50_ms, 1.0);
}

TEST(Bumpless, ARequestedStopMakesNoJerkForALeaningHand) {
  Leaning run;
  run.prepare();
  for (int k = 0; k < 600; ++k) run.step(k < 5 ? ModeRequest::kRun : ModeRequest::kNone);
  ASSERT_EQ(run.sample().record.mode, Mode::kRunning);
  Eigen::Vector3d last = run.sample().record.a_H;
  double largest_change = 0.0, largest = 0.0;
  int k = 0;
  for (; k < 1000 && run.sample().record.mode != Mode::kArmed; ++k) {
    const Eigen::Vector3d a_H = run.step(ModeRequest::kStop).record.a_H;
    largest_change = std::max(largest_change, (a_H - last).norm());
    largest = std::max(largest, a_H.norm());
    last = a_H;
  }
  RecordProperty("largest_change", std::to_string(largest_change));
  EXPECT_EQ(run.sample().record.mode, Mode::kArmed);
  EXPECT_LT(k, 600);  // at rest
  EXPECT_GT(largest, 1.0);
  EXPECT_LT(largest_change, 0.1);  // m/s^2 in a cycle; 0.043 when written
}

}  // namespace
}  // namespace hg
