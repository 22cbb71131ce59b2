#include "hg/start_test/brake_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hg::start_test {

BrakeWatch::BrakeWatch(const Setup& setup)
    : n_p_(setup.gantry.size()),
      without_load_(setup.is_simulated ? Outcome::kUntested : Outcome::kFailed) {
  const auto add = [&](const Joint& joint) {
    Brake& brake = brakes_.emplace_back();
    brake.joint = joint;
    brake.bound = joint.is_slide ? setup.config.slide_brake_motion : setup.config.brake_motion;
  };
  std::ranges::for_each(setup.gantry, add);
  std::ranges::for_each(setup.manipulator, add);
}

// f(brake, position, load)
template <typename F>
void BrakeWatch::each(const Observation& seen, F&& f) {
  for (std::size_t i = 0; i < brakes_.size(); ++i) {
    const bool is_gantry = i < n_p_;
    const auto k = static_cast<Eigen::Index>(is_gantry ? i : i - n_p_);
    f(brakes_[i], is_gantry ? seen.q_p[k] : seen.q_m[k],
      is_gantry ? seen.load_p[k] : seen.load_m[k]);
  }
}

bool BrakeWatch::is_good(const Observation& seen) const {
  const auto n_p = static_cast<Eigen::Index>(n_p_);
  const auto n_m = static_cast<Eigen::Index>(brakes_.size()) - n_p;
  return seen.q_p.size() == n_p && seen.load_p.size() == n_p && seen.q_m.size() == n_m &&
         seen.load_m.size() == n_m && seen.q_p.allFinite() && seen.load_p.allFinite() &&
         seen.q_m.allFinite() && seen.load_m.allFinite();
}

void BrakeWatch::start(const Observation& seen) {
  has_start_ = is_good(seen);
  if (has_start_) each(seen, [](Brake& brake, double q, double) { brake.start = q; });
}

void BrakeWatch::begin(const Observation& from, double time_s) {
  has_begun_ = true;
  last_s_ = time_s;
  start(from);
}

std::vector<std::string> BrakeWatch::look(const Observation& seen) {
  if (!has_start_) start(seen);
  const double dt = seen.time_s - last_s_;
  last_s_ = seen.time_s;
  if (!is_good(seen)) return {};
  std::vector<std::string> slipped;
  each(seen, [&](Brake& brake, double q, double load) {
    const double motion = std::abs(q - brake.start), size = std::abs(load);
    brake.motion = std::max(brake.motion, motion);
    brake.load = std::max(brake.load, size);
    if (!seen.is_powered && size >= brake.joint.least_load) brake.loaded_s += dt;
    if (motion <= brake.bound || brake.has_slipped) return;
    brake.has_slipped = true;
    brake.slipped_under = size;
    slipped.push_back(brake.joint.name);
  });
  return slipped;
}

std::vector<std::string> BrakeWatch::without_load() const {
  std::vector<std::string> names;
  for (const Brake& brake : brakes_) {
    if (!brake.has_slipped && brake.loaded_s < kLoaded) names.push_back(brake.joint.name);
  }
  return names;
}

std::vector<Item> BrakeWatch::items() const {
  std::vector<Item> items;
  for (const Brake& brake : brakes_) {
    const char* load_unit = brake.joint.is_slide ? "N" : "Nm";
    const char* unit = brake.joint.is_slide ? "mm" : "mrad";
    Item& item = items.emplace_back();
    item.name = "brake " + brake.joint.name;
    if (!has_begun_) {
      item.found = "not reached";
      continue;
    }
    item.motion = brake.motion;
    item.load = brake.load;
    if (brake.has_slipped) {
      item.outcome = Outcome::kFailed;
      item.found =
          fmt::format("SLIPS: moved by {:.1f} {} (allowed: {:g}), from {:.1f} {} on",
                      1e3 * brake.motion, unit, 1e3 * brake.bound, brake.slipped_under, load_unit);
    } else if (brake.loaded_s < kLoaded) {
      item.outcome = without_load_;
      item.found =
          fmt::format("not loaded: it carried {:.1f} {} at most, {:.1f} {} for {:g} s are needed",
                      brake.load, load_unit, brake.joint.least_load, load_unit, kLoaded);
    } else {
      item.outcome = Outcome::kPassed;
      item.found = fmt::format("held {:.1f} {}, moved by {:.2f} {} (allowed: {:g})", brake.load,
                               load_unit, 1e3 * brake.motion, unit, 1e3 * brake.bound);
    }
  }
  return items;
}

}  // namespace hg::start_test
