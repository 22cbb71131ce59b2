#include "hg/walking/generated_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace hg::walking {
namespace {

constexpr double kSpeed = 1.0;                         // m/s
constexpr double kTurnSpeed = 0.5 * std::numbers::pi;  // rad/s

class PathMaker {
 public:
  explicit PathMaker(const Eigen::Vector2d& p) : samples_{{.p = p}} {}

  Eigen::Vector2d p() const { return samples_.back().p; }

  void wait(double duration) {
    append(duration, [](WalkSample&, double) {});
  }
  void turn(double angle) {
    append(std::abs(angle) / kTurnSpeed,
           [angle](WalkSample& sample, double share) { sample.heading += share * angle; });
  }
  void go(double distance) {
    const Eigen::Vector2d way = distance * direction_of(samples_.back().heading);
    append(distance / kSpeed,
           [&way](WalkSample& sample, double share) { sample.p += share * way; });
  }
  void go_to(const Eigen::Vector2d& goal) {
    const Eigen::Vector2d way = goal - p();
    if (way.norm() < 1e-3) return;
    turn(std::remainder(std::atan2(way.y(), way.x()) - samples_.back().heading,
                        2.0 * std::numbers::pi));
    go(way.norm());
  }

  WalkedPath take(std::string name, std::vector<Rectangle> spaces) {
    add_velocities(samples_);
    return {std::move(name), std::move(samples_), std::move(spaces)};
  }

 private:
  template <typename Change>
  void append(double duration, const Change& change) {
    const WalkSample from = samples_.back();
    const int count = static_cast<int>(std::lround(duration / kWalkPeriod));
    for (int i = 1; i <= count; ++i) {
      samples_.push_back(from);
      change(samples_.back(), static_cast<double>(i) / count);
    }
  }

  std::vector<WalkSample> samples_;
};

bool overlap(const Rectangle& a, const Rectangle& b) {
  return (a.lower.array() < b.upper.array()).all() && (b.lower.array() < a.upper.array()).all();
}

// Rooms and corridors, each behind a door of the one before.
class Building {
 public:
  explicit Building(Random& random)
      : random_(random), space_(centered(between(3.0, 7.0), between(3.0, 7.0))), spaces_{space_} {}

  const Rectangle& space() const { return space_; }
  std::vector<Rectangle> take() { return std::move(spaces_); }
  double between(double from, double to) { return random_.between(from, to); }

  struct Door {
    Eigen::Vector2d middle, outward;
  };

  // A door of the current space to a new one, which becomes the current one; none where there is no
  // place for one.
  std::optional<Door> add_space() {
    for (int trial = 0; trial < 40; ++trial) {
      const int axis = random_.next() < 0.5 ? 0 : 1, along = 1 - axis;
      const double side = random_.next() < 0.5 ? -1.0 : 1.0;
      const bool is_corridor = random_.next() < 0.5;
      const double depth = is_corridor ? between(4.0, 12.0) : between(3.0, 7.0);
      const double width = is_corridor ? between(1.6, 2.4) : between(3.0, 7.0);
      const double place = between(space_.lower[along] + kBeside, space_.upper[along] - kBeside);
      const double beside = between(kBeside, width - kBeside);
      const double wall = side > 0.0 ? space_.upper[axis] : space_.lower[axis];
      Rectangle door, next;
      door.lower[along] = place - 0.5 * kDoor;
      door.upper[along] = place + 0.5 * kDoor;
      set(door, axis, wall, wall + side * kWall);
      next.lower[along] = place - beside;
      next.upper[along] = next.lower[along] + width;
      set(next, axis, wall + side * kWall, wall + side * (kWall + depth));
      const auto is_in_the_way = [&](const Rectangle& other) {
        return overlap(next.inset(-0.5 * kWall), other.inset(-0.4 * kWall));
      };
      if (std::ranges::any_of(spaces_, is_in_the_way)) continue;
      spaces_.push_back(door);
      spaces_.push_back(next);
      space_ = next;
      return Door{door.middle(), side * Eigen::Vector2d::Unit(axis)};
    }
    return std::nullopt;
  }

 private:
  static constexpr double kWall = 0.2, kDoor = 0.9;
  static constexpr double kBeside = 0.7;  // m, from the middle of a door to a corner

  static void set(Rectangle& rectangle, int axis, double a, double b) {
    rectangle.lower[axis] = std::min(a, b);
    rectangle.upper[axis] = std::max(a, b);
  }

  Random& random_;
  Rectangle space_;
  std::vector<Rectangle> spaces_;
};

}  // namespace

WalkedPath make_path(PathFamily family, Random& random) {
  PathMaker path(Eigen::Vector2d::Zero());
  const auto winding = [&](int ways, const auto& angle) {
    for (int i = 0; i < ways; ++i) {
      path.go(random.between(2.0, 8.0));
      path.turn(angle());
    }
  };
  const char* name = "straight";
  if (family == PathFamily::kStraight) path.go(200.0);
  if (family == PathFamily::kRightAngles) {
    name = "right angles";
    winding(40, [&] { return (random.next() < 0.5 ? -0.5 : 0.5) * std::numbers::pi; });
  }
  if (family == PathFamily::kRandomTurns) {
    name = "random turns";
    winding(50, [&] { return random.between(-std::numbers::pi, std::numbers::pi); });
  }
  WalkedPath made = path.take(name, {});
  made.spaces = {surroundings(made.samples)};
  return made;
}

WalkedPath make_building(Random& random) {
  constexpr int kSpaces = 10;
  constexpr double kBefore = 0.6;  // m, from a person who opens a door to its leaf
  Building building(random);
  PathMaker path(building.space().middle());
  for (int i = 1; i < kSpaces; ++i) {
    const auto door = building.add_space();
    if (!door) break;
    path.go_to(door->middle - kBefore * door->outward);
    path.go_to(door->middle - 0.9 * kBefore * door->outward);
    path.wait(2.0);
    path.go_to(door->middle + kBefore * door->outward);
    const Rectangle inner = building.space().inset(kBefore);
    path.go_to({building.between(inner.lower.x(), inner.upper.x()),
                building.between(inner.lower.y(), inner.upper.y())});
    path.wait(1.0);
  }
  return path.take("building", building.take());
}

}  // namespace hg::walking
