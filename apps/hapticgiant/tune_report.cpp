#include "apps/hapticgiant/tune_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "hg/studies/tuning/feel.h"

namespace hg::apps {
namespace {

using tuning::Candidate;
using tuning::Figures;
using tuning::Proof;

struct Column {
  const char* name;
  const char* unit;
  int digits;
  double (*of)(const Figures&);
};

constexpr Column kColumns[] = {
    {"transparency", "Hz", 1, [](const Figures& f) { return f.transparency_Hz; }},
    {"latency", "ms", 2, [](const Figures& f) { return 1e3 * f.latency_s; }},
    {"distortion, 1 to 20 Hz", "", 3, [](const Figures& f) { return f.distortion; }},
    {"unexpected friction", "N", 3, [](const Figures& f) { return f.friction_N; }},
    {"vibration", "m/s^2", 4, [](const Figures& f) { return f.vibration; }},
    {"its centroid", "Hz", 0, [](const Figures& f) { return f.centroid_Hz; }},
};

std::string value_of(const Column& column, const Figures& figures) {
  return fmt::format("{:.{}f}", column.of(figures), column.digits);
}

// factor by which errors shrink within 0.1 s
std::string decay(double radius) { return fmt::format("{:.3f}", std::pow(radius, 100.0)); }

using Row = std::function<void(const std::string&, const std::string&, const std::string&)>;

void all_rows(const TuneReport& report, const Row& row) {
  const Figures& before = report.result.before.figures;
  const Figures& after = report.result.front.front().figures;
  for (const Column& column : kColumns) {
    const std::string unit = column.unit[0] != '\0' ? fmt::format(", {}", column.unit) : "";
    row(column.name + unit, value_of(column, before), value_of(column, after));
  }
  const Proof& was = report.result.proof_before;
  const Proof& is = report.result.proofs.front();
  row("errors left after 0.1 s", decay(was.arm), decay(is.arm));
  row("the same in a hand", decay(was.hand), decay(is.hand));
  if (was.friction > 0.0) {
    row("while friction gives way", decay(was.friction), decay(is.friction));
  }
  const auto verdict = [](const Proof& proof) -> std::string {
    return proof.holds() ? "yes" : "NO";
  };
  row("proven", verdict(was), verdict(is));
}

std::string worst_of(const tuning::Demands& demands, const Proof& proof) {
  std::string text = fmt::format("nearest to its limit: {}; in a hand: {}",
                                 demands.name(proof.worst_arm), demands.name(proof.worst_hand));
  if (proof.friction > 0.0) {
    text += fmt::format("; while friction gives way: {}", demands.name(proof.worst_friction));
  }
  return text;
}

}  // namespace

std::string tune_check_text(const TuneReport& report) {
  const tuning::TuningResult& result = report.result;
  std::string text;
  for (const Column& column : kColumns) {
    text += fmt::format("{:28}{:>10} {}\n", column.name, value_of(column, result.before.figures),
                        column.unit);
  }
  const Proof& proof = result.proof_before;
  text += fmt::format("{:28}{:>10}\n{:28}{:>10}\n", "errors left after 0.1 s", decay(proof.arm),
                      "the same in a hand", decay(proof.hand));
  const auto failed = std::ranges::count_if(result.everywhere_before,
                                            [](const Proof& one) { return !one.holds(); });
  return text + fmt::format("{:28}{:>10}\n\nproof       holds in {} of {} postures; {}\n", "proven",
                            proof.holds() ? "yes" : "NO",
                            result.everywhere_before.size() - static_cast<std::size_t>(failed),
                            result.everywhere_before.size(), worst_of(report.demands, proof));
}

std::string tune_text(const TuneReport& report) {
  std::string text = fmt::format("{:28}{:>10}{:>10}\n", "", "now", "tuned");
  all_rows(report,
           [&](const std::string& name, const std::string& before, const std::string& after) {
             text += fmt::format("{:28}{:>10}{:>10}\n", name, before, after);
           });
  const std::size_t postures = report.problem.postures.size();
  text += fmt::format("\nproof       {} cases in {} postures; {}\n",
                      postures * report.demands.cases(0).size(), postures,
                      worst_of(report.demands, report.result.proofs.front()));
  if (!report.result.proof_before.holds()) {
    text += fmt::format("now         {}\n", worst_of(report.demands, report.result.proof_before));
  }
  return text;
}

std::string tune_yaml(const TuneReport& report) {
  const Candidate& candidate = report.result.front.front();
  const Figures& figures = candidate.figures;
  std::string text = fmt::format(
      "# {}\n# transparency {:.1f} Hz, latency {:.1f} ms, vibration {:.3f} m/s^2 in the worst of "
      "{} postures; computed, not measured\n",
      report.command, figures.transparency_Hz, 1e3 * figures.latency_s, figures.vibration,
      std::min(report.problem.felt_postures, report.problem.postures.size()));
  std::string_view section;
  for (std::size_t i = 0; i < tuning::knobs().size(); ++i) {
    const tuning::Knob& knob = tuning::knobs()[i];
    const auto k = static_cast<Eigen::Index>(i);
    if (knob.section != section) text += fmt::format("{}:\n", knob.section);
    section = knob.section;
    text += fmt::format("  {}: {:g}  # was {:g}\n", knob.key, candidate.values[k],
                        report.result.before.values[k]);
  }
  return text;
}

std::string tune_markdown(const TuneReport& report) {
  std::string text = fmt::format(
      "# Filters and poles of {}\n\n`{}`\n\nComputed from the linear loop around the handle "
      "(docs/concepts/control.md): without torque limits and with no friction but that of the row "
      "that says "
      "so. Play it before you trust it: `hapticgiant haptify`, `hapticgiant experiment "
      "stability-map`.\n\n| | now | tuned |\n| --- | --- | --- |\n",
      report.name, report.command);
  all_rows(report,
           [&](const std::string& name, const std::string& before, const std::string& after) {
             text += fmt::format("| {} | {} | {} |\n", name, before, after);
           });
  text += fmt::format(
      "\nNow: {}. Tuned: {}.\n\n## Front\n\n![what is felt, front, proof](figure.svg)\n\n| "
      "vibration at most | vibration "
      "| transparency Hz | latency ms | distortion | unexpected friction N | proven |\n| --- | --- "
      "| --- | --- | --- | --- | --- |\n",
      worst_of(report.demands, report.result.proof_before),
      worst_of(report.demands, report.result.proofs.front()));
  for (std::size_t i = 0; i < report.result.front.size(); ++i) {
    const Figures& figures = report.result.front[i].figures;
    text += fmt::format("| {:.4f} | {:.4f} | {:.1f} | {:.2f} | {:.3f} | {:.3f} | {} |\n",
                        report.result.limits[i], figures.vibration, figures.transparency_Hz,
                        1e3 * figures.latency_s, figures.distortion, figures.friction_N,
                        report.result.proofs[i].holds() ? "yes" : "no");
  }
  return text + fmt::format("\n## For device.yaml\n\n```yaml\n{}```\n", tune_yaml(report));
}

std::string tune_csv(const TuneReport& report) {
  std::string text =
      "limit_m_per_s2,vibration_m_per_s2,centroid_Hz,transparency_Hz,latency_s,"
      "distortion,friction_N,arm_radius,hand_radius,is_proven";
  for (const tuning::Knob& knob : tuning::knobs()) text += fmt::format(",{}", knob.key);
  const auto add = [&](double limit, const Candidate& candidate, const Proof& proof) {
    const Figures& f = candidate.figures;
    text += fmt::format("\n{:g},{:g},{:g},{:g},{:g},{:g},{:g},{:.6f},{:.6f},{}", limit, f.vibration,
                        f.centroid_Hz, f.transparency_Hz, f.latency_s, f.distortion, f.friction_N,
                        proof.arm, proof.hand, proof.holds() ? 1 : 0);
    for (const double value : candidate.values) text += fmt::format(",{:g}", value);
  };
  const tuning::TuningResult& result = report.result;
  add(result.before.figures.vibration, result.before, result.proof_before);
  for (std::size_t i = 0; i < result.front.size(); ++i) {
    add(result.limits[i], result.front[i], result.proofs[i]);
  }
  return text + "\n";
}

namespace {

using Json = nlohmann::ordered_json;

Json point_of(const Candidate& candidate, const Proof& proof) {
  const Figures& figures = candidate.figures;
  return {{"vibration_m_per_s2", figures.vibration},
          {"transparency_Hz", figures.transparency_Hz},
          {"latency_s", figures.latency_s},
          {"is_proven", proof.holds()}};
}

// Felt over rendered impedance, largest and least over the axes and postures evaluated for feel.
Json felt_of(const tuning::TuningProblem& problem, const tuning::TunedDevice& device) {
  constexpr double kFrom_Hz = 0.5, kTo_Hz = 60.0, kPerDecade = 24.0;
  std::vector<double> frequencies;
  for (double f = kFrom_Hz; f <= kTo_Hz; f *= std::pow(10.0, 1.0 / kPerDecade)) {
    frequencies.push_back(f);
  }
  std::vector<double> least(frequencies.size(), kInfinity), largest(frequencies.size(), 0.0);
  for (std::size_t k = 0; k < std::min(problem.felt_postures, problem.postures.size()); ++k) {
    const tuning::HandleLoop loop =
        tuning::linearise(device, problem.plant, problem.body, person::HandImpedance{},
                          problem.noise, problem.postures[k]);
    tuning::Resolvent resolvent(loop.A);
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      for (const auto& ratio :
           tuning::felt_over_body(resolvent, loop, problem.body, frequencies[i])) {
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

std::string tune_figure(const TuneReport& report) {
  const tuning::TuningResult& result = report.result;
  Json front = Json::array();
  for (std::size_t i = 0; i < result.front.size(); ++i) {
    front.push_back(point_of(result.front[i], result.proofs[i]));
  }
  const tuning::TunedDevice tuned =
      tuning::with_values(report.problem.device, result.front.front().values);
  const Json json = {{"kind", "tuning"},
                     {"device", report.name},
                     {"before", point_of(result.before, result.proof_before)},
                     {"front", front},
                     {"felt_before", felt_of(report.problem, report.problem.device)},
                     {"felt", felt_of(report.problem, tuned)},
                     {"radii_before", radii_of(result.everywhere_before)},
                     {"radii", radii_of(result.everywhere)},
                     {"arm_limit", tuning::kArmRadius},
                     {"hand_limit", tuning::kHandRadius}};
  return json.dump(2) + "\n";
}

}  // namespace hg::apps
