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

TEST(StateHash, SeesEveryValueOfTheState) {
  const std::vector<std::function<void(State&)>> changes = {
      [](State& s) { s.rendering.reference.q_m[5] += 1e-15; },
      [](State& s) { s.rendering.reference.dq_m[0] = 0.0; },
      [](State& s) { s.rendering.reference.ddq_m[2] = -1.0; },
      [](State& s) { s.rendering.twin.q_a[2] = 0.0; },
      [](State& s) { s.rendering.twin.dq_a[1] = 0.0; },
      [](State& s) { s.rendering.twin.ddq_a[1] = 0.0; },
      [](State& s) { s.rendering.inner.locks[3].is_engaged = true; },
      [](State& s) { s.rendering.inner.locks[0].is_locked = true; },
      [](State& s) { s.rendering.inner.locks[1].edge = 0.5; },
      [](State& s) { s.rendering.inner.sticks[1] = true; },
      [](State& s) { s.rendering.inner.parameters.now.dofs[1].friction = 1.0; },
      [](State& s) { s.rendering.inner.parameters.now.dofs[0].dq_max = 1.0; },
      [](State& s) { s.rendering.inner.parameters.now.w_ref[5] = 1.0; },
      [](State& s) { s.rendering.inner.parameters.now.loads.gravity = 0.5; },
      [](State& s) { s.rendering.inner.parameters.target.dofs[0].stiffness = 1.0; },
      [](State& s) { s.rendering.inner.parameters.target.loads.mass = 2.0; },
      [](State& s) { s.rendering.inner.parameters.range[1].lb = 0.0; },
      [](State& s) { s.rendering.inner.parameters.moving[0].q.ub = 0.0; },
      [](State& s) { s.rendering.inner.parameters.moving[1].is_crossed = true; },
      [](State& s) { s.rendering.inner.parameters.holds[3] = true; },
      [](State& s) { s.rendering.inner.parameters.may_be_overrun[1] = true; },
      [](State& s) { s.rendering.active_set.state[kRows - 1] = hqp::RowState::kUpper; },
      [](State& s) { s.rendering.active_set.before[kRows - 1] = hqp::RowState::kUpper; },
      [](State& s) { s.rendering.touched.lower[kMaxLimits - 1] = true; },
      [](State& s) { s.rendering.touched.upper[0] = true; },
      [](State& s) { s.rendering.contact.proxy[2] = 1.0; },
      [](State& s) { s.rendering.contact.is_started = true; },
      [](State& s) { s.gantry_target.is_started = true; },
      [](State& s) { s.gantry_target.q[7] = 0.0; }, [](State& s) { s.collision.count = 1; },
      [](State& s) { s.passivity.tank = 1.0; }, [](State& s) { s.passivity.added.inertia = 2.0; },
      [](State& s) { s.dq_p[1] = 0.0; }, [](State& s) { s.is_blocked = true; },
      [](State& s) { s.force_share = 0.5; }, [](State& s) { s.next_sequence = 7; },
      [](State& s) { s.supervisor.state = safety::State::kAutonomous; },
      [](State& s) { s.supervisor.stop = Stop::kSs1; },
      [](State& s) { s.supervisor.also.code = FaultCode::kSyncLost; },
      [](State& s) { s.supervisor.fault.index = 3; },
      [](State& s) { s.supervisor.fault.value = 1.0; },
      [](State& s) { s.supervisor.also.limit = 1.0; }, [](State& s) { s.cycle = 9; },
      [](State& s) { s.is_coasting = true; }, [](State& s) { s.is_apart = true; },
      [](State& s) { s.was_alone = true; }, [](State& s) { s.estimation.is_started = true; },
      [](State& s) { s.estimation.wrench.is_started = true; },
      [](State& s) { s.rendering.added.damping = 1.0; },
      [](State& s) { s.rendering.added.inertia = 2.0; }, [](State& s) { s.monitor.broken[1] = 1; },
      [](State& s) { s.monitor.broken[0] = 3; }, [](State& s) { s.supervisor.stop_samples = 1; },
      [](State& s) { s.motion = Motion::kBrakeJoints; }, [](State& s) { s.was_on = true; },
      [](State& s) { s.w_H[2] = 1.0; },
      [](State& s) { s.monitor.gantry_gap = VectorP::Constant(1, 0.4); },
      [](State& s) { s.q_m = VectorM::Ones(1); }, [](State& s) { s.monitor.broken[3] = 2; },
      [](State& s) { s.monitor.is_broken = true; }, [](State& s) { s.monitor.has_sample = true; },
      [](State& s) { s.monitor.same[2] = 1; }, [](State& s) { s.monitor.same[18] = 1; },
      [](State& s) { s.monitor.late_in_a_row = 1; }, [](State& s) { s.monitor.late = 1.0; },
      [](State& s) { s.monitor.clock_error = 0.1; }, [](State& s) { s.monitor.time_s = 0.2; },
      [](State& s) { s.monitor.w_S[1] = 0.3; },
      [](State& s) { s.monitor.pulled_back = VectorM::Constant(1, 0.7); },
      [](State& s) { s.monitor.momentum = VectorM::Constant(1, 0.5); },
      [](State& s) { s.monitor.dq_p_model = VectorP::Constant(1, 0.6); },
      [](State& s) { s.supervisor.last_request = ModeRequest::kStop; },
      [](State& s) { s.supervisor.fault.code = FaultCode::kSyncLost; },
      [](State& s) { s.estimation.gantry[1].disturbance = 1.0; },
      [](State& s) { s.estimation.q_m[3] = 0.0; }, [](State& s) { s.estimation.link[5].dq = 1.0; },
      [](State& s) { s.estimation.motor[5].theta = 1.0; }, [](State& s) { s.control.answers = 1; },
      [](State& s) { s.control.unexplained = VectorM::Constant(1, 0.8); },
      [](State& s) { s.control.stiff = VectorM::Constant(1, 0.9); },
      [](State& s) { s.control.w_H[3] = 1.0; }, [](State& s) { s.control.dw_H[0] = 2.0; },
      [](State& s) { s.control.late = 1; }, [](State& s) { s.estimation.wrench.omega_S.x() = 1.0; },
      [](State& s) { s.estimation.wrench.alpha_S.y() = 1.0; },
      [](State& s) { s.estimation.wrench.w_S[4] = 1.0; },
      [](State& s) { s.estimation.wrench.tare.status = TareStatus::kDone; },
      [](State& s) { s.estimation.wrench.tare.is_valid = true; },
      [](State& s) { s.estimation.wrench.tare.count = 3; },
      [](State& s) { s.estimation.wrench.tare.offset[5] = 1.0; },
      [](State& s) { s.estimation.wrench.tare.mean[5] = 2.0; },
      [](State& s) { s.estimation.wrench.tare.square[0] = 1.0; },
      [](State& s) { s.estimation.wrench.tare.first_half[1] = 1.0; },
      [](State& s) { s.estimation.wrench.tare.q_m = VectorM::Ones(1); },
      [](State& s) { s.touch.dq = VectorM::Ones(1); },
      [](State& s) {
        s.touch.dq = VectorM::Ones(1);
        s.touch.is_reported = true;
      },
      [](State& s) {
        s.touch.dq = VectorM::Ones(1);
        s.touch.torque = VectorM::Ones(1);
      },
      [](State& s) {
        s.touch.dq = VectorM::Ones(1);
        s.rendering.touch[1] = 1.0;
      },
      // two signs at once, which a hash of words without rotation does not see
      [](State& s) { s.rendering.reference.q_m[0] = s.rendering.reference.q_m[1] = -1.0; }};
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
