#include "hg/experiments/contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hg/core/error.h"
#include "hg/core/stacked.h"
#include "hg/experiments/changes.h"
#include "hg/experiments/player.h"
#include "hg/model/chain_data.h"
#include "hg/scenario/assembly.h"
#include "hg/simulator/plant/bystander.h"

namespace hg::experiments {
namespace {

constexpr double kFaster = 1.1;  // the hand's largest speed over that of the hit
constexpr double kFrom = -1.0;   // m, of the hand's way along y
constexpr double kPause = 0.5;   // s, from the grasp on
constexpr double kPeak = 1.875;  // largest speed of a minimum-jerk ramp over its mean

// length of the walk needed for the speed
double way_of(double speed) { return std::min(2.0, 0.8 + 1.2 * speed); }

// A straight walk along y; the person does not notice that the arm has hit a bystander.
person::Script walk_past(const ContactConfig& config, double speed) {
  person::Script script;
  const double way = way_of(speed), duration = kPeak * way / (kFaster * speed);
  script.start[person::kGripChannel] = 1.0;
  script.segments.push_back({.start_s = kPause,
                             .duration_s = duration,
                             .channel = 1,
                             .blend = person::Blend::kTo,
                             .value = kFrom + way});
  script.duration_s = kPause + 0.5 * duration + config.watched + 0.5;
  return script;
}

config::Scenario walking(const config::Scenario& scenario, const ContactConfig& config,
                         double speed) {
  config::Scenario walk = scenario;
  walk.twin.model.q_start.head<3>() << 0.0, kFrom, config.height;
  play_script(walk, walk_past(config, speed));
  walk.bystander.reset();
  return walk;
}

// Tracks position and velocity of a point of the true arm.
class Tracker {
 public:
  Tracker(const config::Scenario& scenario, const std::string& frame)
      : chain_(scenario.device.model.chain), frame_(chain_.model().frame(frame)) {}
  void look(const Truth& truth) {
    const VectorPM q = stacked(truth.q_p, truth.q_m), dq = stacked(truth.dq_p, truth.dq_m);
    chain_.update_kinematics(q, dq);
  }
  Eigen::Vector3d position() const { return chain_.pose(frame_).p; }
  Eigen::Vector3d velocity() const { return chain_.twist(frame_).head<3>(); }

 private:
  model::ChainData chain_;
  int frame_;
};

// The body stands where the point first has the speed, and faces it.
simulator::BystanderConfig in_the_way(const config::Scenario& walk, const ContactCase& what) {
  Player player(walk);
  Tracker tracker(walk, what.point.frame);
  for (bool has_more = true; has_more; has_more = player.end()) {
    player.begin();
    player.run();
    tracker.look(player.truth());
    const Eigen::Vector3d v = tracker.velocity();
    if (v.norm() < what.speed) continue;
    simulator::BystanderConfig bystander;
    bystander.part = simulator::find_body_part(what.part);
    bystander.position = tracker.position();
    bystander.facing = -v.normalized();
    bystander.is_clamped = what.is_clamped;
    return bystander;
  }
  throw SetupError(fmt::format("experiment contact: the {} never reaches {:g} m/s", what.point.name,
                               what.speed));
}

config::Scenario with(config::Scenario walk, const simulator::BystanderConfig& bystander,
                      const ContactCase& what, bool gives_way, std::uint64_t seed) {
  set_seed(walk, seed);
  walk.device.compliance.is_on = gives_way;
  walk.bystander = {.config = bystander, .hit_by = what.point.frame};
  return walk;
}

// A device stopped by a fault may still press, so the run continues to the end.
ContactRun play(const config::Scenario& walk, const ContactConfig& config) {
  Player player(walk);
  Tracker tracker(walk, walk.bystander->hit_by);
  const double dt = 1.0 / walk.device.model.rate_Hz;
  const double end_s = scenario::planned_duration_s(walk) + config.watched;
  ContactRun run;
  double hit_s = -1.0;
  for (; player.record().time_s < end_s; player.end()) {
    player.begin();
    player.run();
    const Truth& truth = player.truth();
    const CycleRecord& record = player.record();
    const double force = truth.bystander.force;
    if (hit_s < 0.0 && force == 0.0) {
      tracker.look(truth);
      run.hit_speed = tracker.velocity().norm();
      continue;
    }
    if (hit_s < 0.0) hit_s = record.time_s;
    const double since = record.time_s - hit_s;
    if (since > config.watched) break;
    run.force = std::max(run.force, force);
    run.pressure = std::max(run.pressure, truth.bystander.pressure);
    run.compression = std::max(run.compression, truth.bystander.compression);
    if (force > 0.0) run.contact += dt;
    if (since < config.settled) run.impulse += dt * force;
    if (since >= config.settled) run.settled_force = std::max(run.settled_force, force);
    if (record.touch.is_reported && run.reported < 0.0) run.reported = since;
    if (record.mode != Mode::kRunning && run.stopped < 0.0) run.stopped = since;
    if (record.fault.code != FaultCode::kNone) run.fault = record.fault.code;
  }
  if (hit_s < 0.0) run.hit_speed = 0.0;
  return run;
}

// Takes the worse of each figure; a figure missing in one run comes from the other.
void take_worse(const ContactRun& run, ContactRun& worst) {
  worst.hit_speed = std::max(worst.hit_speed, run.hit_speed);
  worst.force = std::max(worst.force, run.force);
  worst.pressure = std::max(worst.pressure, run.pressure);
  worst.settled_force = std::max(worst.settled_force, run.settled_force);
  worst.impulse = std::max(worst.impulse, run.impulse);
  worst.contact = std::max(worst.contact, run.contact);
  worst.compression = std::max(worst.compression, run.compression);
  worst.reported = std::max(worst.reported, run.reported);
  worst.stopped = std::max(worst.stopped, run.stopped);
  if (run.fault != FaultCode::kNone) worst.fault = run.fault;
}

struct Permissible {
  double transient, settled, pressure;  // N, N, N/cm^2
};

Permissible permissible(const ContactCase& what) {
  const simulator::BodyPart& part = *simulator::find_body_part(what.part);
  return {part.transient * part.force, part.force, part.transient * part.pressure};
}

nlohmann::ordered_json json_of(const ContactRun& run) {
  nlohmann::ordered_json json = {{"hit_speed_m_per_s", run.hit_speed},
                                 {"max_force_N", run.force},
                                 {"max_pressure_N_per_cm2", run.pressure},
                                 {"settled_force_N", run.settled_force},
                                 {"impulse_Ns", run.impulse},
                                 {"contact_s", run.contact},
                                 {"max_compression_m", run.compression}};
  if (run.reported >= 0.0) json["reported_s"] = run.reported;
  if (run.stopped >= 0.0) json["stopped_s"] = run.stopped;
  if (run.fault != FaultCode::kNone) json["fault"] = to_string(run.fault);
  return json;
}

}  // namespace

ContactRun hit(const config::Scenario& scenario, const ContactConfig& config,
               const ContactCase& what, bool gives_way, std::uint64_t seed) {
  const config::Scenario walk = walking(scenario, config, what.speed);
  return play(with(walk, in_the_way(walk, what), what, gives_way, seed), config);
}

ContactMeasures measure_contact(const config::Scenario& scenario, const ContactConfig& config,
                                const Progress& progress) {
  ContactMeasures report = {.config = config, .results = {}};
  for (const HittingPoint& point : config.points) {
    for (const bool is_clamped : {false, true}) {
      for (const std::string& part : config.parts) {
        for (const double speed : config.speed) {
          report.results.push_back({.what = {part, point, speed, is_clamped}});
        }
      }
    }
  }
  do_all(
      report.results.size(),
      [&](std::size_t i) {
        ContactResult& result = report.results[i];
        const config::Scenario walk = walking(scenario, config, result.what.speed);
        const simulator::BystanderConfig bystander = in_the_way(walk, result.what);
        for (int seed = 1; seed <= config.seeds; ++seed) {
          for (const bool gives_way : {false, true}) {
            const auto number = static_cast<std::uint64_t>(seed);
            const config::Scenario one = with(walk, bystander, result.what, gives_way, number);
            take_worse(play(one, config), gives_way ? result.yielding : result.stiff);
          }
        }
      },
      progress);
  return report;
}

nlohmann::ordered_json to_json(const ContactMeasures& report) {
  nlohmann::ordered_json json;
  json["experiment"] = "contact";
  json["seeds"] = report.config.seeds;
  json["settled_s"] = report.config.settled;
  json["cases"] = nlohmann::ordered_json::array();
  for (const ContactResult& result : report.results) {
    const Permissible most = permissible(result.what);
    json["cases"].push_back({{"hit_by", result.what.point.name},
                             {"body_part", result.what.part},
                             {"speed_m_per_s", result.what.speed},
                             {"is_clamped", result.what.is_clamped},
                             {"permissible_transient_N", most.transient},
                             {"permissible_quasi_static_N", most.settled},
                             {"permissible_pressure_N_per_cm2", most.pressure},
                             {"without", json_of(result.stiff)},
                             {"with", json_of(result.yielding)}});
  }
  return json;
}

}  // namespace hg::experiments
