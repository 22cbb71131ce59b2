/// A twin that changes while a hand holds it, in closed loop; and twins that cannot be rendered.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "hg/core/error.h"
#include "tests/scenarios/trace.h"

namespace hg {
namespace {

// Largest change of the hand's acceleration in one cycle. 20 N more within 0.1 s are 0.2 N more in
// a cycle; on the 6 kg of the free body 0.03 m/s^2.
constexpr double kBump = 0.1;   // m/s^2
constexpr double kGrasp = 0.7;  // s, running from here on

// the hand stays where the twin starts
config::Scenario held(const std::string& name, double seconds) {
  config::Scenario scenario = law_alone(name);
  scenario.script.script.segments.clear();
  scenario.script.script.duration_s = seconds;
  scenario.duration_s = seconds;
  scenario.events.clear();
  return scenario;
}

double largest_bump(const Trace& trace, double from_s) {
  double largest = 0.0;
  for (std::size_t i = trace.at(from_s) + 1; i < trace.records().size(); ++i) {
    const Eigen::Vector3d bump = trace.records()[i].a_H - trace.records()[i - 1].a_H;
    largest = std::max(largest, bump.norm());
  }
  return largest;
}

TEST(ChangesInClosedLoop, AreNotFeltAsABump) {
  config::Scenario scenario = held("free_space", 16.0);
  const auto dof = [](int i) { return static_cast<std::int16_t>(i); };
  scenario.changes = {{1.0, {Parameter::kReferenceWrench, dof(0), 20.0}},
                      {1.0, {Parameter::kReferenceWrench, dof(2), -20.0}},
                      {2.0, {Parameter::kDamping, dof(0), 60.0}},
                      {3.0, {Parameter::kMassScale, dof(-1), 0.5}},
                      {4.0, {Parameter::kMassScale, dof(-1), 3.0}},
                      {5.0, {Parameter::kReferenceWrench, dof(0), 0.0}},
                      {6.0, {Parameter::kQuadraticDamping, dof(1), 500.0}},
                      {7.0, {Parameter::kFeltScale, dof(2), 2.0}}};
  const std::size_t changes = scenario.changes.size();
  const Trace trace(std::move(scenario));
  expect_sound(trace.run());
  EXPECT_LT(largest_bump(trace, kGrasp + 0.1), kBump);
  std::size_t taken = 0;
  for (const CycleRecord& record : trace.records()) {
    ASSERT_NE(record.change, ChangeStatus::kRefused) << record.time_s;
    taken += record.change == ChangeStatus::kTaken ? 1 : 0;
  }
  EXPECT_EQ(taken, changes);
  EXPECT_EQ(trace.record(0.999).change, ChangeStatus::kNone);
  EXPECT_EQ(trace.record(1.0).change, ChangeStatus::kTaken);

  // the hand carries the reference wrench
  EXPECT_NEAR(trace.record(4.9).robot.w_H.x(), 20.0, 0.5);
  EXPECT_NEAR(trace.record(15.9).robot.w_H.x(), 0.0, 0.5);
  EXPECT_NEAR(trace.record(6.9).robot.w_H.z(), -20.0, 0.5);
  EXPECT_NEAR(trace.record(15.9).robot.w_H.z(), -10.0, 0.5);  // of the twin: twice as much
}

TEST(ChangesInClosedLoop, ThatMakeNoSenseAreIgnoredAndSeen) {
  config::Scenario scenario = held("door", 1.0);
  scenario.changes = {{0.5, {Parameter::kStiffness, 7, 1.0}},
                      {0.6, {Parameter::kUpperLimit, 0, -1.0}}};
  const Trace trace(scenario);
  scenario.changes.clear();
  const Trace without(scenario);
  EXPECT_EQ(trace.record(0.5).change, ChangeStatus::kRefused);
  EXPECT_EQ(trace.record(0.6).change, ChangeStatus::kRefused);
  EXPECT_EQ(trace.records().back().state_hash, without.records().back().state_hash);
}

TEST(TwinOutOfReach, IsRefusedWithAdvice) {
  config::Scenario scenario = law_alone("door");
  model::ChainOptions far = {.gravity = false};
  far.T_B_root.p = {30.0, 0.0, -0.8};
  scenario.twin.model.chain = model::ChainModel::from_urdf_file(scenario.twin.urdf, far);
  try {
    ScenarioRun run(scenario);
    FAIL() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find("placement"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hg
