#include "hg/experiments/fault_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "hg/controller/rendering/catalogue.h"
#include "hg/core/error.h"
#include "hg/core/random.h"
#include "hg/experiments/player.h"
#include "hg/experiments/runs.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/assembly.h"

namespace hg::experiments {
namespace {

using nlohmann::json;

constexpr double kSettling = 1.0;  // s after the grasp: no fault before
constexpr double kLatest = 8.0;    // s: later faults add no information
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

// Worst of all limits of the device, from the truth.
class TrueLimits {
 public:
  explicit TrueLimits(const config::Scenario& scenario)
      : limit_positions_(scenario.device.model), limits_(scenario.limits) {}

  double excess(const Truth& truth) {
    limit_positions_.find(truth.q_p, truth.q_m, positions_);
    double worst = 0.0;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const Interval& range = limits_[i].range;
      const double nearest = std::clamp(positions_[i], range.lb, range.ub);
      worst = std::max(worst, std::abs(positions_[i] - nearest));
    }
    return worst;
  }

 private:
  rendering::LimitPositions limit_positions_;
  LimitCatalogue limits_;
  std::vector<double> positions_;
};

// Whether the machine has reacted and no longer follows its request.
bool has_reacted(const CycleRecord& record, bool was_on) {
  return record.fault.code != FaultCode::kNone || record.mode == Mode::kStopping ||
         (was_on && record.mode == Mode::kReady) || record.mode == Mode::kFault;
}

// Unplanned travel of axes, see FaultCase::travel_share.
class Travel {
 public:
  explicit Travel(const config::Scenario& scenario) : device_(scenario.device) {}

  // One period from the begin of the fault on.
  void add(const Truth& truth, const Sample& sample, bool has_reacted) {
    const double dt = device_.model.dt();
    if (!has_begun_) {
      has_begun_ = true;
      from_m_ = truth.q_m;
      from_p_ = plan_p_ = truth.q_p;
      plan_from_m_ = sample.record.reference.q_m;
      speed_p_ = truth.dq_p;
      // a fault noticed in its first period stops the device where it is
      at_stop_m_ = truth.q_m;
      at_stop_p_ = truth.q_p;
      off_m_.setZero(truth.q_m.size());
      off_p_.setZero(truth.q_p.size());
    }
    if (!has_reacted) {
      plan_m_ = sample.record.reference.q_m - plan_from_m_;
      for (Eigen::Index i = 0; i < plan_p_.size(); ++i) {
        const double command = sample.command.enable ? sample.command.dq_p[i] : 0.0;
        plan_p_[i] += dt * speed_p_[i];
        speed_p_[i] += dt * drive_acceleration(device_.model.drive, speed_p_[i], command);
      }
      at_stop_m_ = truth.q_m;
      at_stop_p_ = truth.q_p;
      off_m_ = truth.q_m - from_m_ - plan_m_;
      off_p_ = truth.q_p - plan_p_;
    }
    const safety::MonitorConfig& stated = device_.monitor;
    for (Eigen::Index i = 0; i < truth.q_m.size(); ++i) {
      look(off_m_[i] + truth.q_m[i] - at_stop_m_[i], truth.q_m[i] - from_m_[i],
           stated.stop_distance_of_joint(device_.model.is_slide(static_cast<int>(i))));
    }
    for (Eigen::Index i = 0; i < truth.q_p.size(); ++i) {
      look(off_p_[i] + truth.q_p[i] - at_stop_p_[i], truth.q_p[i] - from_p_[i],
           stated.stop_distance_of_gantry(device_.model.is_gantry_slide()));
    }
    if (!has_reacted) return;
    energy_ -= dt * truth.w_H.dot(truth.twist);
    most_energy_ = std::max(most_energy_, energy_);
  }

  double share() const { return share_; }
  double energy() const { return most_energy_; }

 private:
  // A plan that moves while the axis stands still, because its encoder drifts, is no travel.
  void look(double off, double moved, double stated) {
    share_ = std::max(share_, std::min(std::abs(off), std::abs(moved)) / stated);
  }

  const config::DeviceConfig& device_;
  bool has_begun_ = false;
  VectorM from_m_, plan_from_m_, plan_m_, at_stop_m_, off_m_;
  VectorP from_p_, plan_p_, speed_p_, at_stop_p_, off_p_;
  double share_ = 0.0, energy_ = 0.0, most_energy_ = 0.0;
};

using Kinds = std::vector<const faults::Kind*>;

constexpr double kSlot = 0.1;  // s

// Peaks of the person's force in a run without faults, one per slot.
std::vector<double> clean_peaks(config::Scenario scenario) {
  scenario.faults.clear();
  Player player(scenario);
  std::vector<double> peaks;
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    const auto slot = static_cast<std::size_t>(player.record().time_s / kSlot);
    peaks.resize(std::max(peaks.size(), slot + 1), 0.0);
    peaks[slot] = std::max(peaks[slot], player.truth().w_H.head<3>().norm());
  }
  return peaks;
}

double peak_within(const std::vector<double>& peaks, double from_s, double to_s) {
  double peak = 0.0;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    const double time_s = static_cast<double>(i) * kSlot;
    if (time_s >= from_s - kSlot && time_s < to_s) peak = std::max(peak, peaks[i]);
  }
  return peak;
}

// What the device of a scenario can suffer, from its first cycle.
class Suffering {
 public:
  explicit Suffering(config::Scenario scenario) {
    scenario.faults.clear();
    Player player(scenario);
    player.begin();
    player.run();
    sensors_ = player.sensors();
    command_ = player.command();
    for (const faults::Kind& kind : faults::kinds()) {
      if (why_not(kind).empty()) kinds_.push_back(&kind);
    }
  }

  // The kinds of faults that the device can have.
  const Kinds& kinds() const { return kinds_; }
  std::string why_not(const faults::Kind& kind) const {
    return why_impossible(kind, sensors_, command_);
  }

 private:
  SensorFrame sensors_;
  CommandFrame command_;
  Kinds kinds_;
};

bool have_same_device(const config::Scenario& one, const config::Scenario& other) {
  return std::ranges::equal(one.device.sources, other.device.sources, {},
                            &config::SourceText::content, &config::SourceText::content);
}

// One of `count` indices.
std::size_t draw_index(std::size_t count, Random& random) {
  return static_cast<std::size_t>(random.next() * static_cast<double>(count));
}

faults::Injection draw(const faults::Kind& kind, const config::Scenario& scenario, Random& random) {
  faults::Injection drawn = {.kind = &kind};
  const DeviceModel& device = scenario.device.model;
  const int parts = faults::parts_of(kind.part, device.n_m, device.n_p);
  drawn.index = static_cast<int>(draw_index(parts, random));
  if (!kind.unit.empty()) {
    drawn.magnitude =
        std::exp(random.between(std::log(kind.magnitude.lb), std::log(kind.magnitude.ub)));
    if (kind.has_sign && random.next() < 0.5) drawn.magnitude *= -1.0;
    if (faults::is_count(kind)) drawn.magnitude = std::round(drawn.magnitude);
    const bool is_torque = kind.part == faults::Part::kForceSensor && drawn.index >= 3;
    if (is_torque) drawn.magnitude *= 0.1;
  }
  const Interval times = fault_times(scenario);
  drawn.from_s = random.between(times.lb, times.ub);
  return drawn;
}

// The drives stand still; a person who pulls may still bend the springs behind them.
bool stands_still(const Truth& truth) {
  constexpr double kStandstill = 0.02;  // rad/s and m/s
  const double gantry = truth.dq_p.size() > 0 ? truth.dq_p.lpNorm<Eigen::Infinity>() : 0.0;
  // of a joint whose brake is closed the motor stands, and the hand swings its link on the spring;
  // one that is controlled holds its link, and its motor shakes a little with the sensors' noise
  VectorM speed = truth.dq_m.cwiseAbs();
  if (truth.dtheta_m.size() > 0) speed = speed.cwiseMin(truth.dtheta_m.cwiseAbs());
  return speed.maxCoeff() < kStandstill && gantry < kStandstill;
}

constexpr std::size_t kPhases = 4;
constexpr double kStartingWatch = 2.0;  // s longer: the device is to be armed and to run
constexpr double kFirst = 0.1;  // s: what is wrong from the first sample on is no fault that begins

FaultCase draw_case(std::size_t number, const config::Scenario& scenario, const Kinds& kinds,
                    Random& random) {
  FaultCase drawn = {.phase = static_cast<Phase>(number / kinds.size() % kPhases),
                     .injection = draw(*kinds[number % kinds.size()], scenario, random)};
  double& from_s = drawn.injection.from_s;
  switch (drawn.phase) {
    case Phase::kRunning:
      break;
    case Phase::kPair:
      drawn.other = draw(*kinds[draw_index(kinds.size(), random)], scenario, random);
      drawn.other->from_s = from_s + random.between(0.0, 0.5);
      break;
    case Phase::kStopping:
      drawn.other = {.kind = faults::find_kind("emergency_stop"), .from_s = from_s};
      from_s += random.between(-0.05, 0.3);
      break;
    case Phase::kStarting:
      from_s = random.between(kFirst, scenario.script.script.grasp_s);
      break;
  }
  return drawn;
}

// Counts the cycles of a recording, and whether they are all there.
class CycleCounter final : public recording::RecordingListener {
 public:
  void configuration(const recording::NamedText& /*text*/) override {}
  void event(const recording::Event& /*event*/) override {}
  void sample(const Sample& sample) override {
    is_gapless_ = is_gapless_ && sample.record.cycle == count_;
    ++count_;
  }

  bool has_all(std::uint64_t cycles) const { return is_gapless_ && count_ == cycles; }

 private:
  std::uint64_t count_ = 0;
  bool is_gapless_ = true;
};

bool has_all_cycles(const std::filesystem::path& file, std::uint64_t cycles) {
  CycleCounter counter;
  try {
    return recording::read_recording(file, counter).is_whole() && counter.has_all(cycles);
  } catch (const SetupError&) {
    return false;  // damaged
  }
}

// What a run says about its case: with which fault and when is drawn again from the seed.
json json_of(const FaultCase& result) {
  return {{"fault", result.injection.kind->name},
          {"outcome", static_cast<int>(result.outcome)},
          {"code", static_cast<int>(result.fault)},
          {"stop", static_cast<int>(result.stop)},
          {"noticed_s", result.noticed_s},
          {"stopped_s", result.stopped_s},
          {"peak_force_N", result.peak_force},
          {"worst_excess", result.worst_excess},
          {"worst_distance_m", result.worst_distance},
          {"travel_share", result.travel_share},
          {"energy_J", result.energy},
          {"has_reported_slip", result.has_reported_slip},
          {"has_run", result.has_run},
          {"is_complete", result.is_complete}};
}

void take(const json& played, FaultCase& result) {
  result.outcome = static_cast<Outcome>(played["outcome"].get<int>());
  result.fault = static_cast<FaultCode>(played["code"].get<int>());
  result.stop = static_cast<Stop>(played["stop"].get<int>());
  result.noticed_s = number_of(played["noticed_s"]);
  result.stopped_s = number_of(played["stopped_s"]);
  result.peak_force = number_of(played["peak_force_N"]);
  result.worst_excess = number_of(played["worst_excess"]);
  result.worst_distance = number_of(played["worst_distance_m"]);
  result.travel_share = number_of(played["travel_share"]);
  result.energy = number_of(played["energy_J"]);
  result.has_reported_slip = played["has_reported_slip"];
  result.has_run = played["has_run"];
  result.is_complete = played["is_complete"];
}

config::Scenario with_faults(config::Scenario scenario, const FaultCase& drawn) {
  scenario.faults = {drawn.injection};
  if (drawn.other) scenario.faults.push_back(*drawn.other);
  return scenario;
}

// From the first fault on, until the last one has been watched for long enough.
Interval watched_times(const FaultCase& drawn, const CampaignConfig& config) {
  Interval times = {drawn.injection.from_s, drawn.injection.from_s + config.watched_s};
  if (drawn.other) {
    times.lb = std::min(times.lb, drawn.other->from_s);
    times.ub = std::max(times.ub, drawn.other->from_s + config.watched_s);
  }
  // a fault from the start on is in force when the device begins to run
  if (drawn.phase == Phase::kStarting) times.ub += kStartingWatch;
  return times;
}

// Whether the encoder of a gantry drifts, which nothing but its way shows.
bool drifts_slowly(const FaultCase& drawn) {
  const auto is_drift = [](const faults::Injection& injection) {
    return injection.kind->part == faults::Part::kGantryEncoder &&
           injection.kind->effect == faults::Effect::kDrift;
  };
  return is_drift(drawn.injection) || (drawn.other && is_drift(*drawn.other));
}

// Whether the device is where it should not be. One that did not run held still.
bool is_elsewhere(const CampaignConfig& config, const FaultCase& result) {
  return result.has_run && (result.worst_excess > config.harmless_excess ||
                            result.worst_distance > config.harmless_distance);
}

// What a fault does to device and person, cycle by cycle from the fault on.
class Watch {
 public:
  Watch(const config::Scenario& scenario, const FaultCase& drawn, double from_s)
      : result_(drawn), from_s_(from_s), limits_(scenario), travel_(scenario) {
    result_.stopped_s = kNever;
  }

  void add(const Truth& truth, const Sample& sample) {
    const CycleRecord& record = sample.record;
    result_.peak_force = std::max(result_.peak_force, truth.w_H.head<3>().norm());
    result_.worst_excess = std::max(result_.worst_excess, limits_.excess(truth));
    if (record.mode == Mode::kRunning || record.mode == Mode::kStopping) {
      const double distance = (truth.T_B_H.p - record.T_B_E.p).norm();
      result_.worst_distance = std::max(result_.worst_distance, distance);
    }
    has_run_ = has_run_ || record.mode == Mode::kRunning;
    was_on_ = was_on_ || has_run_ || record.mode == Mode::kArmed;
    if (std::isnan(noticed_at_s_) && has_reacted(record, was_on_)) {
      noticed_at_s_ = record.time_s;
      result_.outcome = Outcome::kNoticed;
      result_.noticed_s = record.time_s - from_s_;
      result_.fault = record.fault.code;
    }
    travel_.add(truth, sample, !std::isnan(noticed_at_s_));
    result_.has_reported_slip =
        result_.has_reported_slip || record.fault.code == FaultCode::kBrakesSlip;
    result_.stop = std::max(result_.stop, record.stop);
    if (std::isnan(noticed_at_s_) || !stands_still(truth)) {
      result_.stopped_s = kNever;
    } else if (std::isnan(result_.stopped_s)) {
      result_.stopped_s = record.time_s - noticed_at_s_;
    }
  }

  bool has_noticed() const { return !std::isnan(noticed_at_s_); }

  FaultCase result() const {
    FaultCase result = result_;
    result.travel_share = travel_.share();
    result.energy = travel_.energy();
    result.has_run = has_run_;
    return result;
  }

 private:
  FaultCase result_;
  double from_s_;
  TrueLimits limits_;
  Travel travel_;
  bool was_on_ = false, has_run_ = false;
  double noticed_at_s_ = kNever;
};

}  // namespace

std::string why_impossible(const faults::Kind& kind, const SensorFrame& sensors,
                           const CommandFrame& command) {
  switch (kind.part) {
    case faults::Part::kMotorEncoder:
    case faults::Part::kJointEncoders:
      return sensors.theta_m.size() > 0 ? "" : "the device has no motor encoders";
    case faults::Part::kTorqueSensor:
      return sensors.tau_m.size() > 0 ? "" : "the device has no torque sensors";
    case faults::Part::kTemperature:
      return sensors.temperature_m.size() > 0 ? "" : "the device does not measure temperatures";
    case faults::Part::kGantryEncoder:
    case faults::Part::kGantryDrive:
    case faults::Part::kGantryCoupling:
      return sensors.q_p.size() > 0 ? "" : "the device has no gantry";
    case faults::Part::kMotor:
      return command.tau_m.size() > 0 ? "" : "the device is given positions, not torques";
    default:
      return "";
  }
}

Interval fault_times(const config::Scenario& scenario) {
  const double grasp_s = scenario.script.script.grasp_s;
  const double last_s = scenario::planned_duration_s(scenario) - 1.0;
  return {grasp_s + kSettling, std::min(last_s, grasp_s + kLatest)};
}

FaultCase play_fault(const config::Scenario& scenario, const FaultCase& drawn,
                     const CampaignConfig& config, const recording::RecordingInfo* recording) {
  const config::Scenario played = with_faults(scenario, drawn);
  const Interval watched = watched_times(drawn, config);
  Player player(played);
  Watch watch(scenario, drawn, watched.lb);
  std::uint64_t cycles = 0;
  const auto recorder =
      recording != nullptr ? std::make_unique<recording::Recorder>(*recording) : nullptr;
  const double latest = watched.ub + (drifts_slowly(drawn) ? config.patience_s : 0.0);
  double until = watched.ub;
  bool is_running = true;
  while (is_running) {
    player.begin();
    player.run();
    const CycleRecord& record = player.record();
    const Truth truth = player.truth();
    if (recorder != nullptr) recorder->push_waiting(player.sample());
    player.end();
    ++cycles;
    if (record.time_s >= watched.lb) watch.add(truth, player.sample());
    if (record.time_s >= watched.ub && record.time_s < latest && !watch.has_noticed() &&
        is_elsewhere(config, watch.result())) {
      until = record.time_s + config.watched_s;  // to see the stop, too
    }
    is_running = record.time_s < until;
  }
  FaultCase result = watch.result();
  if (recorder != nullptr) {
    result.is_complete = has_all_cycles(recorder->close().file, cycles);
    std::filesystem::remove_all(recording->folder);
  }
  return result;
}

void judge(const CampaignConfig& config, double clean_force, FaultCase& result) {
  const bool is_harder = result.has_run && result.peak_force > clean_force + config.harmless_force;
  const bool is_harmless = !is_harder && !is_elsewhere(config, result);
  if (result.outcome != Outcome::kNoticed && !is_harmless) result.outcome = Outcome::kUnnoticed;
}

Campaign run_campaign(const std::vector<config::Scenario>& scenarios, const CampaignConfig& config,
                      const std::vector<recording::RecordingInfo>& recordings, Runs& runs) {
  Campaign campaign = {.config = config};
  for (const config::Scenario& scenario : scenarios) campaign.scenarios.push_back(scenario.title);
  std::vector<std::shared_ptr<const Suffering>> devices;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    const bool is_the_same = i > 0 && have_same_device(scenarios[i], scenarios[i - 1]);
    devices.push_back(is_the_same ? devices.back() : std::make_shared<Suffering>(scenarios[i]));
  }
  for (const faults::Kind& kind : faults::kinds()) {
    const bool is_possible = std::ranges::any_of(
        devices, [&](const auto& device) { return device->why_not(kind).empty(); });
    if (!is_possible) campaign.impossible.emplace_back(&kind, devices.front()->why_not(kind));
  }
  for (int i = 0; i < config.cases; ++i) {
    Random random(config.seed * 1'000'003 + i);
    const std::size_t which = draw_index(scenarios.size(), random);
    campaign.cases.push_back(draw_case(i, scenarios[which], devices[which]->kinds(), random));
    campaign.cases.back().scenario = which;
  }

  const std::vector<json> clean = runs.next(scenarios.size(), [&](std::size_t i) {
    return json{{"peaks_N", clean_peaks(scenarios[i])}};
  });
  const std::vector<json> played = runs.next(campaign.cases.size(), [&](std::size_t i) {
    const FaultCase& drawn = campaign.cases[i];
    recording::RecordingInfo recording;
    if (!recordings.empty()) {
      recording = recordings[drawn.scenario];
      recording.folder /= fmt::format("case_{}", i);
    }
    return json_of(play_fault(scenarios[drawn.scenario], drawn, config,
                              recordings.empty() ? nullptr : &recording));
  });
  for (std::size_t i = 0; i < played.size(); ++i) {
    FaultCase& result = campaign.cases[i];
    if (played[i].is_null() || clean[result.scenario].is_null()) continue;  // of another part
    take(played[i], result);
    const double from_s = result.injection.from_s;
    const double until_s =
        from_s + config.watched_s + (result.phase == Phase::kStarting ? kStartingWatch : 0.0);
    judge(config, peak_within(clean[result.scenario]["peaks_N"], from_s, until_s), result);
  }
  return campaign;
}

}  // namespace hg::experiments
