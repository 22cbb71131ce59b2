/// Finds filters and poles of a torque loop: what a person feels against vibration, as far as the
/// loop is proven.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hg/tuning/feel.h"
#include "hg/tuning/knobs.h"
#include "hg/tuning/proof.h"

namespace hg::tuning {

/// Everything that tuning knows of a device and of what it shall be good at.
struct Problem {
  Device device;
  Noise noise;
  control::Reality reality;  ///< as far as it is known: in it feel and vibration are computed
  Eigen::VectorXd friction;  ///< that nobody expects, Nm
  Body body;
  std::vector<Eigen::VectorXd> postures;  ///< for the proof
  std::size_t felt_postures = 3;          ///< the first of them, for what is felt
  double friction_most_N = kInfinity;     ///< what unexpected friction may do, see Feel
  int most_rounds = 40;                   ///< generations between two proofs
};

/// What the loops of a problem must tolerate.
Demands demands_of(const Problem& problem);

/// Of the worst posture and axis.
struct Figures {
  double transparency_Hz = 0.0, latency_s = 0.0;
  /// Mean deviation of the felt impedance from the body's, 1 to 20 Hz on a logarithmic axis: |1 -
  /// felt / body|, with its phase. This is what the search makes small.
  double distortion = 0.0;
  double friction_N = 0.0;
  double vibration = 0.0, centroid_Hz = 0.0;
};
Figures figures_of(const Problem& problem, const Device& device);

struct Candidate {
  Values values;
  Figures figures;
};

/// What is being done, and how far it is.
using Told = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

struct Result {
  Candidate before;
  Proof proof_before;
  std::vector<Candidate> front;  ///< one per limit of vibration, proven where that was possible
  std::vector<double> limits;    ///< the limits, m/s^2
  std::vector<Proof> proofs;     ///< of the front, in all postures
  /// In each posture: of `before`, and of the first of the front.
  std::vector<Proof> everywhere_before, everywhere;
};

/// The best loop for each of `limits` of vibration (rms above 20 Hz, m/s^2), by evolution;
/// what fails the proof in any posture counts from then on, and the search goes on.
Result search(const Problem& problem, const std::vector<double>& limits, const Told& told);

}  // namespace hg::tuning
