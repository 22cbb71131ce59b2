/// Delays of a run by stage: link to the device, drives, sensor, page. Each is measured on its own,
/// so that a slow run is not only slow.
///
/// Fed with samples outside the control loop.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "hg/analysis/drive_delay.h"
#include "hg/signals/state.h"

namespace hg::analysis {

/// Delays, s; NaN = not known.
struct Latency {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double link = kUnknown;   ///< from a sample to the arrival of its command at the device and back
  double drive = kUnknown;  ///< from the arrival of a command to when the joints are where it wants
  double drive_spread = kUnknown;  ///< of the middle 80 % of its results, at least dt / 2
  bool drive_has_link = false;     ///< the link's delay is not known, and is within that of drives
  bool needs_motion = false;       ///< the drives' delay is not known: the arm moved too little
  double sensor = kUnknown;        ///< age of a sample when its command leaves this computer
  double page = kUnknown;          ///< from the program to the page and back
};

/// "link 20 ms there and back, drive 58 ms +- 1, sensor 0.1 ms, page 3 ms there and back"; empty =
/// nothing is known.
std::string to_text(const Latency& latency);
/// Known delays in seconds.
nlohmann::ordered_json to_json(const Latency& latency);

class LatencyWatch {
 public:
  /// `follows_positions`: the drives do. Other drives say which command is in effect.
  LatencyWatch(double rate_Hz, bool follows_positions);

  void add(const Sample& sample);
  /// Round trips as link and page measure them, s; NaN = none. Call them a few times per second.
  void add_link(double round_trip_s);
  void add_page(double round_trip_s);

  Latency latency() const;

 private:
  void look_at_sensor(const Sample& sample);

  double dt_;
  bool follows_positions_;
  bool is_remote_ = false;
  std::uint64_t cycle_ = 0;  ///< of the last sample
  DriveDelay drive_;
  NewestResults ages_;  ///< age of the command in effect, mean of a second, s
  NewestResults sensor_, link_, page_;
  double sum_age_ = 0.0, sum_time_ = 0.0;
  int samples_answered_ = 0, samples_ = 0, moved_ = 0, renewed_ = 0;
  Vector6 last_w_ = Vector6::Zero();
  VectorM last_q_;
};

}  // namespace hg::analysis
