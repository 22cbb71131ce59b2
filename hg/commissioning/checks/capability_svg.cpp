#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "hg/commissioning/checks/capability_map.h"
#include "hg/core/index.h"
#include "hg/core/text.h"

namespace hg::checks {
namespace {

constexpr double kScale = 120.0;  // px per metre of a workspace of kSpan
constexpr double kSpan = 4.0;     // m
constexpr double kLeft = 70.0, kTop = 70.0, kGap = 70.0, kLegend = 130.0;  // px

// From dark blue over green to yellow, equally bright steps; value in 0..1.
std::string colour(double value) {
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};
  const double at = std::clamp(value, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double share = at - static_cast<double>(i);
  std::array<int, 3> rgb{};
  for (std::size_t k = 0; k < 3; ++k) {
    rgb[k] = static_cast<int>(std::lround(std::lerp(kStops[i][k], kStops[i + 1][k], share)));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

// One section in px: B's axes to the right and up, origin of the picture top left.
struct Frame {
  double left = 0.0, top = 0.0, scale = kScale;
  Interval x, y;
  double px(double value) const { return left + (value - x.lb) * scale; }
  double py(double value) const { return top + (y.ub - value) * scale; }
  double width() const { return (x.ub - x.lb) * scale; }
  double height() const { return (y.ub - y.lb) * scale; }
};

using Out = std::back_insert_iterator<std::string>;

void draw_cells(const Section& section, const Frame& frame, double force_max, Out out) {
  const double size = section.cell * frame.scale;
  for (int row = 0; row < section.rows; ++row) {
    for (int column = 0; column < section.columns; ++column) {
      const double force = section.force[index(row * section.columns + column)];
      if (!std::isfinite(force)) continue;
      fmt::format_to(out,
                     "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
                     "fill=\"{}\"/>\n",
                     frame.left + column * size, frame.top + frame.height() - (row + 1) * size,
                     size + 0.3, size + 0.3, colour(force / force_max));
    }
  }
}

void draw_axes(const Section& section, const Frame& frame, double tick, Out out) {
  const char right = "xyz"[section.right], up = "xyz"[section.up];
  fmt::format_to(out,
                 "<rect class=\"edge\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                 "height=\"{:.1f}\"/>\n",
                 frame.left, frame.top, frame.width(), frame.height());
  for (double x = std::ceil(frame.x.lb / tick) * tick; x <= frame.x.ub; x += tick) {
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.1f}</text>\n",
                   frame.px(x), frame.top + frame.height() + 16, x + 0.0);
  }
  for (double y = std::ceil(frame.y.lb / tick) * tick; y <= frame.y.ub; y += tick) {
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:.1f}</text>\n",
                   frame.left - 6, frame.py(y) + 4, y + 0.0);
  }
  fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{} in m</text>\n",
                 frame.left + 0.5 * frame.width(), frame.top + frame.height() + 34, right);
  fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\">{} in m</text>\n", frame.left - 50,
                 frame.top - 8, up);
  fmt::format_to(out,
                 "<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">Section at {} = {:.2f} "
                 "m</text>\n",
                 frame.left + 10, frame.top - 8, "xyz"[section.normal],
                 std::abs(section.height) < 5e-3 ? 0.0 : section.height);
}

void draw_box(const Section& section, const Frame& frame, Out out) {
  if (!std::isfinite(section.box_x.lb + section.box_x.ub + section.box_y.lb + section.box_y.ub)) {
    return;
  }
  fmt::format_to(out,
                 "<rect class=\"box\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
                 "height=\"{:.1f}\"/>\n",
                 frame.px(section.box_x.lb), frame.py(section.box_y.ub),
                 (section.box_x.ub - section.box_x.lb) * frame.scale,
                 (section.box_y.ub - section.box_y.lb) * frame.scale);
}

void draw_legend(double left, double top, double force_max, Out out) {
  constexpr int kSteps = 40;
  constexpr double kHeight = 240.0;
  fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\">force in N</text>\n", left, top - 8);
  for (int i = 0; i < kSteps; ++i) {
    const double step = kHeight / kSteps;
    fmt::format_to(out,
                   "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"18\" height=\"{:.2f}\" "
                   "fill=\"{}\"/>\n",
                   left, top + kHeight - (i + 1) * step, step + 0.3, colour((i + 0.5) / kSteps));
  }
  for (int i = 0; i <= 4; ++i) {
    fmt::format_to(out, "<text x=\"{:.1f}\" y=\"{:.1f}\">{:g}{}</text>\n", left + 24,
                   top + kHeight * (1.0 - 0.25 * i) + 4, 0.25 * i * force_max,
                   i == 4 ? " or more" : "");
  }
  fmt::format_to(out,
                 "<rect class=\"box\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"18\" height=\"14\"/>"
                 "<text x=\"{:.1f}\" y=\"{:.1f}\">box of the handle</text>\n",
                 left, top + kHeight + 24, left + 24, top + kHeight + 36);
  fmt::format_to(out,
                 "<rect class=\"edge\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"18\" height=\"14\"/>"
                 "<text x=\"{:.1f}\" y=\"{:.1f}\">not reached</text>\n",
                 left, top + kHeight + 48, left + 24, top + kHeight + 60);
}

// The section and the box, a little apart from the frame.
Frame make_frame(const Section& section, double top, double scale) {
  const auto both = [](Interval shown, Interval box) {
    const double lower = std::isfinite(box.lb) ? std::min(shown.lb, box.lb) : shown.lb;
    const double upper = std::isfinite(box.ub) ? std::max(shown.ub, box.ub) : shown.ub;
    return Interval{lower, upper};
  };
  return {kLeft, top, scale, both(section.x, section.box_x), both(section.y, section.box_y)};
}

}  // namespace

std::string to_svg(const CapabilityMap& map) {
  double span = 0.0;
  for (const Section& section : map.sections) span = std::max(span, section.x.ub - section.x.lb);
  for (const Section& section : map.sections) span = std::max(span, section.y.ub - section.y.lb);
  const double scale = span > 0.0 ? kScale * kSpan / span : kScale;
  const double tick = span > 2.0 ? 0.5 : (span > 0.8 ? 0.2 : 0.1);

  std::string body;
  Out out(body);
  double top = kTop, width = 0.0;
  for (const Section& section : map.sections) {
    Frame frame = make_frame(section, top, scale);
    Frame cells = frame;
    cells.left = frame.px(section.x.lb);
    cells.top = frame.py(section.y.ub);
    cells.y = section.y;
    draw_cells(section, cells, map.force_max, out);
    draw_axes(section, frame, tick, out);
    draw_box(section, frame, out);
    top += frame.height() + kGap;
    width = std::max(width, frame.left + frame.width());
  }
  if (!map.sections.empty()) draw_legend(width + 30, kTop, map.force_max, out);
  const double full_width = std::max(width + 30 + kLegend, 620.0);
  const double full_height = std::max(top, kTop + 340.0);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<style>.edge{{fill:none;stroke:#999}}.box{{fill:none;stroke:#d33;stroke-width:2;"
      "stroke-dasharray:6 3}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
      "<text x=\"{2:.0f}\" y=\"26\" font-size=\"16\" font-weight=\"bold\">{3}</text>\n"
      "<text x=\"{2:.0f}\" y=\"44\">Median of the postures that bring the handle there; joint "
      "ratings less gravity.</text>\n{4}</svg>\n",
      full_width, full_height, kLeft - 50, escaped(map.title), body);
}

}  // namespace hg::checks
