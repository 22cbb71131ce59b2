// The guard of collisions in the loop: an obstacle that the law knows nothing of, hands that go for
// it as fast as the device can, the whole elastic simulation.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "hg/config/simulation/scenario.h"
#include "hg/controller/safety/collision/guard.h"
#include "hg/core/stacked.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/player.h"

namespace hg::experiments {
namespace {

collision::Shape column_at(double x, double y) {
  collision::Shape column = {.name = "obstacle", .half_edges = {0.08, 0.08, 1.4}, .is_box = true};
  column.T_frame_shape.p = {x, y, -0.75};
  return column;
}

void watch(config::DeviceConfig& device) {
  std::vector<Interval> range(device.model.gantry_range.begin(),
                              device.model.gantry_range.begin() + device.model.n_p);
  for (const auto& joint : device.model.joint_limits) range.push_back({joint.q_min, joint.q_max});
  device.collision.pairs =
      collision::choose_pairs(device.collision.shapes, device.model.chain, range,
                              device.collision.safe_distance + collision::kFarEnough);
}

// A hand that wants to be somewhere else every second.
void set_restless_hand(unsigned seed, double duration_s, config::Scenario& scenario) {
  std::mt19937 random(seed);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  person::Script script;
  script.grasp_s = scenario.script.script.grasp_s;
  script.start[person::kGripChannel] = 1.0;
  for (double t = 0.5; t < duration_s; t += uniform(0.4, 1.5)) {
    const double wanted[6] = {uniform(-1.8, 1.8), uniform(-2.1, 2.1), uniform(-1.2, -0.4),
                              uniform(-6.0, 6.0), uniform(-1.0, 1.0), uniform(-2.0, 2.0)};
    for (int channel = 0; channel < 6; ++channel) {
      script.segments.push_back({.start_s = t,
                                 .duration_s = uniform(0.3, 2.0),
                                 .channel = channel,
                                 .value = wanted[channel]});
    }
  }
  script.duration_s = duration_s;
  play_script(scenario, script);
  scenario.script.hand = person::hand(person::HandPreset::kStiff);
}

// The smallest distance of all watched pairs, for the true posture.
class TrueDistance {
 public:
  explicit TrueDistance(const config::DeviceConfig& device)
      : config_(device.collision), chain_(device.model.chain) {
    for (const collision::Pair& pair : config_.pairs.watched) {
      distances_.emplace_back(shape(pair.a), shape(pair.b));
    }
  }
  double at(const Truth& truth) {
    const VectorPM q = stacked(truth.q_p, truth.q_m);
    chain_.update_poses(q);
    double smallest = kInfinity;
    for (std::size_t i = 0; i < distances_.size(); ++i) {
      const collision::Pair& pair = config_.pairs.watched[i];
      smallest = std::min(smallest, distances_[i](pose(shape(pair.a)), pose(shape(pair.b))));
    }
    return smallest;
  }

 private:
  const collision::Shape& shape(int i) const { return config_.shapes[i]; }
  Pose pose(const collision::Shape& shape) const {
    return shape.frame < 0 ? Pose{} : chain_.pose(shape.frame);
  }

  collision::CollisionConfig config_;
  model::ChainData chain_;
  std::vector<collision::Distance> distances_;
};

TEST(CollisionRun, FastRandomMotionsStopBeforeAnObstacle) {
  config::Scenario scenario = config::load_scenario("models/scenarios/walk.yaml");
  constexpr int kRuns = 12;
  int stopped = 0;
  double fastest = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const auto seed = static_cast<unsigned>(100 + run);
    config::Scenario tried = scenario;
    set_restless_hand(seed, 12.0, tried);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1.4, 1.4);
    for (int obstacle = 0; obstacle < 2; ++obstacle) {
      tried.device.collision.shapes.push_back(column_at(place(random), place(random)));
    }
    watch(tried.device);
    TrueDistance distance(tried.device);
    Player player(tried);
    double smallest = kInfinity;
    bool begins_free = true;
    for (bool has_more = true; has_more; has_more = player.end()) {
      player.begin();
      player.run();
      const double now = distance.at(player.truth());
      if (player.record().cycle == 0) begins_free = now > 0.05;
      if (!begins_free) break;
      smallest = std::min(smallest, now);
      fastest = std::max(fastest, player.truth().twist.head<3>().norm());
    }
    if (!begins_free) continue;
    const Fault fault = player.record().fault;
    if (fault.code == FaultCode::kCollisionAhead) ++stopped;
    // the safe distance, less what the elastic joints give way
    EXPECT_GT(smallest, 0.02) << "seed " << seed;
  }
  EXPECT_GT(stopped, kRuns / 3);
  EXPECT_GT(fastest, 1.0);
}

TEST(CollisionRun, NoScenarioIsStoppedWithoutNeed) {
  for (const char* name : {"path", "walk"}) {
    config::Scenario scenario =
        config::load_scenario(std::string("models/scenarios/") + name + ".yaml");
    scenario.duration_s = 20.0;
    Player player(scenario);
    double nearest = kInfinity;
    for (bool has_more = true; has_more; has_more = player.end()) {
      player.begin();
      player.run();
      nearest = std::min(nearest, player.record().collision.distance);
    }
    EXPECT_EQ(player.record().fault.code, FaultCode::kNone) << name;
    EXPECT_GT(nearest, 0.03) << name;
    EXPECT_LT(nearest, 10.0) << name << ": something was watched";
  }
}

}  // namespace
}  // namespace hg::experiments
