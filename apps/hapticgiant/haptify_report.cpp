#include "apps/hapticgiant/haptify_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "apps/hapticgiant/version.h"
#include "hg/studies/haptify/goals.h"

namespace hg::apps {
namespace {

using haptify::Benchmark;
using haptify::Figure;
using nlohmann::ordered_json;

constexpr std::string_view kRealAndSimulated =
    "The paper's HapticGiant, Touch and Touch X were real machines in real hands; ours is a "
    "simulated machine with assumed friction, noise and delays in a simulated hand.";

std::string given(double value) { return std::isnan(value) ? "-" : fmt::format("{:g}", value); }

std::string measured(const Figure& figure) {
  if (!figure.is_measured()) return "not measured";
  const haptify::Mean mean = figure.mean();
  std::string text = fmt::format("{:.{}f}", mean.value, figure.digits);
  if (mean.count > 1) text += fmt::format(" +- {:.{}f}", mean.half_width, figure.digits);
  return text;
}

std::string met(const Figure& figure) {
  if (!figure.is_measured() || !figure.goal.bounded()) return "-";
  return figure.meets_goal() ? "yes" : "no";
}

// "Mean free-space force: 1.1 instead of <= 0.7 N. ..."
std::vector<std::string> missed(const Benchmark& result) {
  std::vector<std::string> sentences;
  for (const Figure& figure : result.table) {
    if (!figure.is_measured() || figure.meets_goal()) continue;
    sentences.push_back(fmt::format("{}: {} instead of {} {}. {}", figure.name, measured(figure),
                                    haptify::to_text(figure.goal), figure.unit,
                                    figure.why.empty() ? "The reason is not known." : figure.why));
  }
  return sentences;
}

// null for what JSON has no number for
ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json json_of(const Figure& figure) {
  const haptify::Mean mean = figure.mean();
  const haptify::Published& other = figure.published;
  return {{"id", figure.id},
          {"name", figure.name},
          {"unit", figure.unit},
          {"digits", figure.digits},
          {"mean", figure.is_measured() ? number(mean.value) : nullptr},
          {"half_width_95", number(mean.half_width)},
          {"values", figure.values},
          {"measured", measured(figure)},
          {"paper", number(other.paper)},
          {"touch", number(other.touch)},
          {"touch_x", number(other.touch_x)},
          {"goal", haptify::to_text(figure.goal)},
          {"goal_min", number(figure.goal.lb)},
          {"goal_max", number(figure.goal.ub)},
          {"met", met(figure)},
          {"note", figure.note},
          {"why", figure.why}};
}

ordered_json json_of(const haptify::Table& table) {
  return {{"id", table.id},
          {"title", table.title},
          {"note", table.note},
          {"columns", table.columns},
          {"rows", table.rows}};
}

ordered_json json_of(const haptify::Curve& curve) {
  return {{"id", curve.id},
          {"name", curve.name},
          {"x_label", curve.x_label},
          {"x", curve.x},
          {"y", curve.y}};
}

ordered_json json_of(const haptify::View& view) {
  ordered_json box = ordered_json::array();
  for (const double side : view.box) box.push_back(number(side));
  return {
      {"across", view.across}, {"up", view.up},     {"left", view.left}, {"bottom", view.bottom},
      {"cell", view.cell},     {"rows", view.rows}, {"box", box}};
}

template <typename Item>
ordered_json json_of(const std::vector<Item>& items) {
  ordered_json json = ordered_json::array();
  for (const Item& item : items) json.push_back(json_of(item));
  return json;
}

}  // namespace

std::string goals_text(const Benchmark& goals) {
  std::string text;
  const haptify::Table table = haptify::goals_table(goals);
  const auto add = [&](const std::vector<std::string>& row) {
    text += fmt::format("{:<38}{:<7}{:>10}{:>9}{:>9}{:>9}{:>14}\n", row[0], row[1], row[2], row[3],
                        row[4], row[5], row[6]);
  };
  add(table.columns);
  for (const std::vector<std::string>& row : table.rows) add(row);
  text += fmt::format("\n{}\n", kRealAndSimulated);
  for (const std::string& failure : goals.failures) text += fmt::format("\nFAILED  {}\n", failure);
  return text;
}

std::string haptify_text(const Benchmark& result) {
  std::string text;
  const auto line = [&](const std::string& name, const auto&... cells) {
    text += fmt::format("{:<40}{:<7}{:>18}{:>9}{:>9}{:>9}{:>12}{:>5}\n", name, cells...);
  };
  line("", "", "ours, simulated", "paper", "Touch", "Touch X", "goal", "met");
  for (const Figure& figure : result.table) {
    const haptify::Published& other = figure.published;
    line(figure.name, figure.unit, measured(figure), given(other.paper), given(other.touch),
         given(other.touch_x), haptify::to_text(figure.goal), met(figure));
  }
  text += "\n";
  for (const Figure& figure : result.beyond) {
    text += fmt::format("{:<60}{:>18} {}\n", figure.name, measured(figure), figure.unit);
  }
  text += fmt::format("\n{}\n", kRealAndSimulated);
  for (const std::string& sentence : missed(result)) text += "\n" + sentence + "\n";
  for (const std::string& failure : result.failures) {
    text += fmt::format("\nFAILED  {}\n", failure);
  }
  return text;
}

ordered_json results_json(const Benchmark& result, const std::string& kind,
                          const std::string& command) {
  ordered_json json = {{"kind", kind},
                       {"version", kVersion},
                       {"command", command},
                       {"device", result.device},
                       {"seed", result.options.seed},
                       {"repetitions", result.options.repetitions},
                       {"is_quick", result.options.is_quick},
                       {"real_and_simulated", kRealAndSimulated},
                       {"failures", result.failures}};
  json["table"] = json_of(result.table);
  json["beyond"] = json_of(result.beyond);
  json["tables"] =
      json_of(kind == "goals" ? std::vector{haptify::goals_table(result)} : result.tables);
  json["curves"] = json_of(result.curves);
  json["workspace"] = json_of(result.workspace);
  return json;
}

}  // namespace hg::apps
