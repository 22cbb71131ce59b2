#include "hg/controller/safety/collision/guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "hg/controller/safety/collision/reach_bounds.h"
#include "hg/controller/safety/collision/test/devices.h"
#include "hg/core/allocation_counter.h"

namespace hg::collision {
namespace {

// Time in which joints come to rest that slow down in one proportion: nearly that of the slowest.
double time_of_all(const Braking& braking, const VectorPM& dq) {
  double sum = 0.0;
  for (Eigen::Index i = braking.separate; i < dq.size(); ++i) {
    sum += std::pow(std::abs(dq[i]) / braking.deceleration[i], 8.0);
  }
  return std::pow(sum, 1.0 / 8.0);
}

// Deceleration of joint `i`, where no end is near.
double deceleration_of(const Braking& braking, const VectorPM& dq, Eigen::Index i) {
  if (i < braking.separate || dq[i] == 0.0) return braking.deceleration[i];
  return std::abs(dq[i]) / time_of_all(braking, dq);
}

// Brute force: the smallest distance of a pair while all joints brake, with no bound but samples.
class Judge {
 public:
  explicit Judge(const TestDevice& device)
      : config_(device.config),
        braking_(device.braking),
        chain_(device.chain),
        pairs_(device.config.pairs) {
    for (const Pair& pair : pairs_.watched) distances_.push_back(distance_of(pair.a, pair.b));
  }

  Distance distance_of(int a, int b) const { return {config_.shapes[a], config_.shapes[b]}; }

  double at(const VectorPM& q, int a, int b, const Distance& distance) {
    chain_.update_poses(q);
    return distance(pose(a), pose(b));
  }

  double along_braking(std::size_t pair, const VectorPM& q, const VectorPM& dq, int samples) {
    double smallest = kInfinity;
    VectorPM x = q;
    for (int k = 0; k <= samples; ++k) {
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const double deceleration = deceleration_of(braking_, dq, i);
        const double t_stop = braking_.reaction[i] + std::abs(dq[i]) / deceleration;
        const double t = std::min(1.2 * k / samples, t_stop);
        const double braking = std::max(0.0, t - braking_.reaction[i]);
        x[i] = q[i] + dq[i] * t - std::copysign(0.5 * deceleration * braking * braking, dq[i]);
      }
      smallest = std::min(smallest,
                          at(x, pairs_.watched[pair].a, pairs_.watched[pair].b, distances_[pair]));
    }
    return smallest;
  }

 private:
  Pose pose(int shape) const {
    const int frame = config_.shapes[shape].frame;
    return frame < 0 ? Pose{} : chain_.pose(frame);
  }

  CollisionConfig config_;
  Braking braking_;
  model::ChainData chain_;
  Pairs pairs_;
  std::vector<Distance> distances_;
};

// Joints that wander within their range at up to full speed.
class Wanderer {
 public:
  Wanderer(const TestDevice& device, unsigned seed)
      : random_(seed), braking_(device.braking), range_(device.range) {
    for (const model::Joint& joint : device.chain.joints()) speed_.push_back(joint.velocity_max);
    q = VectorPM::Zero(8);
    dq = VectorPM::Zero(8);
    goal_ = VectorPM::Zero(8);
    jump();
  }

  void jump() {
    for (int i = 0; i < 8; ++i) {
      q[i] = uniform(lower(i), upper(i));
      dq[i] = uniform(-speed_[i], speed_[i]);
    }
  }

  void move() {
    for (int i = 0; i < 8; ++i) {
      if (uniform(0.0, 1.0) < 0.002) goal_[i] = uniform(-speed_[i], speed_[i]);
      const double step = 1e-3 * braking_.deceleration[i];
      dq[i] += std::clamp(goal_[i] - dq[i], -step, step);
      q[i] += 1e-3 * dq[i];
      if (q[i] < lower(i) || q[i] > upper(i)) {
        q[i] = std::clamp(q[i], lower(i), upper(i));
        dq[i] = 0.0;
        goal_[i] = -goal_[i];
      }
    }
  }

  VectorPM q, dq;

 private:
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }
  double lower(std::size_t i) const { return std::max(range_[i].lb, -std::numbers::pi); }
  double upper(std::size_t i) const { return std::min(range_[i].ub, std::numbers::pi); }

  std::mt19937 random_;
  Braking braking_;
  std::vector<Interval> range_;
  std::vector<double> speed_;
  VectorPM goal_;
};

// A device whose joints wander, watched by a guard and by the judge.
struct Watch {
  explicit Watch(unsigned from) : seed(from), wanderer(device, seed) {}

  const unsigned seed;
  const TestDevice device = device_of(folding_urdf());
  Guard guard{device.config, device.braking, device.chain};
  Judge judge{device};
  Wanderer wanderer;
  CollisionState state;
};

// A fast wrist needs longer than the others: they take as long, and stay on their line.
TEST(Braking, StopsAllJointsOfTheArmInOneProportion) {
  Braking braking = device_of(folding_urdf()).braking;
  VectorPM q = VectorPM::Zero(8), dq(8);
  dq << 0.5, 0.0, 0.2, -0.4, 0.6, -2.4, 1.0, 0.0;
  const VectorPM a = decelerations(braking, q, dq);
  EXPECT_EQ(a[0], 2.0);  // the gantry brakes for itself
  const double time = 2.4 / a[5];
  EXPECT_NEAR(time, 2.4 / 8.0, 0.01);
  for (int i = 2; i < 7; ++i) {
    EXPECT_NEAR(std::abs(dq[i]) / a[i], time, 1e-12) << i;
    EXPECT_LE(a[i], braking.deceleration[i]) << i;
  }
  // half way nothing has changed
  const VectorPM later = decelerations(braking, q, 0.5 * dq);
  for (int i = 2; i < 7; ++i) EXPECT_NEAR(later[i], a[i], 1e-9) << i;
}

TEST(Braking, BrakesHarderInFrontOfAnEnd) {
  Braking braking = device_of(folding_urdf()).braking;
  braking.lowest = VectorPM::Constant(8, -kInfinity);
  braking.highest = VectorPM::Constant(8, kInfinity);
  braking.highest[2] = 0.1;
  VectorPM q = VectorPM::Zero(8), dq = VectorPM::Zero(8);
  dq[2] = 1.0;
  dq[5] = -2.4;
  const VectorPM a = decelerations(braking, q, dq);
  const double left = 0.1 - braking.reaction[2] * 1.0;
  EXPECT_NEAR(a[2], 0.5 / left, 1e-12);
  EXPECT_NEAR(2.4 / a[5], 2.4 / 8.0, 0.01);
  q[2] = 0.0999;
  EXPECT_EQ(decelerations(braking, q, dq)[2], 1.5 * braking.deceleration[2]);
  dq[2] = -1.0;  // away from it
  EXPECT_NEAR(decelerations(braking, q, dq)[2], 1.0 / (2.4 / a[5]), 1e-9);
}

TEST(Guard, ReportsFreeOnlyWhereBrakingStaysFree) {
  const TestDevice device = device_of(folding_urdf());
  Guard guard(device.config, device.braking, device.chain);
  Judge judge(device);
  const unsigned seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Wanderer wanderer(device, seed);
  int free = 0;
  int braked = 0;
  int needless = 0;
  for (int n = 0; n < 400; ++n) {
    wanderer.jump();
    CollisionState state;
    const bool must_brake = guard.step(wanderer.q, wanderer.dq, true, state).must_brake;
    double smallest = kInfinity;
    for (std::size_t pair = 0; pair < device.config.pairs.watched.size(); ++pair) {
      smallest = std::min(smallest, judge.along_braking(pair, wanderer.q, wanderer.dq, 120));
    }
    if (!must_brake) {
      ++free;
      EXPECT_GE(smallest, device.config.safe_distance - 1e-3) << "state " << n;
    } else {
      ++braked;
      needless += smallest > device.config.safe_distance + 0.02 ? 1 : 0;
    }
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(braked, 15);
  EXPECT_EQ(needless, 0) << "braked " << braked;
}

TEST(Guard, RemembersBoundsThatHold) {
  Watch watch(12);
  SCOPED_TRACE("seed " + std::to_string(watch.seed));
  auto& [seed, device, guard, judge, wanderer, state] = watch;
  long distances = 0;
  int worst = 0;
  double needless = 0.0;  // largest distance of a pair because of which the device had to brake
  constexpr int kCycles = 20000;
  for (int n = 0; n < kCycles; ++n) {
    wanderer.move();
    const bool is_first = state.count == 0;
    const Prediction prediction = guard.step(wanderer.q, wanderer.dq, true, state);
    if (!is_first) {
      distances += prediction.distances;
      worst = std::max(worst, prediction.distances);
    }
    if (prediction.must_brake) {
      const auto pair = static_cast<std::size_t>(prediction.report.pair);
      needless = std::max(needless, judge.along_braking(pair, wanderer.q, wanderer.dq, 120));
    }
    if (n % 50 != 0) continue;
    for (std::size_t pair = 0; pair < device.config.pairs.watched.size(); ++pair) {
      const double smallest = judge.along_braking(pair, wanderer.q, wanderer.dq, 30);
      ASSERT_LE(state.left[pair] + state.allowed[pair], smallest + 1e-6)
          << pair_names(device.config)[pair] << " in cycle " << n;
    }
  }
  EXPECT_LE(worst, most_distances(device.braking.period) + 1);
  EXPECT_LT(static_cast<double>(distances) / kCycles, 6.0);
  EXPECT_LT(needless, device.config.safe_distance + 0.02);
  RecordProperty("distances_per_cycle", std::to_string(static_cast<double>(distances) / kCycles));
}

// A slow loop sees more motion in a cycle, so bounds last for fewer cycles.
TEST(Guard, ASlowLoopBrakesNoMoreThanAFastOne) {
  constexpr int kSlower = 50;
  const TestDevice device = device_of(folding_urdf());
  Braking braking = device.braking;
  braking.period = 1e-3 * kSlower;
  Guard guard(device.config, braking, device.chain);
  Judge judge(device);
  const unsigned seed = 15;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Wanderer wanderer(device, seed);
  CollisionState state;
  int worst = 0;
  for (int n = 0; n < 5000; ++n) {
    for (int i = 0; i < kSlower; ++i) wanderer.move();
    const bool is_first = state.count == 0;
    const Prediction prediction = guard.step(wanderer.q, wanderer.dq, true, state);
    if (!is_first) worst = std::max(worst, prediction.distances);
    if (!prediction.must_brake) continue;
    const auto pair = static_cast<std::size_t>(prediction.report.pair);
    EXPECT_LT(judge.along_braking(pair, wanderer.q, wanderer.dq, 120),
              device.config.safe_distance + 0.02)
        << pair_names(device.config)[pair] << " in cycle " << n;
  }
  EXPECT_LE(worst, most_distances(braking.period) + 1);
}

TEST(Guard, BrakesInTimeWhenAJointGoesForACollision) {
  const TestDevice device = device_of(folding_urdf());
  Guard guard(device.config, device.braking, device.chain);
  Judge judge(device);
  for (const double speed : {0.1, 0.5, 1.0, 2.0}) {
    CollisionState state;
    VectorPM q = VectorPM::Zero(8);
    q << 0.0, 0.0, 0.0, 1.2, -0.7, 1.2, 0.3, 0.0;
    VectorPM dq = VectorPM::Zero(8);
    dq[3] = speed;
    bool must_brake = false;
    for (int n = 0; n < 30000 && !must_brake; ++n) {
      must_brake = guard.step(q, dq, true, state).must_brake;
      if (!must_brake) q += 1e-3 * dq;
    }
    ASSERT_TRUE(must_brake) << speed;
    // it stops where the safe distance begins, not much before
    double nearest = kInfinity;
    for (std::size_t pair = 0; pair < device.config.pairs.watched.size(); ++pair) {
      nearest = std::min(nearest, judge.along_braking(pair, q, dq, 300));
    }
    EXPECT_GT(nearest, device.config.safe_distance - 5e-3) << speed;
    EXPECT_LT(nearest, device.config.safe_distance + 5e-3) << speed;
  }
}

TEST(Guard, LetsADeviceLeaveAPlaceThatIsTooNear) {
  const TestDevice device = device_of(folding_urdf());
  Guard guard(device.config, device.braking, device.chain);
  CollisionState state;
  VectorPM q = VectorPM::Zero(8);
  q << 0.0, 0.0, 0.0, 2.94, -0.7, 1.2, 0.3, 0.0;  // drop tube 15 mm from the first link
  VectorPM dq = VectorPM::Zero(8);
  EXPECT_FALSE(guard.step(q, dq, false, state).must_brake);
  EXPECT_FALSE(guard.step(q, dq, true, state).must_brake);

  CollisionState away = state;
  dq[3] = -0.2;
  EXPECT_FALSE(guard.step(q, dq, true, away).must_brake);
  for (int n = 0; n < 3000; ++n) {
    q += 1e-3 * dq;
    ASSERT_FALSE(guard.step(q, dq, true, away).must_brake) << n;
  }
  dq[3] = 0.2;  // once it was far, the whole safe distance counts again
  for (int n = 0; n < 2800; ++n) {
    q += 1e-3 * dq;
    if (guard.step(q, dq, true, away).must_brake) break;
  }
  EXPECT_LT(q[3], 2.93);

  q[3] = 2.94;
  dq[3] = 0.4;                                             // 10 mm to stop
  EXPECT_TRUE(guard.step(q, dq, true, state).must_brake);  // and not nearer
}

// Joints that turn about the axes of what lies along them: levers alone would see collisions.
TEST(Guard, TakesNoTurnOnTheSpotForACollision) {
  Watch watch(21);
  SCOPED_TRACE("seed " + std::to_string(watch.seed));
  auto& [seed, device, guard, judge, wanderer, state] = watch;
  int braked = 0;
  for (int n = 0; n < 30000; ++n) {
    wanderer.move();
    wanderer.dq.tail(3) = wanderer.dq.tail(3).cwiseSign() * 6.0;
    const Prediction prediction = guard.step(wanderer.q, wanderer.dq, true, state);
    if (!prediction.must_brake) continue;
    ++braked;
    const auto pair = static_cast<std::size_t>(prediction.report.pair);
    EXPECT_LT(judge.along_braking(pair, wanderer.q, wanderer.dq, 120),
              device.config.safe_distance + 5e-3)
        << pair_names(device.config)[pair] << " in cycle " << n;
  }
  EXPECT_GT(braked, 0);
}

// The change that the law is given is that of the distance it is given, and braking as foreseen
// never shrinks it.
void expect_kept_apart(const TestDevice& device) {
  constexpr double kStep = 1e-5;  // s
  Guard guard(device.config, device.braking, device.chain);
  const unsigned seed = 22;
  SCOPED_TRACE("seed " + std::to_string(seed));
  Wanderer wanderer(device, seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  int checked = 0, wrong = 0;
  for (int n = 0; n < 3000; ++n) {
    wanderer.jump();
    CollisionState state;
    guard.step(wanderer.q, wanderer.dq, true, state);
    const CollisionTask task = guard.keep_apart(wanderer.q, wanderer.dq, state);
    if (!(task.distance > 0.0 && task.distance < 0.05)) continue;
    VectorPM ddq = device.braking.deceleration;
    for (double& value : ddq) value *= share(random);
    const VectorPM q = wanderer.q + kStep * wanderer.dq, dq = wanderer.dq + kStep * ddq;
    const double change = (guard.keep_apart(q, dq, state).distance - task.distance) / kStep;
    const double foreseen = task.rate + task.per_acceleration.dot(ddq);
    ++checked;
    if (std::abs(change - foreseen) > 0.02 * (0.1 + std::abs(foreseen))) ++wrong;
    Braking gentle = device.braking;
    gentle.deceleration *= 0.6;
    gentle.reaction.array() += 0.04;
    VectorPM braking = decelerations(gentle, wanderer.q, wanderer.dq);
    for (int i = 0; i < 8; ++i) braking[i] = -std::copysign(braking[i], wanderer.dq[i]);
    EXPECT_GT(task.rate + task.per_acceleration.dot(braking), -0.05) << n;
  }
  EXPECT_GT(checked, 40);
  EXPECT_LT(wrong, checked / 20) << checked;  // another place has become the nearest
}

TEST(Guard, KeepsApartByTheChangeOfTheForeseenDistance) {
  expect_kept_apart(device_of(folding_urdf()));
}

// A joint brakes harder in front of its end, and the others swing round it.
TEST(Guard, KeepsApartAlsoWhereJointsMeetTheirEnds) {
  TestDevice device = device_of(folding_urdf());
  device.braking.lowest = device.braking.highest = VectorPM::Zero(8);
  for (Eigen::Index i = 0; i < 8; ++i) {
    device.braking.lowest[i] = device.range[static_cast<std::size_t>(i)].lb;
    device.braking.highest[i] = device.range[static_cast<std::size_t>(i)].ub;
  }
  expect_kept_apart(device);
}

TEST(Guard, GivesTheSameBitsFromTheSameState) {
  const TestDevice device = device_of(folding_urdf());
  Guard guard(device.config, device.braking, device.chain);
  Guard other(device.config, device.braking, device.chain);
  Wanderer wanderer(device, 13);
  CollisionState state;
  for (int n = 0; n < 3000; ++n) {
    wanderer.move();
    CollisionState copy = state;
    const Prediction a = guard.step(wanderer.q, wanderer.dq, true, state);
    const Prediction b = other.step(wanderer.q, wanderer.dq, true, copy);
    ASSERT_EQ(a.report.distance, b.report.distance);
    ASSERT_EQ(std::memcmp(state.left.data(), copy.left.data(), sizeof(state.left)), 0);
    if (n % 100 == 0) other = Guard(device.config, device.braking, device.chain);
  }
}

TEST(Guard, AllocatesNothing) {
  const TestDevice device = device_of(folding_urdf());
  Guard guard(device.config, device.braking, device.chain);
  Wanderer wanderer(device, 14);
  CollisionState state;
  const AllocationCounter allocations;
  for (int n = 0; n < 2000; ++n) {
    wanderer.move();
    guard.step(wanderer.q, wanderer.dq, true, state);
    guard.keep_apart(wanderer.q, wanderer.dq, state);
  }
  EXPECT_EQ(allocations.count(), 0U);
}

TEST(ReachBounds, BoundEveryPointOfTheCoreInEveryPosture) {
  const TestDevice device = device_of(folding_urdf());
  const ReachBounds reach_bounds(device.chain, device.range);
  model::ChainData chain(device.chain);
  Wanderer wanderer(device, 15);
  std::vector<double> largest(8, 0.0);
  const Shape& hand = *std::ranges::find(device.config.shapes, "hand", &Shape::name);
  const VectorPM lever = reach_bounds.of(hand, 0);
  const VectorPM none = VectorPM::Zero(8);
  for (int n = 0; n < 5000; ++n) {
    wanderer.jump();
    chain.update_kinematics(wanderer.q, none);
    const model::Jacobian J = chain.jacobian(hand.frame);
    const Pose T_B_shape = chain.pose(hand.frame) * hand.T_frame_shape;
    for (const double end : {-hand.half_length, hand.half_length}) {
      const Eigen::Vector3d arm = T_B_shape.p + end * T_B_shape.R.col(2) - chain.pose(hand.frame).p;
      for (int i = 0; i < 8; ++i) {
        const Vector6 column = J.col(i);
        const Eigen::Vector3d v = column.head<3>() + column.tail<3>().cross(arm);
        largest[i] = std::max(largest[i], v.norm());
      }
    }
  }
  for (int i = 0; i < 8; ++i) {
    EXPECT_LE(largest[i], lever[i] + 1e-9) << i;
    EXPECT_GE(largest[i], 0.6 * lever[i]) << i;  // and not for nothing
  }
}

}  // namespace
}  // namespace hg::collision
