/// Searches filters and poles of a torque loop: felt quality against vibration, within proven
/// loops.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hg/tune/feel.h"
#include "hg/tune/knobs.h"
#include "hg/tune/proof.h"

namespace hg::tune {

using handle_loop::Body;
using handle_loop::LoopDevice;
using handle_loop::Noise;

/// Tuning problem: properties of a device and design goals.
struct TuningProblem {
  LoopDevice device;
  Noise noise;
  tracking::TruePlant plant;  ///< known plant, for which feel and vibration are computed
  Eigen::VectorXd friction;   ///< unmodelled friction, Nm
  Body body;
  std::vector<Eigen::VectorXd> postures;  ///< postures of the proof
  std::size_t felt_postures = 3;       ///< number of first postures that are used for felt quality
  double friction_most_N = kInfinity;  ///< largest Feel::friction_N
  int most_rounds = 40;                ///< largest number of generations between two proofs
};

/// Cases that the loops of a problem must tolerate.
Demands demands_of(const TuningProblem& problem);

/// Figures of the worst posture and axis.
struct Figures {
  double transparency_Hz = 0.0, latency_s = 0.0;
  /// Mean deviation of the felt impedance from the body's, 1 to 20 Hz on a logarithmic axis: |1 -
  /// felt / body|, with its phase. The search minimises it.
  double distortion = 0.0;
  double friction_N = 0.0;
  double vibration = 0.0, centroid_Hz = 0.0;
};
Figures figures_of(const TuningProblem& problem, const LoopDevice& device);

struct Candidate {
  Values values;
  Figures figures;
};

/// Progress callback: current task, and how far it is.
using Progress = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

struct TuningResult {
  Candidate before;
  Proof proof_before;
  std::vector<Candidate> front;  ///< candidate per limit of vibration, proven where possible
  std::vector<double> limits;    ///< limits of vibration, m/s^2
  std::vector<Proof> proofs;     ///< proofs of the front, in all postures
  /// Proofs in each posture: of `before`, and of the first of the front.
  std::vector<Proof> everywhere_before, everywhere;
};

/// The best loop for each of `limits` of vibration (rms above 20 Hz, m/s^2), by evolution; a case
/// that fails the proof in any posture is added, and the search continues.
TuningResult search(const TuningProblem& problem, const std::vector<double>& limits,
                    const Progress& progress);

}  // namespace hg::tune
