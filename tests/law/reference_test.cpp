#include <gtest/gtest.h>

#include <map>
#include <memory>

#include "tests/law/recorded_states.h"

namespace hg {
namespace {

constexpr double kMatrixError = 1e-9;        // of 1 + |coefficient|, poses and s likewise
constexpr double kAccelerationError = 1e-6;  // of 1 + largest |acceleration|

// renderings of one recording: the locks are part of a twin
class Renderings {
 public:
  explicit Renderings(const Recording& recording) : recording_(recording) {}

  rendering::Rendering& with(const std::vector<int>& locked) {
    auto& rendering = by_locks_[locked];
    if (!rendering) {
      rendering = std::make_unique<rendering::Rendering>(recorded_device(recording_),
                                                         recorded_twin(recording_, locked),
                                                         recorded_options(recording_));
    }
    return *rendering;
  }

 private:
  const Recording& recording_;
  std::map<std::vector<int>, std::unique_ptr<rendering::Rendering>> by_locks_;
};

// catalogue index of entry i of the recorded flags: twin joints first, then the device
std::size_t limit_of(std::size_t i, std::size_t n_a, std::size_t count) {
  return i < n_a ? count - n_a + i : i - n_a;
}

rendering::RenderingState recorded_state(const nlohmann::json& in,
                                         rendering::Rendering& rendering) {
  rendering::RenderingState state = rendering.start(vector_of(in.at("qm")));
  state.reference.dq_m = vector_of(in.at("dqm"));
  state.twin.q_a = vector_of(in.at("qa"));
  state.twin.dq_a = vector_of(in.at("dqa"));
  const std::size_t n_a = in.at("qa").size(), count = in.at("up").size();
  for (std::size_t i = 0; i < count; ++i) {
    state.touched.upper[limit_of(i, n_a, count)] = in.at("up").at(i).get<int>() != 0;
    state.touched.lower[limit_of(i, n_a, count)] = in.at("lo").at(i).get<int>() != 0;
  }
  return state;
}

RobotState recorded_input(const nlohmann::json& in) {
  RobotState robot;
  robot.q_m = vector_of(in.at("qm"));
  robot.dq_m = vector_of(in.at("dqm"));
  robot.q_p = vector_of(in.at("qp"));
  robot.dq_p = vector_of(in.at("dqp"));
  robot.ddq_p = vector_of(in.at("ddqp"));
  robot.w_H = vector_of(in.at("w"));
  return robot;
}

void expect_near(double got, double expected, double tolerance, const std::string& what) {
  if (got == expected) return;  // infinite ends
  EXPECT_NEAR(got, expected, tolerance * (1.0 + std::abs(expected))) << what;
}

double number_of(const nlohmann::json& value) { return value.get<double>(); }

double coefficient(const hqp::Problem& problem, int row, int column) {
  const int variable = problem.variable(row);
  if (variable >= 0) return variable == column ? 1.0 : 0.0;
  return problem.coefficients(row)[column];
}

void expect_same_problem(const hqp::Problem& got, const hqp::Problem& expected) {
  ASSERT_EQ(got.variables(), expected.variables());
  ASSERT_EQ(got.levels(), expected.levels());
  ASSERT_EQ(got.rows(), expected.rows());
  for (int level = 0; level < got.levels(); ++level) {
    ASSERT_EQ(got.first_row(level), expected.first_row(level)) << "level " << level;
  }
  for (int row = 0; row < got.rows(); ++row) {
    const std::string where = "row " + std::to_string(row);
    EXPECT_EQ(got.weight(row), 1.0) << where;
    expect_near(got.bounds(row).lb, expected.bounds(row).lb, kMatrixError, where + " lb");
    expect_near(got.bounds(row).ub, expected.bounds(row).ub, kMatrixError, where + " ub");
    for (int column = 0; column < got.variables(); ++column) {
      expect_near(coefficient(got, row, column), coefficient(expected, row, column), kMatrixError,
                  where + " column " + std::to_string(column));
    }
  }
}

void expect_same_outputs(const nlohmann::json& out, const std::vector<double>& solution,
                         const rendering::LawResult& result,
                         const rendering::RenderingState& state) {
  double largest = 0.0;
  const int n_a = static_cast<int>(result.ddq_a.size());
  for (int i = 0; i < 6 + n_a; ++i) {
    largest = std::max(largest, std::abs(solution[i]));
  }
  for (int i = 0; i < 6 + n_a; ++i) {
    const double got = i < 6 ? result.ddq_m[i] : result.ddq_a[i - 6];
    EXPECT_NEAR(got, solution[i], kAccelerationError * (1.0 + largest)) << "acceleration " << i;
  }
  const auto flags = static_cast<std::size_t>(result.limit_count);
  for (std::size_t i = 0; i < flags; ++i) {
    const std::size_t limit = limit_of(i, static_cast<std::size_t>(n_a), flags);
    EXPECT_EQ(state.touched.upper[limit], out.at("next_up").at(i).get<int>() != 0) << "flag " << i;
    EXPECT_EQ(state.touched.lower[limit], out.at("next_lo").at(i).get<int>() != 0) << "flag " << i;
  }
}

void expect_same_kinematics(const nlohmann::json& out, const rendering::LawResult& result,
                            const Vector6& s) {
  const Eigen::VectorXd p = vector_of(out.at("xH")), R = vector_of(out.at("CH"));
  const Eigen::VectorXd elbow = vector_of(out.at("xElbow")), recorded_s = vector_of(out.at("s"));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(result.T_B_H.p[i], p[i], kMatrixError);
    EXPECT_NEAR(result.p_B_elbow[i], elbow[i], kMatrixError);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(result.T_B_H.R(i, j), R[3 * i + j], kMatrixError);
  }
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(s[i], recorded_s[i], kMatrixError);
}

class RecordedStates : public testing::TestWithParam<std::string> {};

TEST_P(RecordedStates, GiveTheRecordedProblemsAccelerationsAndFlags) {
  const Recording recording = read_recording(GetParam());
  ASSERT_GT(recording.states.size(), 0u);
  ASSERT_EQ(recording.states.size(), recording.problems.size());
  ASSERT_EQ(recording.states.size(), recording.solutions.size());
  Renderings renderings(recording);
  for (std::size_t k = 0; k < recording.states.size(); ++k) {
    SCOPED_TRACE("state " + std::to_string(k));
    const nlohmann::json& line = recording.states[k];
    rendering::Rendering& rendering = renderings.with(line.at("locked").get<std::vector<int>>());
    rendering::RenderingState state = recorded_state(line, rendering);
    const RobotState robot = recorded_input(line);
    rendering::LawResult result;
    ASSERT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);

    expect_same_kinematics(line, result, rendering.synchronisation());
    expect_same_problem(rendering.problem(), recording.problems[k]);
    if (!recording.is_skipped[k]) {
      expect_same_outputs(line, recording.solutions[k], result, state);
    }
    if (HasFailure()) return;  // one state is enough to look at
  }
}

INSTANTIATE_TEST_SUITE_P(, RecordedStates, testing::ValuesIn(recording_names()),
                         [](const auto& name) { return name.param; });

// A lock that engages in motion: no recording of tests/reference has it. The states of
// door_full_unlock in which the hinge is locked are taken with a hinge at q on its way to the
// closed stop, with dq = -sqrt(2 ddq_max q): what bounds B of level 8 allow a slammed door to have.
//
// (31) changes the problem of the same state without a lock in three rows and no others, because
// neither (11), (12) nor (20) contains locks:
//   levels 6 and 8, hinge  lb = ub = clip(-dq / dt, +-ddq_max), from tests/reference/README.md: of
//   the
//                          accelerations that the rating permits the one that leaves the least
//                          speed
//   level 10, hinge        alpha in [-inf, inf], whatever was touched before
// The problem without a lock is one that recordings cover: states of all five have none. Level 1
// can always be met here (regular J_m), level 6 takes the hinge, so the solution has exactly that
// acceleration, and both ends of an equality that is met are touched: (26) of the next cycle.
TEST(RecordedDoor, FollowsALockThatEngagesInMotion) {
  const Recording recording = read_recording("door_full_unlock");
  Renderings renderings(recording);
  const double dt = number_of(recording.header.at("params").at("dt"));
  const double ddq_max = number_of(recording.header.at("dt").at("ddqmax").at(0));
  const std::vector<int> locked = {1, 0};
  int states = 0;
  for (std::size_t k = 0; k < recording.states.size(); ++k) {
    const nlohmann::json& line = recording.states[k];
    if (line.at("locked").get<std::vector<int>>() != locked) continue;
    SCOPED_TRACE("state " + std::to_string(k));
    const double q = 2e-4 * static_cast<double>(1 + states++);
    const double dq = -std::sqrt(2.0 * ddq_max * q);
    const auto step = [&](const std::vector<int>& locks, rendering::RenderingState& state) {
      rendering::Rendering& rendering = renderings.with(locks);
      state = recorded_state(line, rendering);
      state.twin.q_a[0] = q;
      state.twin.dq_a[0] = dq;
      state.touched.upper[13] = state.touched.lower[13] = false;  // the hinge's limit
      const RobotState robot = recorded_input(line);
      rendering::LawResult result;
      EXPECT_EQ(rendering.step({.robot = robot}, state, result), SolverStatus::kSolved);
      return result;
    };
    rendering::RenderingState state;
    step({0, 0}, state);
    hqp::Problem expected = renderings.with({0, 0}).problem();
    const double ddq = std::clamp(-dq / dt, -ddq_max, ddq_max);
    const int level_6 = expected.first_row(5), level_8 = expected.first_row(7);
    expected.set_bounds(level_6, {ddq, ddq});
    expected.set_bounds(level_8, {ddq, ddq});
    expected.set_bounds(expected.first_row(9), {-kInfinity, kInfinity});

    const rendering::LawResult result = step(locked, state);
    expect_same_problem(renderings.with(locked).problem(), expected);
    EXPECT_NEAR(result.ddq_a[0], ddq, kAccelerationError * (1.0 + ddq_max));
    EXPECT_TRUE(state.touched.lower[13]);
    EXPECT_TRUE(state.touched.upper[13]);
    if (HasFailure()) return;
  }
  EXPECT_GT(states, 100);
}

TEST(RecordedStatesData, IsThere) { EXPECT_FALSE(recording_names().empty()) << reference_folder(); }

}  // namespace
}  // namespace hg
