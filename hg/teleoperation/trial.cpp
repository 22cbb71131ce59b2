#include "hg/teleoperation/trial.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hg/core/error.h"
#include "hg/teleoperation/remote_half.h"

namespace hg::teleoperation {
namespace {

constexpr double kCalm = 2e-3;  // m/s

// Goal of the hand: to `far`, rest, back to 0, three times.
class Path {
 public:
  Path(const TrialConfig& config, double far)
      : config_(config), far_(far), way_s_(far / config.approach_speed) {}

  double duration_s() const noexcept {
    return 3.0 * (kWait + 2.0 * way_s_) + 2.0 * config_.hold + config_.regulation;
  }
  // Press of time t, from 0, and the time since the goal has come to rest there.
  struct Press {
    int number;
    double since;
  };
  Press press(double t) const noexcept {
    const double period = kWait + 2.0 * way_s_ + config_.hold;
    const int number = std::clamp(static_cast<int>(t / period), 0, 2);
    return {number, t - number * period - kWait - way_s_};
  }
  bool rests(double t) const noexcept {
    const auto [number, since] = press(t);
    return number < 2 && since > config_.hold - 1.0 && since <= config_.hold;
  }
  // The first second of the third press is left out.
  bool regulates(double t) const noexcept {
    const auto [number, since] = press(t);
    return number == 2 && since > 1.0 && since <= config_.regulation;
  }
  double goal(double t) const noexcept {
    const auto [number, since] = press(t);
    const double hold = number < 2 ? config_.hold : config_.regulation;
    const double speed = config_.approach_speed;
    if (since < 0.0) return std::max(0.0, far_ + speed * since);
    return std::max(0.0, far_ - speed * std::max(0.0, since - hold));
  }
  double speed(double t) const noexcept {
    constexpr double kStep = 1e-4;
    return (goal(t + kStep) - goal(t)) / kStep;
  }
  // Where the wall is.
  double wall(double t) const noexcept {
    const auto [number, since] = press(t);
    const bool moves = number == 2 && since > 0.0 && since <= config_.regulation;
    const double phase = 2.0 * std::numbers::pi * since / config_.wall_period;
    return config_.distance - (moves ? config_.wall_motion * std::sin(phase) : 0.0);
  }

 private:
  static constexpr double kWait = 1.0;  // s
  TrialConfig config_;
  double far_, way_s_;
};

// A body in a hand, along x.
class Leader {
 public:
  explicit Leader(const TrialConfig& config)
      : config_(config),
        arm_(config.hand),
        late_(static_cast<std::size_t>(config.late / config.dt + 1.5), 0.0) {
    x_ = v_ = PortVector::Zero(1);
    arm_.grasp({});
  }

  double feel(double goal, double goal_speed) noexcept {
    person::HandleMotion handle;
    handle.T_B_H.p.x() = x_[0];
    handle.twist[0] = v_[0];
    person::Goal aim;
    aim.pose.p.x() = goal;
    aim.twist[0] = goal_speed;
    arm_.step(config_.dt, handle, aim, Eigen::Vector3d::Zero());
    std::rotate(late_.begin(), late_.begin() + 1, late_.end());
    late_.back() = arm_.wrench()[0];
    return late_.front();
  }
  void move(double force) noexcept {
    const double a = (force - config_.body_damping * v_[0]) / config_.body_mass;
    x_[0] += config_.dt * (v_[0] + 0.5 * config_.dt * a);
    v_[0] += config_.dt * a;
  }
  double hand_force() const noexcept { return arm_.wrench()[0]; }
  const PortVector& x() const noexcept { return x_; }
  const PortVector& v() const noexcept { return v_; }

 private:
  TrialConfig config_;
  person::Arm arm_;
  std::vector<double> late_;
  PortVector x_, v_;
};

// Sums over a trial.
class Figures {
 public:
  explicit Figures(const TrialConfig& config)
      : press_(config.press),
        behind_(static_cast<std::size_t>(config.link.delay / config.dt + 1.5), 0.0) {}

  void add(const TrialMoment& now, const Path& path) noexcept {
    result_.peak_hand = std::max(result_.peak_hand, std::abs(now.f_hand));
    result_.peak_wall = std::max(result_.peak_wall, std::abs(now.f_wall));
    result_.created = std::max(result_.created, -(now.energy_leader + now.energy_remote));
    result_.created_leader = std::max(result_.created_leader, -now.energy_leader);
    behind_[samples_ % behind_.size()] = now.x_leader;
    const double then = behind_[(samples_ + 1) % behind_.size()];
    ++samples_;
    position_ += (then - now.x_remote) * (then - now.x_remote);
    force_ += (now.f_leader - now.f_wall) * (now.f_leader - now.f_wall);
    if (path.regulates(now.time_s)) {
      ++regulating_;
      regulation_ += (now.f_wall - press_) * (now.f_wall - press_);
    }
    if (!path.rests(now.time_s)) return;
    ++resting_;
    speed_ += now.v_leader * now.v_leader;
    const bool is_first = path.press(now.time_s).number == 0;
    (is_first ? result_.first_offset : result_.rest_offset) = std::abs(now.x_leader - now.x_remote);
    if (!is_first) result_.rest_force_error = std::abs(now.f_leader - now.f_wall);
  }
  TrialResult result(double duration_s) const noexcept {
    TrialResult result = result_;
    const auto n = static_cast<double>(samples_);
    result.duration_s = duration_s;
    result.vibration = std::sqrt(speed_ / std::max(1.0, static_cast<double>(resting_)));
    result.is_stable = result.vibration < kCalm;
    result.position_rms = std::sqrt(position_ / n);
    result.force_rms = std::sqrt(force_ / n);
    result.regulation_rms =
        std::sqrt(regulation_ / std::max(1.0, static_cast<double>(regulating_)));
    return result;
  }

 private:
  double press_;
  TrialResult result_;
  std::vector<double> behind_;
  std::size_t samples_ = 0, resting_ = 0, regulating_ = 0;
  double position_ = 0.0, force_ = 0.0, speed_ = 0.0, regulation_ = 0.0;
};

SimulatedMachineConfig machine_of(const TrialConfig& config) {
  Wall wall;
  wall.normal = PortVector::Constant(1, -1.0);
  wall.offset = -config.distance;
  wall.stiffness = config.wall_stiffness;
  wall.damping = config.wall_damping;
  return {.impedance = config.machine, .walls = {wall}, .x_start = PortVector::Zero(1)};
}

void check_trial(const TrialConfig& config) {
  const auto positive = [](const char* name, double value) {
    if (std::isfinite(value) && value > 0.0) return;
    throw SetupError(std::string("trial: ") + name + " must be positive, got " +
                     std::to_string(value));
  };
  positive("dt", config.dt);
  positive("wall_stiffness", config.wall_stiffness);
  positive("body_mass", config.body_mass);
  positive("approach_speed", config.approach_speed);
  positive("distance", config.distance);
  positive("press", config.press);
  positive("hold", config.hold);
  positive("regulation", config.regulation);
  positive("wall_period", config.wall_period);
}

}  // namespace

TrialResult play_trial(const TrialConfig& config, const TrialObserver& observer) {
  check_trial(config);
  const LimiterConfig limits = {.axes = {{.range = {-1.0, 1.0}, .v_max = 2.0, .a_max = 200.0}}};
  LeaderHalf leader_half(config.make_leader ? config.make_leader(config)
                                            : make_leader_method(config.method, config.dt),
                         config.leader, config.dt);
  RemoteHalf remote_half(config.make_remote
                             ? config.make_remote(config)
                             : make_remote_method(config.method, config.machine, config.dt),
                         config.machine, limits, config.dt);
  SimulatedMachine machine(machine_of(config), config.dt);
  Channel<LeaderPacket> to_remote(config.link, 0, config.dt);
  Channel<RemotePacket> to_leader(config.link, 1, config.dt);
  const Path path(config, config.distance + config.press / config.hand.stiffness.x());
  Leader leader(config);
  Figures figures(config);
  LeaderPacket sent, at_remote;
  RemotePacket answered, at_leader;
  MachineState state;
  const auto steps = static_cast<int>(path.duration_s() / config.dt);
  for (int k = 0; k < steps; ++k) {
    const double t = k * config.dt;
    PortVector f_hand = PortVector::Constant(1, leader.feel(path.goal(t), path.speed(t)));
    while (to_leader.receive(t, at_leader)) leader_half.receive(at_leader, t);
    const PortVector f = leader_half.step(
        t, {.x = leader.x(), .v = leader.v(), .f_hand = f_hand, .is_clutch_closed = true}, sent);
    to_remote.send(sent, t);
    while (to_remote.receive(t, at_remote)) remote_half.receive(at_remote, t);
    machine.move_wall(0, -path.wall(t));
    machine.read(state);
    machine.write(remote_half.step(t, state, answered));
    to_leader.send(answered, t);
    const TrialMoment now = {.time_s = t,
                             .goal = path.goal(t),
                             .wall = path.wall(t),
                             .x_leader = leader.x()[0],
                             .x_remote = state.x[0],
                             .x_target = answered.x_target[0],
                             .v_leader = leader.v()[0],
                             .f_hand = leader.hand_force(),
                             .f_leader = -f[0],
                             .f_wall = -state.f[0],
                             .energy_leader = leader_half.energy().net(),
                             .energy_remote = answered.energy_net};
    figures.add(now, path);
    if (observer) observer(now);
    leader.move(f_hand[0] + (config.is_felt ? f[0] : 0.0));
  }
  return figures.result(path.duration_s());
}

}  // namespace hg::teleoperation
