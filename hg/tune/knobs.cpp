#include "hg/tune/knobs.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hg::tune {
namespace {

// Ranges: what has ever been of use, and what device.yaml takes.
constexpr std::array<Knob, 11> kKnobs = {{
    {"estimation", "wrench_low_pass_Hz", 20.0, 250.0,
     [](const LoopDevice& d) { return d.wrench.low_pass_Hz; },
     [](LoopDevice& d, double x) { d.wrench.low_pass_Hz = x; }},
    {"estimation", "motor_low_pass_Hz", 60.0, 400.0,
     [](const LoopDevice& d) { return d.loop.filters.motor_low_pass_Hz; },
     [](LoopDevice& d, double x) { d.loop.filters.motor_low_pass_Hz = x; }},
    {"control", "flatness_Hz", 20.0, 110.0,
     [](const LoopDevice& d) { return d.loop.config.flatness_Hz; },
     [](LoopDevice& d, double x) { d.loop.config.flatness_Hz = x; }},
    {"control", "wrench_lead_s", 0.0, 0.008,
     [](const LoopDevice& d) { return d.loop.config.wrench_lead; },
     [](LoopDevice& d, double x) { d.loop.config.wrench_lead = x; }},
    {"control", "lead_low_pass_Hz", 20.0, 200.0,
     [](const LoopDevice& d) { return d.loop.config.lead_low_pass_Hz; },
     [](LoopDevice& d, double x) { d.loop.config.lead_low_pass_Hz = x; }},
    {"control", "stiff_low_pass_Hz", 10.0, 150.0,
     [](const LoopDevice& d) { return d.loop.config.stiff_low_pass_Hz; },
     [](LoopDevice& d, double x) { d.loop.config.stiff_low_pass_Hz = x; }},
    {"control", "rotor_pole_rad_per_s", 40.0, 250.0,
     [](const LoopDevice& d) { return d.loop.config.poles.w0; },
     [](LoopDevice& d, double x) { d.loop.config.poles.w0 = x; }},
    {"control", "link_pole_rad_per_s", 10.0, 120.0,
     [](const LoopDevice& d) { return d.loop.config.poles.w1; },
     [](LoopDevice& d, double x) { d.loop.config.poles.w1 = x; }},
    {"control", "link_damping", 0.5, 1.5,
     [](const LoopDevice& d) { return d.loop.config.poles.z1; },
     [](LoopDevice& d, double x) { d.loop.config.poles.z1 = x; }},
    {"control", "spring_damping", 0.1, 0.8,
     [](const LoopDevice& d) { return d.loop.config.poles.z2; },
     [](LoopDevice& d, double x) { d.loop.config.poles.z2 = x; }},
    {"control", "motor_pole_rad_per_s", 20.0, 200.0,
     [](const LoopDevice& d) { return d.loop.config.poles.w_motor; },
     [](LoopDevice& d, double x) { d.loop.config.poles.w_motor = x; }},
}};

// the largest useful value; latency or rate reduce higher ones
double most_of(const Knob& knob, const LoopDevice& device) {
  const tracking::ControlConfig& config = device.loop.config;
  if (knob.key == "rotor_pole_rad_per_s") {
    return std::min(knob.most,
                    tracking::largest_rotor_pole(config.loop.latency + config.loop.current_lag));
  }
  if (knob.key == "flatness_Hz") {
    return std::min(knob.most, 0.8 * tracking::largest_flatness_Hz(device.loop.device.rate_Hz));
  }
  return knob.most;
}

}  // namespace

std::span<const Knob> knobs() { return kKnobs; }

Values values_of(const LoopDevice& device) {
  Values values(static_cast<Eigen::Index>(kKnobs.size()));
  for (std::size_t i = 0; i < kKnobs.size(); ++i) {
    values[i] = kKnobs[i].get(device);
  }
  return values;
}

LoopDevice with_values(LoopDevice device, const Values& values) {
  for (std::size_t i = 0; i < kKnobs.size(); ++i) {
    const Knob& knob = kKnobs[i];
    const double most = most_of(knob, device);
    const double value = values[i];
    knob.set(device, std::clamp(value, std::min(knob.least, most), most));
  }
  return device;
}

Eigen::VectorXd place_of(const Values& values) {
  Eigen::VectorXd place(values.size());
  for (std::size_t i = 0; i < kKnobs.size(); ++i) {
    const Knob& knob = kKnobs[i];
    const auto k = static_cast<Eigen::Index>(i);
    // a low-pass of 0 is none
    const double value = values[k] == 0.0 && knob.least > 0.0 ? knob.most : values[k];
    const double x = std::clamp(value, knob.least, knob.most);
    place[k] = knob.least > 0.0 ? std::log(x / knob.least) / std::log(knob.most / knob.least)
                                : x / knob.most;
  }
  return place;
}

Values values_at(const Eigen::VectorXd& place) {
  Values values(place.size());
  for (std::size_t i = 0; i < kKnobs.size(); ++i) {
    const Knob& knob = kKnobs[i];
    const auto k = static_cast<Eigen::Index>(i);
    values[k] = knob.least > 0.0 ? knob.least * std::pow(knob.most / knob.least, place[k])
                                 : knob.most * place[k];
  }
  return values;
}

}  // namespace hg::tune
