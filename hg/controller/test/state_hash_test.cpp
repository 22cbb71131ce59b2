#include "hg/controller/state_hash.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "hg/controller/cycle_state.h"

namespace hg::controller {
namespace {

constexpr int kRows = 20;

CycleState example() {
  CycleState state;
  rendering::RenderingState& r = state.rendering;
  r.reference = {VectorM::Ones(6), VectorM::Ones(6), VectorM::Ones(6)};
  r.twin = {ConfigurationA::Ones(3), VectorA::Ones(2), VectorA::Ones(2)};
  state.gantry_target.q = VectorPM::Ones(8);
  state.dq_p = VectorP::Ones(2);
  state.estimation.q_m = VectorM::Ones(6);
  return state;
}

// What shares a word with others, is packed, or counts on a condition.
std::vector<std::function<void(CycleState&)>> packed_changes() {
  return {[](CycleState& s) { s.rendering.reference.q_m[5] += 1e-15; },
          // two signs at once, which a hash of words without rotation does not see
          [](CycleState& s) { s.rendering.reference.q_m[0] = s.rendering.reference.q_m[1] = -1.0; },
          [](CycleState& s) { s.rendering.inner.locks[3].is_engaged = true; },
          [](CycleState& s) { s.rendering.inner.locks[0].is_locked = true; },
          [](CycleState& s) { s.rendering.inner.sticks[1] = true; },
          [](CycleState& s) { s.rendering.inner.parameters.now.dofs[1].friction = 1.0; },
          [](CycleState& s) { s.rendering.inner.parameters.target.dofs[1].friction = 1.0; },
          [](CycleState& s) { s.rendering.inner.parameters.moving[1].is_crossed = true; },
          [](CycleState& s) { s.rendering.inner.parameters.holds[3] = true; },
          [](CycleState& s) { s.rendering.inner.parameters.may_be_overrun[1] = true; },
          [](CycleState& s) { s.rendering.active_set.state[kRows - 1] = hqp::RowState::kUpper; },
          [](CycleState& s) { s.rendering.active_set.before[kRows - 1] = hqp::RowState::kUpper; },
          [](CycleState& s) { s.rendering.touched.lower[kMaxLimits - 1] = true; },
          [](CycleState& s) { s.rendering.touched.upper[0] = true; },
          [](CycleState& s) { s.is_blocked = true; },
          [](CycleState& s) { s.motion = Motion::kBrakeJoints; },
          [](CycleState& s) { s.was_on = true; }, [](CycleState& s) { s.is_coasting = true; },
          [](CycleState& s) { s.is_apart = true; }, [](CycleState& s) { s.was_alone = true; },
          [](CycleState& s) { s.supervisor.state = safety::SafetyState::kAutonomous; },
          [](CycleState& s) { s.supervisor.last_request = ModeRequest::kStop; },
          [](CycleState& s) { s.supervisor.stop = Stop::kSs1; },
          [](CycleState& s) { s.supervisor.fault.code = FaultCode::kSyncLost; },
          [](CycleState& s) { s.supervisor.also.code = FaultCode::kSyncLost; },
          [](CycleState& s) { s.monitor.broken[1] = 1; },
          [](CycleState& s) { s.monitor.broken[0] = 3; },
          [](CycleState& s) { s.monitor.same[18] = 1; },
          [](CycleState& s) { s.monitor.is_broken = true; },
          [](CycleState& s) { s.monitor.has_sample = true; },
          [](CycleState& s) { s.monitor.late_in_a_row = 1; },
          [](CycleState& s) { s.brakes.was_powered = true; },
          [](CycleState& s) { s.brakes.samples_off = 1; },
          [](CycleState& s) { s.brakes.slip.code = FaultCode::kBrakesSlip; },
          [](CycleState& s) { s.estimation.is_started = true; },
          [](CycleState& s) { s.estimation.wrench.is_started = true; },
          [](CycleState& s) { s.estimation.wrench.tare.status = TareStatus::kDone; },
          [](CycleState& s) { s.estimation.wrench.tare.is_valid = true; },
          [](CycleState& s) { s.estimation.link[5].dq = 1.0; },
          [](CycleState& s) { s.estimation.motor[5].theta = 1.0; },
          [](CycleState& s) { s.control.is_started = true; },
          [](CycleState& s) { s.control.is_saturated = true; },
          [](CycleState& s) { s.control.answers = 1; }, [](CycleState& s) { s.control.late = 1; },
          [](CycleState& s) { s.collision.count = 1; },
          [](CycleState& s) { s.touch.dq = VectorM::Ones(1); },
          [](CycleState& s) {
            s.touch.dq = VectorM::Ones(1);
            s.touch.is_reported = true;
          },
          [](CycleState& s) {
            s.touch.dq = VectorM::Ones(1);
            s.rendering.touch[1] = 1.0;
          }};
}

// The compiler sees that hashed() names all members of a state.
TEST(StateHash, SeesValuesThatShareAWordOrArePacked) {
  const std::vector<std::function<void(CycleState&)>> changes = packed_changes();
  std::vector<std::uint64_t> hashes = {hash_of(example(), kRows)};
  EXPECT_EQ(hashes[0], hash_of(example(), kRows));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    CycleState state = example();
    changes[i](state);
    hashes.push_back(hash_of(state, kRows));
    for (std::size_t j = 0; j < i + 1; ++j) ASSERT_NE(hashes.back(), hashes[j]) << i << " " << j;
  }
}

}  // namespace
}  // namespace hg::controller
