#include "hg/controller/state_hash.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace hg::controller {
namespace {

constexpr int kRows = 20;

State example() {
  State state;
  rendering::State& r = state.rendering;
  r.reference = {VectorM::Ones(6), VectorM::Ones(6), VectorM::Ones(6)};
  r.twin = {ConfigurationA::Ones(3), VectorA::Ones(2), VectorA::Ones(2)};
  state.gantry_target.q = VectorPM::Ones(8);
  state.dq_p = VectorP::Ones(2);
  state.estimation.q_m = VectorM::Ones(6);
  return state;
}

// The compiler sees that hashed() names all members of a state. Here: what shares a word with
// others, is packed, or counts on a condition.
TEST(StateHash, SeesValuesThatShareAWordOrArePacked) {
  const std::vector<std::function<void(State&)>> changes = {
      [](State& s) { s.rendering.reference.q_m[5] += 1e-15; },
      // two signs at once, which a hash of words without rotation does not see
      [](State& s) { s.rendering.reference.q_m[0] = s.rendering.reference.q_m[1] = -1.0; },
      [](State& s) { s.rendering.inner.locks[3].is_engaged = true; },
      [](State& s) { s.rendering.inner.locks[0].is_locked = true; },
      [](State& s) { s.rendering.inner.sticks[1] = true; },
      [](State& s) { s.rendering.inner.parameters.now.dofs[1].friction = 1.0; },
      [](State& s) { s.rendering.inner.parameters.target.dofs[1].friction = 1.0; },
      [](State& s) { s.rendering.inner.parameters.moving[1].is_crossed = true; },
      [](State& s) { s.rendering.inner.parameters.holds[3] = true; },
      [](State& s) { s.rendering.inner.parameters.may_be_overrun[1] = true; },
      [](State& s) { s.rendering.active_set.state[kRows - 1] = hqp::RowState::kUpper; },
      [](State& s) { s.rendering.active_set.before[kRows - 1] = hqp::RowState::kUpper; },
      [](State& s) { s.rendering.touched.lower[kMaxLimits - 1] = true; },
      [](State& s) { s.rendering.touched.upper[0] = true; }, [](State& s) { s.is_blocked = true; },
      [](State& s) { s.motion = Motion::kBrakeJoints; }, [](State& s) { s.was_on = true; },
      [](State& s) { s.is_coasting = true; }, [](State& s) { s.is_apart = true; },
      [](State& s) { s.was_alone = true; },
      [](State& s) { s.supervisor.state = safety::State::kAutonomous; },
      [](State& s) { s.supervisor.last_request = ModeRequest::kStop; },
      [](State& s) { s.supervisor.stop = Stop::kSs1; },
      [](State& s) { s.supervisor.fault.code = FaultCode::kSyncLost; },
      [](State& s) { s.supervisor.also.code = FaultCode::kSyncLost; },
      [](State& s) { s.monitor.broken[1] = 1; }, [](State& s) { s.monitor.broken[0] = 3; },
      [](State& s) { s.monitor.same[18] = 1; }, [](State& s) { s.monitor.is_broken = true; },
      [](State& s) { s.monitor.has_sample = true; }, [](State& s) { s.monitor.late_in_a_row = 1; },
      [](State& s) { s.brakes.was_powered = true; }, [](State& s) { s.brakes.samples_off = 1; },
      [](State& s) { s.brakes.slip.code = FaultCode::kBrakesSlip; },
      [](State& s) { s.estimation.is_started = true; },
      [](State& s) { s.estimation.wrench.is_started = true; },
      [](State& s) { s.estimation.wrench.tare.status = TareStatus::kDone; },
      [](State& s) { s.estimation.wrench.tare.is_valid = true; },
      [](State& s) { s.estimation.link[5].dq = 1.0; },
      [](State& s) { s.estimation.motor[5].theta = 1.0; },
      [](State& s) { s.control.is_started = true; },
      [](State& s) { s.control.is_saturated = true; }, [](State& s) { s.control.answers = 1; },
      [](State& s) { s.control.late = 1; }, [](State& s) { s.collision.count = 1; },
      [](State& s) { s.touch.dq = VectorM::Ones(1); },
      [](State& s) {
        s.touch.dq = VectorM::Ones(1);
        s.touch.is_reported = true;
      },
      [](State& s) {
        s.touch.dq = VectorM::Ones(1);
        s.rendering.touch[1] = 1.0;
      }};
  std::vector<std::uint64_t> hashes = {hash_of(example(), kRows)};
  EXPECT_EQ(hashes[0], hash_of(example(), kRows));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    State state = example();
    changes[i](state);
    hashes.push_back(hash_of(state, kRows));
    for (std::size_t j = 0; j < i + 1; ++j) ASSERT_NE(hashes.back(), hashes[j]) << i << " " << j;
  }
}

}  // namespace
}  // namespace hg::controller
