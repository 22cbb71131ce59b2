#include "hg/scenario/way_to_start.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/scenario/assembly.h"

namespace hg::scenario {
namespace {

constexpr double kLongest = 60.0;  // s

config::Scenario mouse(const std::string& name) {
  config::Scenario run = config::load_scenario("models/scenarios/" + name + ".yaml");
  run.person = person::PersonKind::kMouse;
  run.events.clear();
  return run;
}

// The device of `run` as a trial with a free body leaves it whose handle ends at `hand`.
Start left_at(const config::Scenario& run, const config::HandPose& hand) {
  config::Scenario trial = mouse("path");
  const Pose pose = config::pose_of(hand);
  trial.twin.model.q_start << pose.p, Eigen::Quaterniond(pose.R).coeffs();
  return find_start(run.device, trial.twin);
}

// One way, cycle by cycle.
struct Way {
  Way(const config::Scenario& run, const Start& now)
      : start(find_start(run.device, run.twin)),
        way(way_to_start(run, start, now.q_p, now.q_m)),
        guide(way, start),
        cycle(make_cycle(way)),
        device(make_simulated_device(run, make_simulation(run, now))) {
    sample->operator_input.panel.override_key = true;
  }

  // Until it is over; `meddle` may change the input of the next cycle.
  void play(const std::function<void(Sample&)>& meddle = {}) {
    while (!guide.is_over() && cycle.time_s() < kLongest) {
      device->read(sample->sensors);
      if (meddle) meddle(*sample);
      sample->operator_input.request = guide.request();
      sample->command.hand_target = sample->operator_input.hand_target;
      cycle.step(sample->sensors, sample->operator_input, sample->command, sample->record);
      guide.observe(*sample);
      device->write(sample->command);
    }
  }

  bool moves() const { return sample->record.v_H.norm() > 0.05; }

  Start start;
  config::Scenario way;
  WayGuide guide;
  controller::Cycle cycle;
  std::unique_ptr<device::Device> device;
  std::unique_ptr<Sample> sample = std::make_unique<Sample>();
};

// Ends of trials all over the workspace, in all headings.
std::vector<config::HandPose> ends() {
  std::vector<config::HandPose> ends;
  for (int i = 0; i < 16; ++i) {
    const double side = i % 2 == 0 ? -1.0 : 1.0, depth = (i / 2) % 2 == 0 ? -1.0 : 1.0;
    ends.push_back(
        {.p = {side * (0.4 + 0.2 * (i % 5)), depth * (0.3 + 0.25 * (i % 6)), -0.95 + 0.1 * (i % 4)},
         .azimuth = 0.4 * i - 3.0,
         .pitch = 0.8 + 0.1 * (i % 10),
         .roll = 0.3 * (i % 7) - 0.9});
  }
  return ends;
}

TEST(WayToStart, LeadsFromTheEndsOfTrialsToEveryStart) {
  const std::string names[] = {"door", "excavator", "path"};
  constexpr int kEvery = 3;  // 1: all, 30 s
  for (std::size_t i = 0; i < ends().size(); i += kEvery) {
    SCOPED_TRACE(i);
    const config::Scenario run = mouse(names[i / kEvery % 3]);
    Way way(run, left_at(run, ends()[i]));
    way.play();
    EXPECT_TRUE(way.guide.is_there()) << way.guide.problem();
    EXPECT_LT((way.device->truth()->T_B_H.p - way.start.T_B_H.p).norm(), 5e-3);
    EXPECT_LT(way.guide.gantry_distance(), 0.02);  // the posture is that of the start, too
  }
}

TEST(WayToStart, StopsWhenAHandTakesHold) {
  const config::Scenario run = mouse("door");
  Way way(run, left_at(run, ends()[3]));
  way.play([&](Sample& sample) {
    HandTarget& target = sample.operator_input.hand_target;
    if (way.moves()) target = {.active = true, .p_B = sample.record.T_B_H.p};
  });
  EXPECT_EQ(way.guide.problem(), "a hand took hold of the handle");
}

TEST(WayToStart, StopsWithoutTheKeyAndByTheEmergencyStop) {
  const config::Scenario run = mouse("door");
  const Start now = left_at(run, ends()[3]);
  Way without_key(run, now);
  without_key.play([&](Sample& sample) {
    if (without_key.moves()) sample.operator_input.panel.override_key = false;
  });
  EXPECT_EQ(without_key.guide.problem(), "the override key was turned off");
  Way stopped(run, now);
  stopped.play([&](Sample& sample) {
    if (stopped.moves()) sample.operator_input.panel.emergency_stop = true;
  });
  EXPECT_TRUE(stopped.guide.problem().starts_with("102 ")) << stopped.guide.problem();
}

TEST(WayToStart, WaitsForTheKey) {
  const config::Scenario run = mouse("door");
  Way way(run, left_at(run, ends()[3]));
  bool has_waited = false;
  way.play([&](Sample& sample) {
    sample.operator_input.panel.override_key = way.cycle.time_s() > 3.0;
    if (way.cycle.time_s() < 3.0) {
      EXPECT_NE(sample.record.mode, Mode::kRunning);
      has_waited = has_waited || way.guide.wanted().find("key") != std::string::npos;
    }
  });
  EXPECT_TRUE(has_waited);
  EXPECT_TRUE(way.guide.is_there()) << way.guide.problem();
}

}  // namespace
}  // namespace hg::scenario
