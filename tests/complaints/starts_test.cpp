/// Arms that start anywhere: a start gives no fault, and a hand that pushes out of what is in the
/// way moves the handle within 50 ms. Judged by the truth of the simulation: 30 % of the speed that
/// the free twin would have, whose forces the law lets in over 0.3 s after a start.
///
/// HG_STARTS in the environment is the number of starts, HG_START that of a single one, whose
/// cycles are shown. HG_START_DEVICES is a list of device files besides the arms of models/arms,
/// separated by colons. Prints what each arm and kind gave.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "hg/core/stacked.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/scenario/assembly.h"
#include "tests/complaints/start_draw.h"
#include "tests/scenarios/scenario_run.h"

namespace hg {
namespace {

constexpr double kFree = 0.05;   // s, within which the handle moves
constexpr double kShare = 0.3;   // of the speed that the free twin would have by then
constexpr int kHeldOf = 50;      // at most one start of so many may be late by the law
constexpr int kLateOf = 4;       // and by drives and springs behind it
constexpr double kRampIn = 0.3;  // s, in which the law lets forces begin after a start
constexpr double kPushed = 0.1;  // s, for how long the hand pushes, and the run lasts afterwards

struct Arm {
  std::string name;
  config::Scenario scenario;
};

// A free twin on this device, and a hand that holds it without pulling.
config::Scenario scenario_of(const std::filesystem::path& device) {
  const TemporaryFolder folder;
  folder.write("twin.yaml", fmt::format("name: tool\nfree_body: {{mass_kg: {0}, inertia_kg_m2: "
                                        "[{1}, {1}, {1}]}}\nend_effector: handle\njoints:\n"
                                        "  root: {{damping_Ns_per_m: 3, "
                                        "angular_damping_Nms_per_rad: 0.03}}\n",
                                        kTwinMass, kTwinInertia));
  folder.write("hand.yaml",
               "frame: base\nhand: {tremor_N: 0.035}\n"
               "segments: [{start_s: 0, duration_s: 0.001, grip: 0}]\nduration_s: 1\n");
  return config::load_scenario(
      folder.write("start.yaml", "title: Start\ndescription: Anywhere.\ndevice: " +
                                     std::filesystem::absolute(device).string() +
                                     "\ntwin: twin.yaml\nperson: hand.yaml\nduration_s: 1\n"));
}

std::vector<Arm> arms() {
  std::vector<std::string> files;
  for (const char* name : {"ur5e", "ur10e", "fr3", "gen3", "iiwa14", "xarm7"}) {
    files.push_back(std::string("models/arms/") + name + "/device.yaml");
  }
  if (const char* more = std::getenv("HG_START_DEVICES")) {
    std::istringstream list(more);
    for (std::string file; std::getline(list, file, ':');) files.push_back(file);
  }
  std::vector<Arm> arms;
  for (const std::string& file : files) {
    config::Scenario scenario = scenario_of(file);
    arms.push_back({scenario.device.name, std::move(scenario)});
  }
  return arms;
}

struct Result {
  FaultCode fault = FaultCode::kNone;
  int fault_index = -1;
  double fault_s = 0.0;
  std::string refusal;        // why the run did not begin
  double running_s = -1.0;    // when it began
  double free_s = kInfinity;  // from which on the handle moves while it is pushed
  double share = 0.0;         // of the speed that the free twin would have at kFree
  double meant = 0.0;         // the same of the law's reference, without drives

  bool has_fault() const { return fault != FaultCode::kNone; }
  bool is_refused() const { return !refusal.empty(); }
  bool is_late() const { return !has_fault() && !is_refused() && free_s > kFree + 1e-9; }
};

void add_push(const DrawnStart& drawn, double start_s, double share, config::Scenario& scenario) {
  const Eigen::Matrix3d to_H = drawn.start.T_B_H.R.transpose();
  Vector6 push;
  push << to_H * drawn.push.head<3>(), to_H * drawn.push.tail<3>();
  for (int k = 0; k < 6; ++k) {
    scenario.script.script.segments.push_back({.start_s = start_s,
                                               .duration_s = 2e-3,
                                               .channel = person::kWrenchChannel + k,
                                               .value = share * push[k]});
  }
}

// The handle's velocity as the time for which the free twin would have been pushed.
double pushed_time(const DrawnStart& drawn, const Vector6& twist) {
  Vector6 motion = drawn.push;
  motion.head<3>() /= kTwinMass;
  motion.tail<3>() /= kTwinInertia;
  return twist.dot(drawn.push) / motion.dot(drawn.push);
}

// What acts in a cycle, for a look at one start.
void print_cycle(const config::Scenario& scenario, const Sample& sample, double since,
                 double pushed, double meant) {
  const CycleRecord& record = sample.record;
  fmt::print("{:+.3f} s mode {} fault {} warning {}: {:.4f} of {:.4f} s;", since,
             static_cast<int>(record.mode), static_cast<int>(record.fault.code),
             static_cast<int>(record.warning.code), pushed, meant);
  for (std::size_t i = 0; i < scenario.limits.size(); ++i) {
    const LimitReport& limit = record.limits[i];
    if (limit.state == LimitState::kInactive) continue;
    fmt::print(" {} {} {} {:.3g};", scenario.limits[i].name, to_string(limit.state),
               to_string(limit.cause), limit.reaction);
  }
  fmt::print(" dq");
  for (const double dq : sample.truth.dq_m) fmt::print(" {:.4f}", dq);
  fmt::print(" ref");
  for (const double dq : record.reference.dq_m) fmt::print(" {:.4f}", dq);
  fmt::print(" w");
  for (const double w : record.robot.w_H) fmt::print(" {:.2f}", w);
  fmt::print("\n");
}

void note_mode(const CycleRecord& record, double from, Result& result) {
  if (record.mode == Mode::kRunning && result.running_s < 0.0) {
    result.running_s = record.time_s;
    result.refusal.clear();
  }
  if (!result.refusal.empty() && record.refusal != Refusal::kNone) {
    result.refusal = to_string(record.refusal);
  }
  if (record.fault.code == FaultCode::kNone || result.fault != FaultCode::kNone) return;
  result.fault = record.fault.code;
  result.fault_index = record.fault.index;
  result.fault_s = record.time_s - from;
}

/// What a run was like from the push on, cycle by cycle.
struct Played {
  Result result;
  std::vector<double> pushed, meant;  // pushed_time() of the handle and of the law's reference
};

// One run, in which the hand pushes with so much of the drawn push.
Played play(const DrawnStart& drawn, double push_s, double share, bool is_shown) {
  config::Scenario scenario = drawn.scenario;
  scenario.duration_s = 0.0;  // as long as its script
  if (drawn.is_pushed_out) add_push(drawn, push_s - 0.15, -1.0, scenario);
  add_push(drawn, push_s, share, scenario);
  add_push(drawn, push_s + kPushed, 0.0, scenario);
  scenario.script.script.duration_s = push_s + 2.0 * kPushed;
  const double from = scenario.script.script.grasp_s + push_s;
  Played played;
  played.result.refusal = "never running";
  ScenarioRun run(scenario, scenario::make_simulated_device(
                                scenario, scenario::make_simulation(scenario, drawn.start)));
  model::ChainData chain(scenario.device.model.chain);
  run.play([&](const Sample& sample) {
    const CycleRecord& record = sample.record;
    note_mode(record, from, played.result);
    const double since = record.time_s - from;
    const VectorPM q = stacked(record.robot.q_p, record.reference.q_m);
    if (since <= 0.0 || q.size() != chain.model().nv()) return;
    chain.update_kinematics(q, stacked(record.robot.dq_p, record.reference.dq_m));
    played.pushed.push_back(pushed_time(drawn, sample.truth.twist));
    played.meant.push_back(pushed_time(drawn, chain.twist(scenario.device.model.handle)));
    if (is_shown) print_cycle(scenario, sample, since, played.pushed.back(), played.meant.back());
  });
  return played;
}

// Plays a start with its push and without it: the difference is what the push has done.
Result judge(const DrawnStart& drawn, double push_s, bool is_shown) {
  const Played played = play(drawn, push_s, 1.0, is_shown), still = play(drawn, push_s, 0.0, false);
  Result result = played.result;
  if (result.has_fault() || result.is_refused()) return result;
  const double dt = drawn.scenario.device.model.dt();
  const double ramped = drawn.scenario.script.script.grasp_s + push_s - result.running_s;
  const auto forces = [&](double since) { return std::min((ramped + since) / kRampIn, 1.0); };
  result.free_s = 0.0;
  double wanted = 0.0;  // s, of the free twin's motion by kFree
  for (double since = dt; since <= kFree; since += dt) wanted += dt * forces(since);
  for (std::size_t k = 0; k < std::min(played.pushed.size(), still.pushed.size()); ++k) {
    const double since = dt * static_cast<double>(k + 1);
    const double share = (played.pushed[k] - still.pushed[k]) / wanted;
    if (since <= kPushed && !(share > kShare)) result.free_s = since + dt;
    if (since > kFree + 1e-9) continue;
    result.share = share;
    result.meant = (played.meant[k] - still.meant[k]) / wanted;
  }
  return result;
}

struct Count {
  int starts = 0, faults = 0, refused = 0;
  int late = 0;  // not free within kFree
  int held = 0;  // of these: not by the law, the others by drives and springs behind it
  int none = 0;  // no start of this kind, or no push that leads out, was found
  std::vector<double> free_s;

  void add(const Result& result) {
    ++starts;
    faults += result.has_fault();
    refused += result.is_refused();
    late += result.is_late();
    held += result.is_late() && result.meant < kShare;
    if (!result.has_fault() && !result.is_refused()) {
      free_s.push_back(result.free_s);
    }
  }
  double free_in(double part) const {
    std::vector<double> sorted = free_s;
    std::ranges::sort(sorted);
    if (sorted.empty()) return 0.0;
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  }
};

using Counts = std::map<std::string, Count>;

void print(const std::string& title, const Counts& counts) {
  fmt::print("{:24} starts faults refused late held none  free: median, 95 %, all\n", title);
  for (const auto& [name, count] : counts) {
    fmt::print("{:24} {:6} {:6} {:7} {:4} {:4} {:4}  {:.3f} {:.3f} {:.3f} s\n", name, count.starts,
               count.faults, count.refused, count.late, count.held, count.none, count.free_in(0.5),
               count.free_in(0.95), count.free_in(1.0));
  }
}

void print(int number, const Arm& arm, StartKind kind, const DrawnStart& drawn, double push_s,
           const Result& result) {
  fmt::print("{} {}, {}{}: ", number, arm.name, to_string(kind), drawn.place);
  if (result.has_fault()) {
    fmt::print("{} [{}] {:.3f} s after the push, ", to_string(result.fault), result.fault_index,
               result.fault_s);
  }
  if (result.is_refused()) fmt::print("{}, ", result.refusal);
  fmt::print(
      "free after {:.3f} s, {:.2f} of the speed ({:.2f} by the law); singular value {:.2g} "
      "m, {:.2f} N and {:.2f} Nm after {:.3f} s\n",
      result.free_s, result.share, result.meant, drawn.smallest_singular,
      drawn.push.head<3>().norm(), drawn.push.tail<3>().norm(), push_s);
  std::fflush(stdout);
}

int number_of(const char* name, int otherwise) {
  const char* given = std::getenv(name);
  return given == nullptr ? otherwise : std::atoi(given);
}

TEST(RandomStarts, AreFreeAndWithoutAFault) {
  const int starts = number_of("HG_STARTS", 108), only = number_of("HG_START", -1);
  const std::vector<Arm> all = arms();
  Counts by_arm, by_kind;
  for (int k = std::max(only, 0); k < (only < 0 ? starts : only + 1); ++k) {
    const int arms = static_cast<int>(all.size());
    const Arm& arm = all[static_cast<std::size_t>(k % arms)];
    const auto kind = static_cast<StartKind>(k / arms % kStartKinds);
    Count &of_arm = by_arm[arm.name], &of_kind = by_kind[std::string(to_string(kind))];
    const auto seed = static_cast<std::uint64_t>(k);
    const auto drawn = StartDraw(arm.scenario, seed).draw(kind);
    if (!drawn) {
      ++of_arm.none, ++of_kind.none;
      continue;
    }
    const double push_s = drawn->is_pushed_out ? 0.35 : Random(seed).between(0.02, 0.35);
    const Result result = judge(*drawn, push_s, only >= 0);
    of_arm.add(result);
    of_kind.add(result);
    if (result.has_fault() || result.is_refused() || result.is_late() || only >= 0) {
      print(k, arm, kind, *drawn, push_s, result);
    }
    EXPECT_FALSE(result.has_fault()) << k;
    EXPECT_FALSE(result.is_refused() && !result.has_fault()) << k;
  }
  print("arm", by_arm);
  print("kind", by_kind);
  Count sum;
  for (const auto& [name, count] : by_arm) {
    sum.starts += count.starts, sum.held += count.held, sum.none += count.none;
  }
  EXPECT_LE(sum.held, sum.starts / kHeldOf);
  EXPECT_LE(sum.late, sum.starts / kLateOf);
  EXPECT_LE(sum.none, sum.starts / 5);
}

}  // namespace
}  // namespace hg
