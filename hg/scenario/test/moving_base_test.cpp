// A twin whose place moves, with the whole device: what is carried along, and what is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/core/rotation.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/session.h"

namespace hg::scenario {
namespace {

// A twin without a hand, on a base that moves 5 cm.
config::Scenario swaying(const std::string& twin) {
  const TemporaryFolder folder;
  const std::string models = std::filesystem::absolute("models").string();
  return config::load_scenario(folder.write(
      "swaying.yaml", "title: T\ndescription: D\nduration_s: 12\nperson: none\ndevice: " + models +
                          "/haptic_giant/device.yaml\ntwin: " + models + "/twins/" + twin +
                          "/twin.yaml\ntwin_motion:\n  begin_s: 0.5\n  swings:\n"
                          "    - {direction: x, amplitude_m: 0.05, period_s: 2.5}\n"
                          "    - {direction: y, amplitude_m: 0.03, period_s: 4}\n"
                          "events: []\n"));
}

struct Way {
  double base = 0.0;     ///< Largest way of the base, m
  double carried = 0.0;  ///< Largest distance of the handle from where the base carries it, m
  double at_rest = 0.0;  ///< Largest distance of the handle from where it was, m
};

Way way_of(const std::string& twin) {
  config::Scenario scenario = swaying(twin);
  // dampers stand on the base
  for (rendering::TwinDof& dof : scenario.twin.model.dofs) dof.damping = dof.friction = 0.0;
  Session session(scenario);
  Way way;
  Pose base_before, handle_before;
  bool has_begun = false;
  while (session.advance()) {
    const CycleRecord& record = session.record();
    if (record.mode != Mode::kRunning) continue;
    // what is not touched is brought to rest against the base
    if (record.rest.is_untouched && twin == "free_space") break;
    const Pose base = session.sample().operator_input.twin_base.T_B_A;
    if (!std::exchange(has_begun, true)) {
      base_before = base;
      handle_before = record.T_B_H;
    }
    const Pose carried = base * inverse(base_before) * handle_before;
    way.base = std::max(way.base, (base.p - base_before.p).norm());
    way.carried = std::max(way.carried, (record.T_B_H.p - carried.p).norm());
    way.at_rest = std::max(way.at_rest, (record.T_B_H.p - handle_before.p).norm());
    if (session.record().cycle > 9000) break;
  }
  EXPECT_EQ(session.record().fault.code, FaultCode::kNone);
  return way;
}

TEST(MovingBase, CarriesWhatIsFixedToIt) {
  const Way way = way_of("door");  // locked
  EXPECT_GT(way.base, 0.04);
  EXPECT_LT(way.carried, 2e-3);
}

TEST(MovingBase, DoesNotCarryAFreeBody) {
  const Way way = way_of("free_space");
  EXPECT_GT(way.base, 0.04);
  EXPECT_LT(way.at_rest, 3e-3);
}

TEST(MovingBase, RestsDuringAStopAndContinues) {
  Session session(swaying("door"));
  const auto advance = [&](int cycles) {
    for (int k = 0; k < cycles; ++k) session.advance();
  };
  const auto base = [&] { return session.sample().operator_input.twin_base; };
  advance(5000);
  ASSERT_EQ(session.record().mode, Mode::kRunning);
  session.request(ModeRequest::kStop);
  advance(1500);
  const TwinBase stopped = base();
  EXPECT_NE(session.record().mode, Mode::kRunning);
  EXPECT_TRUE(stopped.twist.isZero(0.0));
  advance(500);
  EXPECT_EQ(base().T_B_A.p, stopped.T_B_A.p);
  session.request(ModeRequest::kArm);
  advance(500);
  session.request(ModeRequest::kRun);
  advance(200);
  ASSERT_EQ(session.record().mode, Mode::kRunning);
  double apart = 0.0;
  for (int k = 0; k < 4000; ++k) {
    session.advance();
    apart = std::max(apart, session.record().sync_error);
  }
  EXPECT_LT(apart, 1e-3);
  EXPECT_NE(base().T_B_A.p, stopped.T_B_A.p);
  EXPECT_EQ(session.record().fault.code, FaultCode::kNone);
}

// Gives what a test says.
class Given final : public TwinBaseSource {
 public:
  TwinBase step(bool /*is_running*/, bool /*is_apart*/) noexcept override { return base; }
  TwinBase base;
};

TEST(MovingBase, ThatIsNoMotionStopsTheDevice) {
  const config::Scenario scenario = swaying("door");
  const auto fault_of = [&](auto&& change) {
    controller::Cycle cycle = make_cycle(scenario);
    const auto device = make_simulated_device(scenario);
    Given given;
    given.base.is_moving = true;
    given.base.T_B_A = scenario.twin.T_B_root;
    runtime::Session session(cycle, *device, {.twin_base = &given});
    for (int k = 0; k < 4000; ++k) session.advance();
    EXPECT_EQ(session.record().mode, Mode::kRunning);
    change(given.base);
    session.advance();
    EXPECT_EQ(session.record().fault.code, FaultCode::kTwinForceWrong);
    EXPECT_TRUE(session.sample().command.q_m.allFinite());
    return session.record().fault;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault_of([&](TwinBase& base) { base.T_B_A.p[1] = nan; }).index, 6 + kMaxTwin + 1);
  EXPECT_EQ(fault_of([&](TwinBase& base) { base.T_B_A.R(2, 0) = nan; }).index, 6 + kMaxTwin + 5);
  EXPECT_EQ(fault_of([&](TwinBase& base) { base.twist[5] = 3.0; }).limit, 2.0);
  EXPECT_EQ(fault_of([&](TwinBase& base) { base.acceleration[0] = -11.0; }).value, -11.0);
}

}  // namespace
}  // namespace hg::scenario
