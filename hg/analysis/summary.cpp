#include "hg/analysis/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "hg/core/index.h"

namespace hg::analysis {
namespace {

// [HANDBOOK] 10.1
constexpr double kToleranceMetres = 2e-3;
constexpr double kToleranceRadians = 5e-3;
constexpr double kTrueToleranceMetres = 1e-3;
constexpr double kTrueToleranceRadians = 2e-3;

nlohmann::ordered_json link_json(const LinkCounts& counts) {
  nlohmann::ordered_json json = {{"sent", counts.sent}, {"received", counts.received}};
  for (const LinkCount& count : kLinkTroubles) json[count.name] = counts.*count.value;
  return json;
}

std::string line(const char* label, const std::string& value) {
  return fmt::format("  {:<12} {}\n", label, value);
}

double per_second(std::uint64_t count, double duration_s) {
  return duration_s > 0.0 ? static_cast<double>(count) / duration_s : 0.0;
}

double mean(double sum, std::uint64_t count) {
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

std::string link_text(const LinkCounts& counts) {
  std::string text = fmt::format("{} sent, {} received", counts.sent, counts.received);
  const char* separator = "; ";
  for (const LinkCount& count : kLinkTroubles) {
    if (counts.*count.value == 0) continue;
    text += fmt::format("{}{} {}", separator, counts.*count.value, count.name);
    separator = ", ";
  }
  return text;
}

Summary::Summary(LimitCatalogue catalogue, FindPositions positions, double rate_Hz,
                 const VectorM& torque_rated)
    : catalogue_(std::move(catalogue)),
      truth_(catalogue_, std::move(positions), rate_Hz, torque_rated),
      worst_excess_(catalogue_.size(), 0.0),
      rate_Hz_(rate_Hz) {}

void Summary::add(const Sample& sample) {
  const CycleRecord& record = sample.record;
  ++cycles_;
  time_s_ = record.time_s;
  last_hash_ = record.state_hash;
  cycle_time_us_.add(sample.cycle_time_us);
  // a released enabling switch also stops the device, and is no fault
  // a brake that does not hold takes the place of why it had to
  const bool is_first = fault_.code == FaultCode::kNone;
  const bool is_worse =
      record.fault.code == FaultCode::kBrakesSlip && fault_.code != record.fault.code;
  if (record.mode == Mode::kFault && (is_first || is_worse)) {
    fault_ = record.fault;
  }
  truth_.add(sample);
  if (record.mode != Mode::kRunning) {
    last_acceleration_ = record.a_H;
    return;
  }

  ++running_cycles_;
  duration_s_ = record.time_s;
  for (std::size_t i = 0; i < catalogue_.size(); ++i) {
    worst_excess_[i] = std::max(worst_excess_[i], record.limits[i].excess);
  }
  if (record.warning.code == FaultCode::kOscillation) {
    if (shaking_cycles_++ == 0) {
      shaking_from_s_ = record.time_s;
      shaking_ = static_cast<Shaking>(record.warning.index);
    }
  }
  if (record.touch.torque.size() > 0) {
    feels_touch_ = true;
    max_touch_share_ = std::max(max_touch_share_, record.touch.share);
    if (record.touch.is_reported) touched_s_ += 1.0 / rate_Hz_;
    max_touch_force_ = std::max(max_touch_force_, record.touch.wrench.head<3>().norm());
  }
  max_sync_error_ = std::max(max_sync_error_, record.sync_error);
  max_sync_angle_ = std::max(max_sync_angle_, record.sync_error_angle);
  const double force = record.robot.w_H.head<3>().norm();
  sum_force_ += force;
  max_force_ = std::max(max_force_, force);
  max_torque_ = std::max(max_torque_, record.robot.w_H.tail<3>().norm());
  ++solver_status_[index(record.solver_status)];
  active_set_changes_ += static_cast<std::uint64_t>(record.active_set_changes);
  const double change = (record.a_H - last_acceleration_).norm();
  last_acceleration_ = record.a_H;
  sum_acceleration_change_ += change;
  acceleration_change_.add(change);
}

bool Summary::limits_held() const noexcept {
  for (std::size_t i = 0; i < catalogue_.size(); ++i) {
    const double tolerance = catalogue_[i].is_angle ? kToleranceRadians : kToleranceMetres;
    if (worst_excess_[i] > tolerance) return false;
  }
  const std::vector<double>& truly = truth_.worst_excess();
  for (std::size_t i = 0; i < truly.size(); ++i) {
    if (truly[i] > (catalogue_[i].is_angle ? kTrueToleranceRadians : kTrueToleranceMetres)) {
      return false;
    }
  }
  return true;
}

nlohmann::ordered_json Summary::to_json(const RunFacts& facts,
                                        const std::vector<std::string>& missing) const {
  nlohmann::ordered_json json;
  json["version"] = facts.version;
  json["scenario"] = facts.scenario;
  json["law"] = facts.law;
  json["bounds"] = facts.bounds;
  json["gantry"] = facts.gantry;
  json["braking"] = facts.braking;
  if (!facts.plant.empty()) {
    json["plant"] = facts.plant;
    json["sensors"] = facts.sensors;
  }
  json["rate_Hz"] = facts.rate_Hz;
  json["fast"] = facts.timing.is_fast;
  json["duration_s"] = duration_s_;
  json["wall_time_s"] = facts.wall_time_s;
  json["cycles"] = cycles_;

  json["events"] = nlohmann::ordered_json::array();
  for (const RunEvent& event : events_) {
    json["events"].push_back(
        {{"name", event.name}, {"time_s", event.time_s}, {"what", event.what}});
  }
  json["missing_events"] = missing;
  json["limits"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < catalogue_.size(); ++i) {
    json["limits"][catalogue_[i].name] = {{"worst_violation", worst_excess_[i]},
                                          {"unit", catalogue_[i].is_angle ? "rad" : "m"}};
  }
  json["limits_held"] = limits_held();
  if (truth_.is_known()) json["reality"] = truth_json();
  json["shaking"] = shaking_json();
  if (feels_touch_) json["touch"] = touch_json();
  json["sync_error"] = {{"max_m", max_sync_error_}, {"max_rad", max_sync_angle_}};
  json["force"] = {{"mean_N", mean(sum_force_, running_cycles_)},
                   {"max_N", max_force_},
                   {"max_torque_Nm", max_torque_}};
  json["solver"] = solver_json();
  json["acceleration_change_per_cycle"] = analysis::to_json(acceleration_change_.distribution());
  json["acceleration_change_per_cycle"]["mean"] = mean(sum_acceleration_change_, running_cycles_);
  json["acceleration_change_per_cycle"]["unit"] = "m/s^2";
  json["cycle_time_us"] = analysis::to_json(cycle_time_us_);
  json["state_hash"] = fmt::format("{:016x}", last_hash_);
  add_to(json, facts.timing);
  json["dropped_samples"] = facts.dropped;
  json["unrecorded_samples"] = facts.unrecorded;
  json["allocations_in_loop"] = facts.allocations_in_loop;
  json["stop_timed_out"] = facts.stop_timed_out;
  if (facts.link.sent > 0) json["link"] = link_json(facts.link);
  json["latency"] = analysis::to_json(facts.latency);
  json["recording"] = facts.recording;
  json["recording_error"] = facts.recording_error;
  json["fault"] = {{"code", static_cast<int>(fault_.code)},
                   {"what", std::string(to_string(fault_.code))},
                   {"index", fault_.index}};
  return json;
}

nlohmann::ordered_json Summary::solver_json() const {
  nlohmann::ordered_json json;
  json["status"] = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < solver_status_.size(); ++i) {
    json["status"][std::string(to_string(static_cast<SolverStatus>(i)))] = solver_status_[i];
  }
  json["active_set_changes_per_second"] = per_second(active_set_changes_, duration_s_);
  return json;
}

nlohmann::ordered_json Summary::shaking_json() const {
  nlohmann::ordered_json json = {{"duration_s", static_cast<double>(shaking_cycles_) / rate_Hz_}};
  if (!has_shaken()) return json;
  json["first_s"] = shaking_from_s_;
  json["what"] = std::string(to_string(shaking_));
  return json;
}

nlohmann::ordered_json Summary::touch_json() const {
  return {{"max_share_of_threshold", max_touch_share_},
          {"duration_s", touched_s_},
          {"max_force_N", max_touch_force_}};
}

nlohmann::ordered_json Summary::truth_json() const {
  nlohmann::ordered_json json;
  const std::vector<double>& excess = truth_.worst_excess();
  for (std::size_t i = 0; i < excess.size(); ++i) {
    json["limits"][catalogue_[i].name] = {{"worst_violation", excess[i]},
                                          {"unit", catalogue_[i].is_angle ? "rad" : "m"}};
  }
  json["max_joint_error"] = truth_.max_joint_error();
  json["max_handle_to_twin_m"] = truth_.max_hand_distance();
  const VectorM& share = truth_.max_torque_share();
  json["max_torque_over_peak"] = std::vector<double>(share.begin(), share.end());
  const VectorM rated = truth_.rated_torque_share();
  json["rms_torque_over_rated"] = std::vector<double>(rated.begin(), rated.end());
  json["cycles_held_back"] = truth_.clamped_cycles();
  json["mean_force_N"] = truth_.mean_force();
  json["vibration_above_5_Hz_m_per_s2"] = truth_.vibration();
  json["vibration_above_20_Hz_m_per_s2"] = truth_.vibration_20();
  const BystanderReport& bystander = truth_.bystander();
  if (bystander.force > 0.0) {
    json["bystander"] = {{"max_force_N", bystander.force},
                         {"max_pressure_N_per_cm2", bystander.pressure},
                         {"max_compression_m", bystander.compression}};
  }
  return json;
}

// True values of the simulation, unknown to a controller.
std::string Summary::truth_text() const {
  std::string text;
  const std::vector<double>& excess = truth_.worst_excess();
  const auto worst = std::ranges::max_element(excess);
  if (worst == excess.end() || *worst == 0.0) {
    text += line("in truth", "all limits of the device held");
  } else {
    const LimitInfo& limit = catalogue_[worst - excess.begin()];
    text += line("in truth", fmt::format("{} beyond its limit by {:.3f} {}", limit.name,
                                         1e3 * *worst, limit.is_angle ? "mrad" : "mm"));
  }
  const std::size_t joint = std::max(truth_.worst_joint(), 0);
  text += line("tracking",
               fmt::format("joints within {:.2f} mrad ({}), handle within {:.2f} mm of the twin",
                           1e3 * truth_.max_joint_error(), catalogue_[joint].name,
                           1e3 * truth_.max_hand_distance()));
  const VectorM& share = truth_.max_torque_share();
  if (share.size() > 0) {
    Eigen::Index most = 0;
    const double largest = share.maxCoeff(&most);
    Eigen::Index hottest = 0;
    const double warmth = truth_.rated_torque_share().maxCoeff(&hottest);
    text += line("torque",
                 fmt::format("at most {:.0f} % of the peak ({}), rms {:.0f} % of the rated ({}){}",
                             100.0 * largest, catalogue_[most].name, 100.0 * warmth,
                             catalogue_[hottest].name,
                             truth_.clamped_cycles() == 0 ? std::string()
                                                          : fmt::format("; held back in {} cycles",
                                                                        truth_.clamped_cycles())));
  }
  text += line("handle",
               fmt::format("mean force {:.2f} N, vibration {:.3f} m/s^2 rms above 5 Hz, {:.3f} "
                           "above 20 Hz",
                           truth_.mean_force(), truth_.vibration(), truth_.vibration_20()));
  const BystanderReport& bystander = truth_.bystander();
  if (bystander.force > 0.0) {
    text += line("BYSTANDER",
                 fmt::format("hit with up to {:.0f} N, {:.1f} N/cm^2, pressed in by {:.1f} mm",
                             bystander.force, bystander.pressure, 1e3 * bystander.compression));
  }
  return text;
}

std::string Summary::limits_text() const {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < catalogue_.size(); ++i) {
    if (worst_excess_[i] > worst_excess_[worst]) worst = i;
  }
  if (catalogue_.empty() || worst_excess_[worst] == 0.0) {
    return line("limits", "all held");
  }
  return line("limits", fmt::format("{}, worst {} by {:.3f} {}",
                                    limits_held() ? "held within tolerance" : "EXCEEDED",
                                    catalogue_[worst].name, 1e3 * worst_excess_[worst],
                                    catalogue_[worst].is_angle ? "mrad" : "mm"));
}

std::string Summary::hand_text() const {
  std::string text;
  if (has_shaken()) {
    text +=
        line("SHAKING",
             fmt::format("hand and device oscillate against each other, {:.2f} s in all, first at "
                         "{:.3f} s: {}",
                         static_cast<double>(shaking_cycles_) / rate_Hz_, shaking_from_s_,
                         to_string(shaking_)));
  }
  if (touched_s_ > 0.0) {
    text += line("CONTACT",
                 fmt::format("something touched the arm, which gave way for {:.2f} s, with up "
                             "to {:.0f} N",
                             touched_s_, max_touch_force_));
  } else if (feels_touch_) {
    text += line("contact", fmt::format("nothing touched the arm, at most {:.0f} % of a threshold",
                                        100.0 * max_touch_share_));
  }
  text += line("hand - twin", fmt::format("at most {:.3f} mm apart", 1e3 * max_sync_error_));
  text += line("force", fmt::format("mean {:.1f} N, max {:.1f} N",
                                    mean(sum_force_, running_cycles_), max_force_));
  return text;
}

std::string Summary::solver_text() const {
  const auto count = [&](SolverStatus status) { return solver_status_[index(status)]; };
  const std::uint64_t spent = count(SolverStatus::kBudgetSpent);
  return line("solver", fmt::format("{} solved, {}{} not; {:.1f} active-set changes per second",
                                    count(SolverStatus::kSolved),
                                    spent > 0 ? fmt::format("{} not proven, ", spent) : "",
                                    count(SolverStatus::kFailed),
                                    per_second(active_set_changes_, duration_s_)));
}

std::string Summary::losses_text(const RunFacts& facts) const {
  std::string text;
  const char* none = facts.recording_error.empty() ? "off" : "none";
  text += line("recording", facts.recording.empty() ? none : facts.recording);
  if (facts.dropped > 0) {
    text += line("LOST", fmt::format("{} samples: neither analysed nor recorded", facts.dropped));
  }
  if (facts.unrecorded > 0 || !facts.recording_error.empty()) {
    text += line("LOST",
                 fmt::format("{} samples of the recording: {}", facts.unrecorded,
                             facts.recording_error.empty() ? "the disk did not take them in time"
                                                           : facts.recording_error));
  }
  if (facts.stop_timed_out)
    text += line("STOP", "timed out: drives off while the device was moving");
  if (fault_.code != FaultCode::kNone) {
    text += line("FAULT",
                 fmt::format("{} {}{}", static_cast<int>(fault_.code), to_string(fault_.code),
                             facts.fault_figures.empty() ? "" : " (" + facts.fault_figures + ")"));
  }
  return text;
}

std::string Summary::events_text(const RunFacts& facts,
                                 const std::vector<std::string>& missing) const {
  if (!missing.empty())
    return fmt::format("{} happened; missing: {}", events_.size(), fmt::join(missing, ", "));
  if (!facts.expects_events) return fmt::format("{} seen, none was expected", events_.size());
  return fmt::format("{} of {} in order", events_.size(), events_.size());
}

std::string Summary::to_text(const RunFacts& facts, const std::vector<std::string>& missing) const {
  std::string text;
  const Distribution time = cycle_time_us_.distribution();
  const double wall = std::max(facts.wall_time_s, 1e-9);

  const double duration_s = running_cycles_ > 0 ? duration_s_ : time_s_;
  text += line("run", fmt::format("{}, {:.1f} s in {:.1f} s ({:.1f}x real time){}, {:.0f} Hz",
                                  facts.scenario, duration_s, facts.wall_time_s, duration_s / wall,
                                  running_cycles_ > 0 ? "" : ": over before the device was running",
                                  facts.rate_Hz));
  text += line("law", fmt::format("{}, {} bounds{}{}", facts.law, facts.bounds,
                                  facts.gantry == "law" ? ", gantry led by the law" : "",
                                  facts.braking == "together" ? ", limits brake together" : ""));
  if (!facts.plant.empty()) {
    text += line("plant", facts.plant);
    text += line("sensors", facts.sensors);
  }
  text += line("events", events_text(facts, missing));
  text += limits_text();
  text += hand_text();
  if (truth_.is_known()) text += truth_text();
  text += solver_text();
  text +=
      line("smoothness", fmt::format("acceleration changes by {:.4f} m/s^2 per cycle on average",
                                     mean(sum_acceleration_change_, running_cycles_)));
  text +=
      line("cycle time", fmt::format("median {:.1f} us, 99.9 % {:.1f} us, max {:.1f} us; {} late",
                                     time.median, time.p99_9, time.max, facts.timing.overruns));
  text += timing_lines(facts.timing);
  text += line("priority", priority_text(facts.timing));
  text += line("allocations", fmt::format("{} in the loop", facts.allocations_in_loop));
  if (facts.link.sent > 0) text += line("link", link_text(facts.link));
  const std::string latency = analysis::to_text(facts.latency);
  if (!latency.empty()) text += line("latency", latency);
  text += line("state", fmt::format("{:016x} (hash of the last cycle: the same run has the same)",
                                    last_hash_));
  text += losses_text(facts);
  return text;
}

}  // namespace hg::analysis
