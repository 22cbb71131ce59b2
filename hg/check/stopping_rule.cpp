#include "hg/check/stopping_rule.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace hg::check {

std::vector<Stopping> stopping_of(const config::DeviceConfig& device) {
  const DeviceModel& model = device.model;
  const safety::MonitorConfig& monitor = device.monitor;
  std::vector<Stopping> all;
  for (int i = 0; i < model.n_p + model.n_m; ++i) {
    const model::Joint& joint = model.chain.joints()[i];
    const bool is_angle = !joint.is_slide();
    Stopping stopping = {.name = joint.name, .is_angle = is_angle};
    if (i < model.n_p) {
      stopping.need = safety::stopping_need(device.model.drive);
      stopping.distance = is_angle ? monitor.turn_stop_distance : monitor.gantry_stop_distance;
      stopping.key =
          is_angle ? "monitor.gantry_stop_distance_rad" : "monitor.gantry_stop_distance_m";
    } else {
      const auto& limits = model.joint_limits[i - model.n_p];
      stopping.need = safety::stopping_need(limits.dq_max, limits.ddq_max,
                                            safety::drive_lag(model.follows_positions));
      stopping.distance = is_angle ? monitor.stop_distance : monitor.slide_stop_distance;
      stopping.key = is_angle ? "monitor.stop_distance_rad" : "monitor.stop_distance_m";
    }
    all.push_back(std::move(stopping));
  }
  return all;
}

void inspect_stopping(const config::DeviceConfig& device, Collector& out) {
  // Factor over the need of the slowest axis from which the distance is no useful bound
  constexpr double kTooFar = 4.0;
  std::map<std::string, Stopping> slowest;  // by the key that states their distance
  for (const Stopping& s : stopping_of(device)) {
    Stopping& worst = slowest.try_emplace(s.key, s).first->second;
    if (s.need.distance > worst.need.distance) worst = s;
    if (std::isfinite(s.need.distance) && s.need.distance > safety::kUntilBrakes * s.distance) {
      const char* unit = s.is_angle ? "rad" : "m";
      out.add(
          Severity::kFault, s.key,
          fmt::format("{:g} {}, but {} needs {:.3g} {} to stop from full speed: its brakes would "
                      "close in ordinary stops",
                      s.distance, unit, s.name, s.need.distance, unit),
          "raise it, or lower the speed of the joint");
    }
    if (std::isfinite(s.need.time) && s.need.time > device.monitor.stop_time) {
      out.add(Severity::kWarning, "monitor.stop_time_s",
              fmt::format("{:g} s, but {} needs {:.3g} s to stop from full speed",
                          device.monitor.stop_time, s.name, s.need.time),
              "raise it, or lower the speed of the joint");
    }
  }
  for (const auto& [key, s] : slowest) {
    if (!(s.distance > kTooFar * s.need.distance)) continue;
    const char* unit = s.is_angle ? "rad" : "m";
    out.add(
        Severity::kWarning, key,
        fmt::format("{:g} {}, where {} needs {:.3g} {} to stop from full speed, and no axis "
                    "more: so far one may run before its brakes close",
                    s.distance, unit, s.name, s.need.distance, unit),
        fmt::format("lower it, or leave it out: {:.3g} {} would do", 1.25 * s.need.distance, unit));
  }
}

}  // namespace hg::check
