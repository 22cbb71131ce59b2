#include "apps/offline/tune_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "hg/tune/feel.h"

namespace hg::apps {
namespace {

using Json = nlohmann::ordered_json;
using tune::Candidate;
using tune::Figures;
using tune::Proof;

// A loop: its figures, how near it comes to its limits and where, and its values.
Json loop_of(const TuneReport& report, const Candidate& candidate, const Proof& proof,
             double limit) {
  const Figures& figures = candidate.figures;
  Json worst = {{"arm", report.demands.name(proof.worst_arm)},
                {"hand", report.demands.name(proof.worst_hand)}};
  if (proof.friction > 0.0) worst["friction"] = report.demands.name(proof.worst_friction);
  return {
      {"limit_m_per_s2", limit},
      {"vibration_m_per_s2", figures.vibration},
      {"centroid_Hz", figures.centroid_Hz},
      {"transparency_Hz", figures.transparency_Hz},
      {"latency_s", figures.latency_s},
      {"distortion", figures.distortion},
      {"friction_N", figures.friction_N},
      {"arm_radius", proof.arm},
      {"hand_radius", proof.hand},
      {"friction_radius", proof.friction},
      {"is_proven", proof.holds()},
      {"worst", worst},
      {"values", std::vector<double>(candidate.values.begin(), candidate.values.end())},
  };
}

// Felt over rendered impedance, largest and least over the axes and postures evaluated for feel.
Json felt_of(const tune::TuningProblem& problem, const handle_loop::LoopDevice& device) {
  constexpr double kFrom_Hz = 0.5, kTo_Hz = 60.0, kPerDecade = 24.0;
  std::vector<double> frequencies;
  for (double f = kFrom_Hz; f <= kTo_Hz; f *= std::pow(10.0, 1.0 / kPerDecade)) {
    frequencies.push_back(f);
  }
  std::vector<double> least(frequencies.size(), kInfinity), largest(frequencies.size(), 0.0);
  for (std::size_t k = 0; k < std::min(problem.felt_postures, problem.postures.size()); ++k) {
    const tune::HandleLoop loop =
        tune::linearise(device, problem.plant, problem.body, person::HandImpedance{}, problem.noise,
                        problem.postures[k]);
    tune::Resolvent resolvent(loop.A);
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      for (const auto& ratio :
           tune::felt_over_body(resolvent, loop, problem.body, frequencies[i])) {
        least[i] = std::min(least[i], std::abs(ratio));
        largest[i] = std::max(largest[i], std::abs(ratio));
      }
    }
  }
  return {{"frequency_Hz", frequencies}, {"least", least}, {"largest", largest}};
}

Json radii_of(const std::vector<Proof>& everywhere) {
  Json arm = Json::array(), hand = Json::array();
  for (const Proof& proof : everywhere) {
    arm.push_back(proof.arm);
    hand.push_back(proof.hand);
  }
  return {{"arm", arm}, {"hand", hand}};
}

}  // namespace

Json tune_json(const TuneReport& report) {
  const tune::TuningProblem& problem = report.problem;
  const tune::TuningResult& result = report.result;
  const std::size_t postures = problem.postures.size();
  Json json = {{"kind", "tuning"},
               {"device", report.name},
               {"command", report.command},
               {"postures", postures},
               {"felt_postures", std::min(problem.felt_postures, postures)},
               {"cases", postures * report.demands.cases(0).size()},
               {"held_before", std::ranges::count_if(result.everywhere_before, &Proof::holds)},
               {"friction_most_N", problem.friction_most_N},
               {"arm_limit", tune::kArmRadius},
               {"hand_limit", tune::kHandRadius}};
  for (const tune::Knob& knob : tune::knobs()) {
    json["knobs"].push_back({{"section", knob.section}, {"key", knob.key}});
  }
  json["before"] =
      loop_of(report, result.before, result.proof_before, result.before.figures.vibration);
  json["front"] = Json::array();
  for (std::size_t i = 0; i < result.front.size(); ++i) {
    json["front"].push_back(loop_of(report, result.front[i], result.proofs[i], result.limits[i]));
  }
  if (result.front.empty()) return json;
  const handle_loop::LoopDevice tuned =
      tune::with_values(problem.device, result.front.front().values);
  json["felt_before"] = felt_of(problem, problem.device);
  json["felt"] = felt_of(problem, tuned);
  json["radii_before"] = radii_of(result.everywhere_before);
  json["radii"] = radii_of(result.everywhere);
  return json;
}

}  // namespace hg::apps
