#include "hg/analysis/latency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace hg::analysis {
namespace {

// three digits where it is short, whole milliseconds otherwise
std::string ms(double seconds) {
  return seconds < 9.95e-3 ? fmt::format("{:.1f} ms", 1e3 * seconds)
                           : fmt::format("{:.0f} ms", 1e3 * seconds);
}

}  // namespace

std::string to_text(const Latency& latency) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (std::isfinite(latency.link)) add(fmt::format("link {} there and back", ms(latency.link)));
  if (std::isfinite(latency.drive)) {
    add(fmt::format("drive{} {} +- {:.1f}", latency.drive_has_link ? " with its link" : "",
                    ms(latency.drive), 1e3 * latency.drive_spread));
  } else if (latency.needs_motion) {
    add("drive not known: not enough motion");
  }
  if (std::isfinite(latency.sensor)) add("sensor " + ms(latency.sensor));
  if (std::isfinite(latency.page)) add(fmt::format("page {} there and back", ms(latency.page)));
  return text;
}

nlohmann::ordered_json to_json(const Latency& latency) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const auto add = [&](const char* name, double value) {
    if (std::isfinite(value)) json[name] = value;
  };
  add("link_round_trip_s", latency.link);
  add("drive_s", latency.drive);
  add("drive_spread_s", latency.drive_spread);
  if (std::isfinite(latency.drive)) json["drive_has_link"] = latency.drive_has_link;
  add("sensor_s", latency.sensor);
  add("page_round_trip_s", latency.page);
  return json;
}

LatencyWatch::LatencyWatch(double rate_Hz, bool follows_positions)
    : dt_(1.0 / rate_Hz), follows_positions_(follows_positions), drive_(rate_Hz) {}

void LatencyWatch::add_link(double round_trip_s) {
  if (std::isfinite(round_trip_s)) link_.add(round_trip_s);
}

void LatencyWatch::add_page(double round_trip_s) {
  if (std::isfinite(round_trip_s)) page_.add(round_trip_s);
}

void LatencyWatch::add(const Sample& sample) {
  const SensorFrame& sensors = sample.sensors;
  const bool follows = sample.record.cycle == cycle_ + 1;
  cycle_ = sample.record.cycle;
  if (sensors.driver_fault != FaultCode::kNone) return drive_.interrupt();
  is_remote_ = !sample.truth.is_known;
  if (follows_positions_) {
    const bool moves = sample.command.enable && (sample.record.mode == Mode::kRunning ||
                                                 sample.record.mode == Mode::kStopping);
    if (!follows || !moves) drive_.interrupt();
    if (moves) drive_.add(sample.command.q_m, sensors.q_m);
  } else if (sensors.answered_sequence > 0 && sensors.answered_sequence <= sensors.sequence) {
    sum_age_ += dt_ * static_cast<double>(sensors.sequence - sensors.answered_sequence);
    ++samples_answered_;
  }
  look_at_sensor(sample);
}

// A sensor that is slower than the loop shows the same wrench several times while the arm moves.
void LatencyWatch::look_at_sensor(const Sample& sample) {
  const bool has_moved = last_q_.size() == sample.sensors.q_m.size() &&
                         (last_q_ - sample.sensors.q_m).cwiseAbs().maxCoeff() > 0.0;
  if (has_moved) {
    ++moved_;
    if (last_w_ != sample.sensors.w_S) ++renewed_;
  }
  last_q_ = sample.sensors.q_m;
  last_w_ = sample.sensors.w_S;
  sum_time_ += 1e-6 * sample.cycle_time_us;
  if (++samples_ * dt_ < 1.0) return;
  const double samples_per_value =
      renewed_ > 0 ? static_cast<double>(moved_) / static_cast<double>(renewed_) : 1.0;
  sensor_.add(sum_time_ / samples_ + 0.5 * dt_ * (samples_per_value - 1.0));
  if (samples_answered_ > 0) ages_.add(sum_age_ / samples_answered_);
  sum_time_ = sum_age_ = 0.0;
  samples_ = samples_answered_ = moved_ = renewed_ = 0;
}

Latency LatencyWatch::latency() const {
  Latency result{.link = link_.median(), .sensor = sensor_.median(), .page = page_.median()};
  const NewestResults& drive = follows_positions_ ? drive_.results() : ages_;
  const bool knows_link = !link_.is_empty();
  result.drive_has_link = is_remote_ && !knows_link;
  result.needs_motion = follows_positions_ && drive.is_empty();
  // a command wants the joints there one period after its arrival, and is taken at the end of the
  // period in which it arrives
  const double planned = follows_positions_ ? dt_ : 0.0;
  const double on_the_way = knows_link ? std::max(0.0, result.link - 0.5 * dt_) : 0.0;
  result.drive = std::max(0.0, drive.median() - planned - on_the_way);
  result.drive_spread = std::max(drive.spread(), 0.5 * dt_);
  if (drive.is_empty()) result.drive = result.drive_spread = Latency::kUnknown;
  return result;
}

}  // namespace hg::analysis
