/// Response of the handle to a hand, by frequency and in time: transparency, bandwidths, latency.
///
/// An instrument pushes along one axis of H to and fro; the motion of the handle is compared with
/// that of the twin. Amplitudes are those at the frequency itself. SI units.
///
/// The one definition of felt impedance.
#pragma once

#include <complex>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/place.h"
#include "hg/simulator/person/script.h"

namespace hg::haptify {

struct ResponseConfig {
  std::vector<double> frequency_Hz{0.1, 0.2, 0.5, 1, 2, 3, 5, 8, 12, 20, 30, 50};
  double force = 10.0;  ///< amplitude of the push, N: beyond the friction of the joints, [A]
  int periods = 5;      ///< evaluated periods per frequency, at least `least_s` long
  double least_s = 2.0;
  Eigen::Vector3d position = experiments::Place{}.middle;  ///< position of the handle, m in B
  double step_force = 10.0;  ///< height of the force step for the latency, N
  double watched_s = 0.15;   ///< time observed after the step, s
};

/// The scenario with the handle in the middle, played by an instrument that trembles as a hand
/// does: what does not is no touch (estimation/rest_watch.h).
config::Scenario instrument(const config::Scenario& scenario, const ResponseConfig& config,
                            const person::Script& script, std::uint64_t seed);

/// Response at one frequency, along one axis of H.
struct Answer {
  double frequency_Hz = 0.0;
  std::complex<double> impedance;  ///< true force over true velocity of the handle, Ns/m
  std::complex<double> twin;       ///< impedance of the free body, Ns/m: j w m + b
  std::complex<double> following;  ///< position of the true handle over that of the twin
};

struct Response {
  std::vector<Answer> answers;
  std::string failure;
};

/// Frequency up to which the felt impedance is within 3 dB of the body's, Hz; needs answers.
double transparency_Hz(const Response& response);

/// Measures the response along `axis` 0..2 of H. Throws SetupError when the twin is not a free
/// body.
Response measure_response(const config::Scenario& scenario, const ResponseConfig& config, int axis,
                          std::uint64_t seed);

/// Force response at one frequency: force of a hand that holds still over the reference wrench of
/// the twin, which the person should exert ([HG] (9)).
struct ForceAnswer {
  double frequency_Hz = 0.0;
  std::complex<double> rendered;  ///< true force of the person over the commanded one
  /// Response of the same twin in the same hand without a device between
  std::complex<double> ideal;
};

struct ForceResponse {
  std::vector<ForceAnswer> answers;
  std::string failure;
};

/// Measures the force response: reference wrench w_ref to and fro, the stiff hand of [HANDBOOK] 5.1
/// held still.
ForceResponse measure_force_response(const config::Scenario& scenario, const ResponseConfig& config,
                                     int axis, std::uint64_t seed);

struct Latency {
  double motion_s = 0.0;  ///< delay of the handle's true velocity behind that of an ideal twin
  double sensed_s = 0.0;  ///< part of this by which the twin's own velocity is behind
  std::string failure;
};

/// Measures the latency from a step of the person's push.
Latency measure_latency(const config::Scenario& scenario, const ResponseConfig& config, int axis,
                        std::uint64_t seed);

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Latency, motion_s, sensed_s, failure)

}  // namespace hg::haptify
