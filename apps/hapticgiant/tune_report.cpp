#include "apps/hapticgiant/tune_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

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

// by how much errors shrink within 0.1 s
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
      "(docs/control.md): without torque limits and with no friction but that of the row that says "
      "so. Play it before you trust it: `hapticgiant haptify`, `hapticgiant experiment "
      "stability-map`.\n\n| | now | tuned |\n| --- | --- | --- |\n",
      report.name, report.command);
  all_rows(report,
           [&](const std::string& name, const std::string& before, const std::string& after) {
             text += fmt::format("| {} | {} | {} |\n", name, before, after);
           });
  text += fmt::format(
      "\nNow: {}. Tuned: {}.\n\n## Front\n\n![front](front.svg)\n\n| vibration at most | vibration "
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
  const tuning::Result& result = report.result;
  add(result.before.figures.vibration, result.before, result.proof_before);
  for (std::size_t i = 0; i < result.front.size(); ++i) {
    add(result.limits[i], result.front[i], result.proofs[i]);
  }
  return text + "\n";
}

std::string tune_svg(const TuneReport& report) {
  constexpr double kWidth = 640.0, kHeight = 360.0, kLeft = 60.0, kBottom = 300.0, kTop = 40.0;
  constexpr double kVibrationTick = 0.01, kHzTick = 5.0;
  std::vector<const Candidate*> all = {&report.result.before};
  for (const Candidate& candidate : report.result.front) all.push_back(&candidate);
  double most_vibration = 0.0, most_Hz = 0.0;
  for (const Candidate* one : all) {
    most_vibration = std::max(most_vibration, 1.2 * one->figures.vibration);
    most_Hz = std::max(most_Hz, 1.15 * one->figures.transparency_Hz);
  }
  const auto x = [&](double vibration) {
    return kLeft + (kWidth - kLeft - 20.0) * vibration / most_vibration;
  };
  const auto y = [&](double Hz) { return kBottom - (kBottom - kTop) * Hz / most_Hz; };
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"#fff\"/>\n<path d=\"M{2} {3}V{4}H{5}\" fill=\"none\" stroke=\"#444\"/>\n"
      "<text x=\"{6}\" y=\"{7}\" text-anchor=\"middle\">vibration above 20 Hz, m/s^2</text>\n"
      "<text x=\"20\" y=\"20\">transparency, Hz; at each point the latency</text>\n",
      kWidth, kHeight, kLeft, kTop, kBottom, kWidth - 20.0, 0.5 * (kLeft + kWidth), kBottom + 44.0);
  const double vibration_tick = kVibrationTick * std::max(1.0, std::round(most_vibration / 0.06));
  for (double at = 0.0; at < most_vibration; at += vibration_tick) {
    svg += fmt::format(
        "<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\" fill=\"#444\">{:g}</text>\n", x(at),
        kBottom + 20.0, at);
  }
  const double Hz_tick = kHzTick * std::max(1.0, std::round(most_Hz / 30.0));
  for (double at = Hz_tick; at < most_Hz; at += Hz_tick) {
    svg += fmt::format(
        "<path d=\"M{} {:.1f}H{}\" stroke=\"#ddd\"/><text x=\"{}\" y=\"{:.1f}\" "
        "text-anchor=\"end\" fill=\"#444\">{:g}</text>\n",
        kLeft, y(at), kWidth - 20.0, kLeft - 8.0, y(at) + 4.0, at);
  }
  // what is there now stands below the front: its label goes there, too
  for (const Candidate* one : all) {
    const bool is_before = one == all.front();
    const double px = x(one->figures.vibration), py = y(one->figures.transparency_Hz);
    svg += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"/><text x=\"{:.1f}\" "
        "y=\"{:.1f}\" text-anchor=\"{}\">{}{:.1f} ms</text>\n",
        px, py, is_before ? "#d55e00" : "#0072b2", px + (is_before ? 9.0 : -9.0),
        py + (is_before ? 16.0 : -6.0), is_before ? "start" : "end", is_before ? "now: " : "",
        1e3 * one->figures.latency_s);
  }
  return svg + "</svg>\n";
}

}  // namespace hg::apps
