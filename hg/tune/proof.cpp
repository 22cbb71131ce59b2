#include "hg/tune/proof.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hg/core/linear_algebra.h"
#include "hg/experiments/stability_map.h"

namespace hg::tune {
namespace {

Deviation late(const tracking::Loop& nominal) {
  constexpr double kMore = 1.5;
  tracking::TruePlant plant = {nominal.device.actuators, nominal.config.loop};
  plant.loop.latency *= kMore;
  return {fmt::format("latency x {:g}", kMore), plant};
}

}  // namespace

std::vector<Deviation> deviations(const tracking::Loop& nominal) {
  const tracking::TruePlant as_nominal = {nominal.device.actuators, nominal.config.loop};
  std::vector<Deviation> all = {{"nominal", as_nominal}};
  for (const double factor : {0.75, 1.25}) {
    tracking::TruePlant rotors = as_nominal, springs = as_nominal, links = as_nominal;
    for (ActuatorModel& actuator : rotors.actuators) actuator.rotor_inertia *= factor;
    for (ActuatorModel& actuator : springs.actuators) actuator.stiffness *= factor;
    links.link_mass = factor;
    all.push_back({fmt::format("rotors x {:g}", factor), rotors});
    all.push_back({fmt::format("springs x {:g}", factor), springs});
    all.push_back({fmt::format("links x {:g}", factor), links});
  }
  all.push_back(late(nominal));
  return all;
}

std::vector<Deviation> deviations_in_hand(const tracking::Loop& nominal) {
  const tracking::TruePlant as_nominal = {nominal.device.actuators, nominal.config.loop};
  constexpr double kLighter = 0.65;
  return {{"nominal", as_nominal, 1.0, kLighter},
          late(nominal),
          {"torques at their bounds", as_nominal, 0.5, kLighter}};
}

std::vector<Deviation> deviations_in_friction(const tracking::Loop& nominal) {
  std::vector<Deviation> all;
  if (std::ranges::none_of(nominal.device.actuators, has_presliding)) return all;
  for (const double real : {0.5, 1.0, 1.25}) {
    for (const double share : {0.5, 1.0, 1.25}) {
      tracking::TruePlant plant = {nominal.device.actuators, nominal.config.loop};
      plant.bristles.resize(nominal.device.actuators.size());
      for (Eigen::Index i = 0; i < plant.bristles.size(); ++i) {
        plant.bristles[i] = real * presliding_stiffness(nominal.device.actuators[i]);
      }
      all.push_back({.what = fmt::format("bristles x {:g}, fed forward x {:g}", real, share * real),
                     .plant = plant,
                     .fed = share * real});
    }
  }
  return all;
}

std::vector<Grasp> grasps(const Body& body) {
  std::vector<Grasp> all;
  const auto add = [&](const std::string& what, const person::HandImpedance& hand, double mass) {
    Body held = body;
    held.mass = std::min(body.mass, mass);
    all.push_back({what, hand, held});
  };
  add("relaxed hand", person::hand(person::HandPreset::kRelaxed), 0.3);
  add("normal hand", person::hand(person::HandPreset::kNormal), 0.4);
  add("stiff hand", person::hand(person::HandPreset::kStiff), 0.9);
  for (const double stiffness : {300.0, 1000.0, 2000.0}) {
    add(fmt::format("spring of {:g} N/m", stiffness), experiments::spring_hand({}, stiffness), 2.0);
  }
  return all;
}

Demands::Demands(const tracking::Loop& nominal, const Body& body,
                 std::vector<Eigen::VectorXd> postures)
    : body_(body),
      deviations_(deviations(nominal)),
      deviations_in_hand_(deviations_in_hand(nominal)),
      grasps_(grasps(body)),
      postures_(std::move(postures)) {
  for (Deviation& deviation : deviations_in_friction(nominal))
    deviations_in_hand_.push_back(std::move(deviation));
}

std::vector<Case> Demands::cases(std::size_t posture) const {
  std::vector<Case> all;
  for (std::size_t deviation = 0; deviation < deviations_.size(); ++deviation)
    all.push_back({posture, deviation});
  for (std::size_t deviation = 0; deviation < deviations_in_hand_.size(); ++deviation) {
    for (int grasp = 0; grasp < static_cast<int>(grasps_.size()); ++grasp) {
      all.push_back({posture, deviation, grasp});
    }
  }
  return all;
}

const Deviation& Demands::deviation(const Case& one) const {
  return (one.grasp < 0 ? deviations_ : deviations_in_hand_)[one.deviation];
}

double Demands::radius(const LoopDevice& device, const Case& one) const {
  const Deviation& real = deviation(one);
  const Eigen::VectorXd& q = postures_[one.posture];
  const tracking::ControlConfig& config = device.loop.config;
  const double scale = 1e-3 / device.loop.device.dt();
  if (one.grasp < 0) {
    return std::pow(tracking::spectral_radius(device.loop, q, config.loop.latency, real.plant),
                    scale);
  }
  const Grasp& grasp = grasps_[one.grasp];
  Body body = is_friction(one) ? body_ : grasp.body;
  body.mass *= real.mass;
  LoopDevice doubted = device;
  if (is_friction(one)) doubted.loop.config.friction_share = real.fed;
  doubted.loop.config.flatness_Hz *= real.follower;
  return std::pow(hg::spectral_radius(linearise(doubted, real.plant, body, grasp.hand, {}, q).A),
                  scale);
}

double Demands::excess(const LoopDevice& device, const Case& one) const {
  const double in_hand = is_friction(one) ? kFrictionRadius : kHandRadius;
  return radius(device, one) - (one.grasp < 0 ? kArmRadius : in_hand);
}

std::string Demands::name(const Case& one) const {
  const std::string& what = deviation(one).what;
  if (one.grasp < 0) return what;
  const Grasp& grasp = grasps_[one.grasp];
  const double mass = is_friction(one) ? body_.mass : deviation(one).mass * grasp.body.mass;
  return fmt::format("{}, {:.2g} kg, {}", grasp.what, mass, what);
}

}  // namespace hg::tune
