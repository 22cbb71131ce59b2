#include "bench/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace hg::bench {
namespace {

// px
constexpr int kColumns = 2, kWidth = 440, kHeight = 244;
constexpr int kLeft = 62, kRight = 26, kTop = 44, kBottom = 36, kHead = 40;

// distinguishable with colour vision deficiency (Okabe, Ito)
constexpr std::array<const char*, 6> kColours = {"#0072b2", "#d55e00", "#009e73",
                                                 "#cc79a7", "#56b4e9", "#e69f00"};

// Outlines of 10 px around 0 0; where lines coincide, different ones show all.
constexpr std::array<const char*, 6> kMarkers = {"M-5,0A5,5 0 1 0 5,0A5,5 0 1 0 -5,0Z",
                                                 "M-3,-3H3V3H-3Z",
                                                 "M0,-5L5,4H-5Z",
                                                 "M0,-5L5,0L0,5L-5,0Z",
                                                 "M-4,-4L4,4M-4,4L4,-4",
                                                 "M-5,0H5M0,-5V5"};

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      result += c;
    }
  }
  return result;
}

// Whole decades from the smallest to the largest value.
struct Axis {
  int first = 0, last = 1;
  double begin, end;  ///< px

  double at(double value) const {
    return begin + (end - begin) * (std::log10(value) - first) / (last - first);
  }
};

void cover(const std::vector<double>& values, Axis& axis) {
  if (values.empty()) return;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  axis.first = static_cast<int>(std::floor(std::log10(*least)));
  axis.last = std::max(axis.first + 1, static_cast<int>(std::ceil(std::log10(*most) - 1e-9)));
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y,
                     anchor, more, escaped(text));
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return fmt::format(
      "<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind, x1,
      y1, x2, y2);
}

std::string tick(int decade) {
  return decade >= -2 && decade <= 5 ? fmt::format("{}", std::pow(10.0, decade))
                                     : fmt::format("1e{}", decade);
}

std::string grid(const Axis& x, const Axis& y) {
  std::string svg;
  for (int decade = x.first; decade <= x.last; ++decade) {
    const double at = x.at(std::pow(10.0, decade));
    svg += line(at, y.begin, at, y.end, "grid") + text_at(at, y.begin + 13, "middle", tick(decade));
    for (int k = 2; k < 10 && decade < x.last; ++k) {
      const double minor = x.at(k * std::pow(10.0, decade));
      svg += line(minor, y.begin, minor, y.begin - 3, "axis");
    }
  }
  for (int decade = y.first; decade <= y.last; ++decade) {
    const double at = y.at(std::pow(10.0, decade));
    svg +=
        line(x.begin, at, x.end, at, "grid") + text_at(x.begin - 5, at + 3.5, "end", tick(decade));
  }
  return svg + line(x.begin, y.begin, x.end, y.begin, "axis") +
         line(x.begin, y.begin, x.begin, y.end, "axis");
}

std::string marker(double x, double y, std::size_t place) {
  return fmt::format("<path stroke=\"{}\" d=\"{}\" transform=\"translate({:.1f} {:.1f})\"/>\n",
                     kColours[place % kColours.size()], kMarkers[place % kMarkers.size()], x, y);
}

std::string curve(const std::vector<std::pair<double, double>>& points, std::size_t place,
                  bool has_markers) {
  std::string svg =
      fmt::format("<polyline stroke=\"{}\" points=\"", kColours[place % kColours.size()]);
  for (const auto& [x, y] : points) svg += fmt::format("{:.1f},{:.1f} ", x, y);
  svg += "\"/>\n";
  if (!has_markers) return svg;
  for (const auto& [x, y] : points) svg += marker(x, y, place);
  return svg;
}

std::string draw(const Figure& figure, const Panel& panel, Axis x, Axis y, int left, int top) {
  x.begin = left + kLeft;
  x.end = left + kWidth - kRight;
  y.begin = top + kHeight - kBottom;
  y.end = top + kTop;
  std::string svg = text_at(x.begin, top + 20, "start", panel.title, " font-weight=\"bold\"");
  svg += grid(x, y);
  svg += text_at(0.5 * (x.begin + x.end), y.begin + 28, "middle", figure.x_label);
  const double middle = 0.5 * (y.begin + y.end);
  svg += text_at(left + 16, middle, "middle", figure.y_label,
                 fmt::format(" transform=\"rotate(-90 {} {:.1f})\"", left + 16, middle).c_str());
  constexpr double kSample = 16, kLetter = 5.8;  // px, of the line in the legend and its text
  double label = x.begin;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    if (series.points.empty()) continue;
    std::vector<std::pair<double, double>> points;
    for (const auto& [px, py] : series.points) points.emplace_back(x.at(px), y.at(py));
    svg += curve(points, i, figure.has_markers);

    const double row = top + 34.0;
    svg += curve({{label, row}, {label + kSample, row}}, i, false);
    if (figure.has_markers) svg += marker(label + 0.5 * kSample, row, i);
    svg += text_at(label + kSample + 4, row + 3.5, "start", series.label,
                   fmt::format(" fill=\"{}\"", kColours[i % kColours.size()]).c_str());
    label += kSample + 10 + kLetter * static_cast<double>(series.label.size());
  }
  return svg;
}

}  // namespace

Series outline(const std::string& label, const Times& times) {
  Series series = {label, {}};
  constexpr double kNone = 0.5;
  for (const Bin& bin : histogram(times)) {
    const double height = bin.count > 0 ? static_cast<double>(bin.count) : kNone;
    if (series.points.empty()) series.points.emplace_back(bin.low, kNone);
    series.points.emplace_back(bin.low, height);
    series.points.emplace_back(bin.high, height);
  }
  if (!series.points.empty()) series.points.emplace_back(series.points.back().first, kNone);
  return series;
}

std::string to_svg(const Figure& figure) {
  std::vector<double> xs, ys;
  std::vector<const Panel*> panels;
  for (const Panel& panel : figure.panels) {
    bool has_points = false;
    for (const Series& series : panel.series) {
      for (const auto& [x, y] : series.points) {
        xs.push_back(x);
        ys.push_back(y);
        has_points = true;
      }
    }
    if (has_points) panels.push_back(&panel);
  }
  Axis x, y;
  cover(xs, x);
  cover(ys, y);

  const int count = static_cast<int>(panels.size());
  const int width = kWidth * kColumns, height = kHead + kHeight * ((count + 1) / kColumns) + 8;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n"
      "<style>.grid {{stroke: #ddd}} .axis {{stroke: #333}} "
      "polyline, path {{fill: none; stroke-width: 1.4; stroke-linejoin: round}}</style>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
      width, height);
  svg += text_at(kLeft, 24, "start", figure.title, " font-size=\"14\"");
  for (int i = 0; i < count; ++i) {
    svg += draw(figure, *panels[static_cast<std::size_t>(i)], x, y, kWidth * (i % kColumns),
                kHead + kHeight * (i / kColumns));
  }
  return svg + "</svg>\n";
}

}  // namespace hg::bench
