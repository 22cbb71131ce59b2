#include "hg/teleoperation/grid.h"

#include <map>
#include <utility>

namespace hg::teleoperation {
namespace {

TrialConfig trial_of(const GridCase& wanted, const Grid& grid) {
  TrialConfig config;
  config.method.kind = wanted.method;
  config.link = {
      .delay = wanted.delay, .jitter = wanted.jitter, .loss = wanted.loss, .seed = grid.seed};
  config.wall_stiffness = wanted.wall;
  config.hand = person::hand(wanted.hand);
  config.press = grid.press;
  config.hold = grid.hold;
  return config;
}

}  // namespace

Grid full_grid() {
  Grid grid;
  grid.delays = {0.0, 0.02, 0.05, 0.1, 0.2, 0.4};
  grid.jitters = {0.0, 0.02};
  grid.losses = {0.0, 0.05, 0.1};
  grid.walls = {1e3, 5e3, 1e4};
  return grid;
}

std::vector<GridCase> play_grid(const Grid& grid,
                                const std::function<void(const GridCase&)>& played) {
  std::map<std::pair<double, person::HandPreset>, double> undelayed, unfelt;
  for (const double wall : grid.walls) {
    for (const person::HandPreset hand : grid.hands) {
      GridCase reference = {.method = MethodKind::kPositionForce, .wall = wall, .hand = hand};
      TrialConfig config = trial_of(reference, grid);
      undelayed[{wall, hand}] = play_trial(config).peak_hand;
      config.is_felt = false;
      unfelt[{wall, hand}] = play_trial(config).regulation_rms;
    }
  }
  std::vector<GridCase> cases;
  for (const MethodKind method : grid.methods) {
    for (const double delay : grid.delays) {
      for (const double jitter : grid.jitters) {
        for (const double loss : grid.losses) {
          for (const double wall : grid.walls) {
            for (const person::HandPreset hand : grid.hands) {
              cases.push_back({.method = method,
                               .delay = delay,
                               .jitter = jitter,
                               .loss = loss,
                               .wall = wall,
                               .hand = hand});
            }
          }
        }
      }
    }
  }
  for (GridCase& one : cases) {
    TrialConfig config = trial_of(one, grid);
    config.make_leader = grid.make_leader;
    config.make_remote = grid.make_remote;
    one.result = play_trial(config);
    one.peak_ratio = one.result.peak_hand / undelayed.at({one.wall, one.hand});
    one.unfelt_rms = unfelt.at({one.wall, one.hand});
    if (played) played(one);
  }
  return cases;
}

}  // namespace hg::teleoperation
