// Transparency, bandwidths and latency, and where the acceleration that the device can give is
// felt: hard pulls, light rotations, stiff springs.

#include <complex>
#include <string>
#include <vector>

#include "hg/experiments/changes.h"
#include "hg/experiments/haptify/felt_body.h"
#include "hg/experiments/haptify/groups.h"
#include "hg/experiments/haptify/measures.h"
#include "hg/experiments/haptify/response.h"
#include "hg/experiments/haptify/swing.h"

namespace hg::haptify {
namespace {

using nlohmann::json;
using Values = std::vector<double>;

constexpr int kAxes = 3;

ResponseConfig config_of(const Group& group, const Values& frequency_Hz) {
  ResponseConfig config = placed(ResponseConfig(), group.place);
  config.frequency_Hz = frequency_Hz;
  if (!group.options.is_quick) return config;
  config.frequency_Hz = {1, 5, 20};
  config.periods = 3;
  config.least_s = 0.6;
  return config;
}

json complex(const std::complex<double>& value) { return {value.real(), value.imag()}; }

// A pull, at a found place along a way whose middle is that of the place.
json pull(const Group& group, int axis, double force, std::uint64_t seed) {
  PullConfig config = placed(PullConfig(), group.place);
  if (group.place.is_found) {
    const double mass = experiments::free_twin_of(group.scenario).mass;
    const double way = 0.5 * force / mass * config.to_s * config.to_s;
    const Eigen::Vector3d direction = group.place.R_B_H.col(axis);
    const std::string why = experiments::no_room(group.place, direction, way);
    if (!why.empty()) return impossible(why);
    config.position -= 0.5 * way * direction;
  }
  return json(measure_pull(group.scenario, config, axis, force, seed));
}

json as_json(const Response& response) {
  json answers = json::array();
  Values frequency_Hz, following;
  for (const Answer& answer : response.answers) {
    answers.push_back({{"frequency_Hz", answer.frequency_Hz},
                       {"impedance", complex(answer.impedance)},
                       {"twin", complex(answer.twin)},
                       {"following", complex(answer.following)}});
    frequency_Hz.push_back(answer.frequency_Hz);
    following.push_back(std::abs(answer.following));
  }
  return {{"answers", answers},
          {"transparency_Hz", transparency_Hz(response)},
          {"position_Hz", bandwidth(frequency_Hz, following, kWithin3dB)},
          {"failure", response.failure}};
}

json as_json(const ForceResponse& response) {
  json answers = json::array();
  Values frequency_Hz, ratio, rendered;
  for (const ForceAnswer& answer : response.answers) {
    answers.push_back({{"frequency_Hz", answer.frequency_Hz},
                       {"rendered", complex(answer.rendered)},
                       {"ideal", complex(answer.ideal)}});
    frequency_Hz.push_back(answer.frequency_Hz);
    ratio.push_back(std::abs(answer.rendered / answer.ideal));
    rendered.push_back(std::abs(answer.rendered));
  }
  return {{"answers", answers},
          {"force_Hz", bandwidth(frequency_Hz, ratio, kWithin3dB)},
          {"absolute_Hz", bandwidth(frequency_Hz, rendered, kWithin3dB)},
          {"failure", response.failure}};
}

}  // namespace

void add_transparency(const Group& group) {
  const ResponseConfig config = config_of(group, ResponseConfig{}.frequency_Hz);
  std::vector<Play> plays;
  plays.reserve(kAxes);
  for (int axis = 0; axis < kAxes; ++axis) {
    plays.push_back({{{"axis", axis}}, [&, axis] {
                       return as_json(
                           measure_response(group.scenario, config, axis, group.options.seed));
                     }});
  }
  group.add("transparency", {{"highest_Hz", config.frequency_Hz.back()}}, plays);
}

void add_force_response(const Group& group) {
  ResponseConfig config = config_of(group, ResponseConfig{}.frequency_Hz);
  std::erase_if(config.frequency_Hz, [](double frequency) { return frequency < 0.5; });
  std::vector<Play> plays;
  plays.reserve(kAxes);
  for (int axis = 0; axis < kAxes; ++axis) {
    plays.push_back(
        {{{"axis", axis}}, [&, axis] {
           return as_json(measure_force_response(group.scenario, config, axis, group.options.seed));
         }});
  }
  group.add("force response", json::object(), plays);
}

void add_latency(const Group& group) {
  const ResponseConfig config = placed(ResponseConfig(), group.place);
  std::vector<Play> plays;
  for (const std::uint64_t seed : group.seeds()) {
    for (int axis = 0; axis < kAxes; ++axis) {
      plays.push_back({{{"axis", axis}, {"seed", seed}}, [&group, &config, axis, seed] {
                         return json(measure_latency(group.scenario, config, axis, seed));
                       }});
    }
  }
  group.add("latency", json::object(), plays);
}

void add_felt_mass(const Group& group) {
  const Values forces = group.options.is_quick ? Values{20, 60} : Values{10, 20, 40, 60};
  std::vector<Play> pulls, pushes;
  for (const double force : forces) {
    ResponseConfig config = config_of(group, {0.5, 1, 2, 3, 5, 8, 12, 20});
    config.force = force;
    for (int axis = 0; axis < kAxes; ++axis) {
      for (const std::uint64_t seed : group.seeds()) {
        pulls.push_back({{{"force", force}, {"axis", axis}, {"seed", seed}},
                         [=, &group] { return pull(group, axis, force, seed); }});
      }
      pushes.push_back(
          {{{"force", force}, {"axis", axis}}, [=, &group] {
             const Response found =
                 measure_response(group.scenario, config, axis, group.options.seed);
             // what ends a run that is pushed too hard is a result, not a failure
             return json{{"transparency_Hz", transparency_Hz(found)}, {"end", found.failure}};
           }});
    }
  }
  group.add("felt mass", {{"mass", experiments::free_twin_of(group.scenario).mass}}, pulls);
  group.add("transparency of hard pushes", json::object(), pushes);
}

void add_rotation(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values inertia = is_quick ? Values{0.005, 0.02} : Values{0.001, 0.002, 0.003, 0.005, 0.007,
                                                                 0.01,  0.015, 0.02,  0.03,  0.05};
  const TwistConfig config = placed(TwistConfig(), group.place);
  std::vector<Play> plays;
  for (const auto& [hand, preset] : hands(is_quick)) {
    for (const double value : inertia) {
      plays.push_back(
          {{{"hand", hand}, {"inertia", value}}, [&, preset = preset, value] {
             const Twist found = twist(group.scenario, config, person::hand(preset), value);
             return json{{"verdict", to_string(found.verdict)}, {"failure", found.failure}};
           }});
    }
  }
  group.add("light rotations",
            {{"inertia", inertia},
             {"torque", config.torque},
             {"duration_s", config.duration},
             {"calm_speed", config.calm.calm_speed},
             {"calm_s", 3.5 * config.calm.window}},
            plays);
}

void add_springs(const Group& group) {
  const bool is_quick = group.options.is_quick;
  const Values stiffness = is_quick ? Values{500} : Values{50, 500, 2000};
  const Values deflection = is_quick ? Values{0.002} : Values{0.002, 0.02};  // m, of the handle
  SwingConfig config = placed(SwingConfig(), group.place);
  if (is_quick) config.watched_s = 3.0;
  std::vector<Play> plays;
  for (const double k : stiffness) {
    for (const double from : deflection) {
      for (const std::uint64_t seed : group.seeds()) {
        plays.push_back(
            {{{"stiffness", k}, {"deflection", from}, {"seed", seed}}, [=, &group] {
               return json(measure_swing(group.scenario, config, k, from / config.radius, seed));
             }});
      }
    }
  }
  group.add("springs",
            {{"inertia", config.inertia},
             {"damping", config.damping},
             {"radius", config.radius},
             {"swings", config.swings}},
            plays);
}

}  // namespace hg::haptify
