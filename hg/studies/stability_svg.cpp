#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "hg/studies/stability_map.h"

namespace hg::studies {
namespace {

// px
constexpr double kLeft = 110.0, kTop = 92.0, kCell = 34.0, kGap = 110.0, kLegend = 96.0;

// distinguishable with colour vision deficiency (Okabe, Ito)
const char* colour(DecayClass verdict) {
  switch (verdict) {
    case DecayClass::kStable:
      return "#dff0e8";
    case DecayClass::kSlow:
      return "#a6d5f0";
    case DecayClass::kHunts:
      return "#f0e442";
    case DecayClass::kSustained:
      return "#e69f00";
    case DecayClass::kDiverges:
      return "#d55e00";
  }
  return "#fff";
}

using Out = std::back_insert_iterator<std::string>;

void draw_text(double x, double y, const char* anchor, const std::string& text, Out out) {
  fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y,
                 anchor, text);
}

void draw_cell(double x, double y, DecayClass verdict, Out out) {
  fmt::format_to(out,
                 "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
                 "fill=\"{}\"/>\n",
                 x + 1.0, y + 1.0, kCell - 2.0, kCell - 2.0, colour(verdict));
  if (verdict == DecayClass::kStable) return;
  draw_text(x + 0.5 * kCell, y + 0.5 * kCell + 4.0, "middle", std::string(1, symbol(verdict)), out);
}

void draw_panel(const StabilityMap& map, double left, std::size_t first, std::size_t count,
                Out out) {
  const double width = kCell * static_cast<double>(map.config.mass.size());
  fmt::format_to(
      out, "<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">Twin with {:g} Ns/m</text>\n",
      left, kTop - 12.0, map.rows[first].damping);
  for (std::size_t i = 0; i < count; ++i) {
    const StabilityRow& row = map.rows[first + i];
    const double y = kTop + kCell * static_cast<double>(i);
    draw_text(left - 8.0, y + 0.5 * kCell + 4.0, "end", row.hand, out);
    for (std::size_t k = 0; k < row.outcomes.size(); ++k) {
      draw_cell(left + kCell * static_cast<double>(k), y, row.outcomes[k].verdict, out);
    }
    const std::string from = std::isinf(row.stable_from) ? "none"
                             : row.stable_from <= map.config.least_mass
                                 ? fmt::format("&#8804; {:g}", row.stable_from)
                                 : fmt::format("{:.2f}", row.stable_from);
    draw_text(left + width + 8.0, y + 0.5 * kCell + 4.0, "start", from, out);
  }
  const double bottom = kTop + kCell * static_cast<double>(count);
  for (std::size_t k = 0; k < map.config.mass.size(); ++k) {
    draw_text(left + kCell * (static_cast<double>(k) + 0.5), bottom + 16.0, "middle",
              fmt::format("{:g}", map.config.mass[k]), out);
  }
  draw_text(left + 0.5 * width, bottom + 34.0, "middle", "rendered mass in kg", out);
  draw_text(left + width + 8.0, kTop - 12.0, "start", "from, kg", out);
}

void draw_legend(double top, const CalmRule& calm, double watched, Out out) {
  const std::array<std::pair<DecayClass, std::string>, 5> entries = {
      {{DecayClass::kStable, "stable"},
       {DecayClass::kSlow, fmt::format("calms down, not within {:g} s", watched)},
       {DecayClass::kHunts, "hunts, by friction only"},
       {DecayClass::kSustained, fmt::format("sustained, above {:g} mm/s", 1e3 * calm.calm_speed)},
       {DecayClass::kDiverges, "diverges"}}};
  double x = kLeft;
  for (const auto& [verdict, text] : entries) {
    draw_cell(x, top, verdict, out);
    draw_text(x + kCell + 6.0, top + 0.5 * kCell + 4.0, "start", text, out);
    x += kCell + 26.0 + 6.2 * static_cast<double>(text.size());
  }
}

}  // namespace

std::string to_svg(const StabilityMap& map) {
  std::string body;
  Out out(body);
  const std::size_t panels = map.config.damping.size();
  const std::size_t hands = panels > 0 ? map.rows.size() / panels : 0;
  const double panel_width = kCell * static_cast<double>(map.config.mass.size()) + kGap;
  double left = kLeft;
  for (std::size_t panel = 0; panel < panels; ++panel) {
    draw_panel(map, left, panel * hands, hands, out);
    left += panel_width + kLeft;
  }
  const double bottom = kTop + kCell * static_cast<double>(hands) + 50.0;
  draw_legend(bottom, map.config.calm, map.config.kick.watched, out);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<text x=\"20\" y=\"26\" font-size=\"16\" font-weight=\"bold\">Where contact becomes unstable"
      "</text>\n<text x=\"20\" y=\"46\">Simulated {2}. A free body is held by a mass of {3:g} kg "
      "on "
      "a spring (or by a person) and kicked with {4:g} N for {5:g} ms.</text>\n{6}</svg>\n",
      std::max(left - kLeft, 800.0), bottom + kLegend - 40.0, map.device, map.config.hand.mass,
      map.config.kick.force, 1e3 * map.config.kick.duration, body);
}

}  // namespace hg::studies
