#include "apps/hapticgiant/haptify_report.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "apps/hapticgiant/experiments/html.h"
#include "apps/hapticgiant/haptify_method.h"
#include "apps/hapticgiant/version.h"
#include "hg/studies/haptify/goals.h"

namespace hg::apps {
namespace {

using haptify::Benchmark;
using haptify::Figure;
using Rows = std::vector<std::vector<std::string>>;

std::string given(double value) { return std::isnan(value) ? "-" : fmt::format("{:g}", value); }

std::string measured(const Figure& figure) {
  if (!figure.is_measured()) return "not measured";
  const haptify::Mean mean = figure.mean();
  std::string text = fmt::format("{:.{}f}", mean.value, figure.digits);
  if (mean.count > 1) text += fmt::format(" +- {:.{}f}", mean.half_width, figure.digits);
  return text;
}

Rows table_rows(const Benchmark& result) {
  Rows rows = {{"", "unit", "ours, simulated", "HapticGiant, paper, real", "Touch, real",
                "Touch X, real", "goal", "met"}};
  for (const Figure& figure : result.table) {
    const haptify::Published& other = figure.published;
    rows.push_back({figure.name, figure.unit, measured(figure), given(other.paper),
                    given(other.touch), given(other.touch_x), haptify::to_text(figure.goal),
                    !figure.is_measured() || !figure.goal.bounded() ? "-"
                    : figure.meets_goal()                           ? "yes"
                                                                    : "no"});
  }
  return rows;
}

Rows beyond_rows(const Benchmark& result) {
  Rows rows = {{"", "unit", "ours, simulated", "conditions"}};
  for (const Figure& figure : result.beyond) {
    rows.push_back({figure.name, figure.unit, measured(figure), figure.note});
  }
  return rows;
}

Rows rows_of(const haptify::Table& table) {
  Rows rows = {table.columns};
  rows.insert(rows.end(), table.rows.begin(), table.rows.end());
  return rows;
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

std::string facts(const Benchmark& result, const std::string& command) {
  return fmt::format("`{}`, version {}, simulated {}.", command, kVersion, result.device);
}

// fields with a comma or a quote in quotes
std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (!line.empty() || &field != &fields.front()) line += ",";
    if (field.find_first_of(",\"\n") == std::string::npos) {
      line += field;
      continue;
    }
    line += '"';
    for (const char c : field) line += c == '"' ? "\"\"" : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

std::string number(double value) { return std::isnan(value) ? "" : fmt::format("{:.6g}", value); }

std::string latex_unit(std::string_view unit) {
  if (unit == "m^3") return "m$^3$";
  if (unit == "m/s^2") return "m\\,s$^{-2}$";
  if (unit == "%") return "\\%";
  return std::string(unit);
}

std::string latex_number(std::string text) {
  if (const std::size_t at = text.find("+-"); at != std::string::npos) text.replace(at, 2, "\\pm");
  return text == "-" || text == "not measured" ? text : "$" + text + "$";
}

}  // namespace

std::string goals_text(const Benchmark& goals) {
  std::string text;
  for (const std::vector<std::string>& row : rows_of(haptify::goals_table(goals))) {
    text += fmt::format("{:<38}{:<7}{:>10}{:>9}{:>9}{:>9}{:>14}\n", row[0], row[1], row[2], row[3],
                        row[4], row[5], row[6]);
  }
  text += fmt::format("\n{}\n", kRealAndSimulated);
  for (const std::string& failure : goals.failures) text += fmt::format("\nFAILED  {}\n", failure);
  return text;
}

std::string goals_markdown(const Benchmark& goals, const std::string& command) {
  std::string text = facts(goals, command) + "\n\n";
  for (const std::string& failure : goals.failures) text += "**Failed: " + failure + "**\n\n";
  return text + markdown_table(rows_of(haptify::goals_table(goals)));
}

std::string haptify_text(const Benchmark& result) {
  std::string text;
  const auto line = [&](const std::vector<std::string>& cells) {
    text += fmt::format("{:<40}{:<7}{:>18}{:>9}{:>9}{:>9}{:>12}{:>5}\n", cells[0], cells[1],
                        cells[2], cells[3], cells[4], cells[5], cells[6], cells[7]);
  };
  line({"", "", "ours, simulated", "paper", "Touch", "Touch X", "goal", "met"});
  const Rows rows = table_rows(result);
  for (std::size_t i = 1; i < rows.size(); ++i) line(rows[i]);
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

std::string haptify_html(const Benchmark& result, const std::string& command) {
  std::string body = "<h1>Haptify</h1>\n<p class=\"source\">Table III of the paper</p>\n";
  const auto paragraph = [&](const std::string& text, const char* style) {
    body += fmt::format("<p{}>{}</p>\n", style, escaped(text));
  };
  for (const std::string& failure : result.failures) {
    paragraph("Failed: " + failure, " class=\"bad\"");
  }
  paragraph(std::string(kRealAndSimulated), "");
  body += html_table(table_rows(result));
  paragraph(
      "Mean and half width of the 95 % confidence interval of repetitions with other seeds: "
      "of noise, sensor errors, tremor and the person's way.",
      "");
  body += "<h2>Goals that are missed</h2>\n";
  const std::vector<std::string> sentences = missed(result);
  if (sentences.empty()) paragraph("None.", "");
  for (const std::string& sentence : sentences) paragraph(sentence, "");
  body += "<h2>Beyond the paper</h2>\n" + html_table(beyond_rows(result));
  for (const haptify::Table& table : result.tables) {
    body += fmt::format("<h2>{}</h2>\n", escaped(table.title));
    paragraph(table.note, "");
    body += html_table(rows_of(table));
  }
  body += "<h2>How it is measured, and what differs from the real protocol</h2>\n";
  for (const std::string& text : method_of(result)) paragraph(text, "");
  paragraph(facts(result, command), " class=\"source\"");
  return html_page("Haptify", body);
}

std::string haptify_markdown(const Benchmark& result, const std::string& command) {
  std::string text = fmt::format("{}\n\n**{}**\n\n", facts(result, command), kRealAndSimulated);
  for (const std::string& failure : result.failures) text += "**Failed: " + failure + "**\n\n";
  text += markdown_table(table_rows(result));
  text += "\nMean and half width of the 95 % confidence interval.\n\n## Goals that are missed\n\n";
  const std::vector<std::string> sentences = missed(result);
  if (sentences.empty()) text += "None.\n";
  for (const std::string& sentence : sentences) text += "- " + sentence + "\n";
  text += "\n## Beyond the paper\n\n" + markdown_table(beyond_rows(result));
  for (const haptify::Table& table : result.tables) {
    text +=
        fmt::format("\n## {}\n\n{}\n\n{}", table.title, table.note, markdown_table(rows_of(table)));
  }
  text += "\n## How it is measured, and what differs from the real protocol\n\n";
  for (const std::string& sentence : method_of(result)) text += "- " + sentence + "\n";
  return text;
}

std::string haptify_latex(const Benchmark& result) {
  std::string text = fmt::format(
      "% {}\n% needs the package booktabs\n"
      "\\begin{{tabular}}{{llrrrr}}\n\\toprule\n"
      "Metric & Unit & Ours (simulated) & HapticGiant (real) & Touch (real) & Touch X (real) \\\\\n"
      "\\midrule\n",
      kRealAndSimulated);
  for (const Figure& figure : result.table) {
    text += fmt::format("{} & {} & {} & {} & {} & {} \\\\\n", figure.name, latex_unit(figure.unit),
                        latex_number(measured(figure)), latex_number(given(figure.published.paper)),
                        latex_number(given(figure.published.touch)),
                        latex_number(given(figure.published.touch_x)));
  }
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string haptify_csv(const Benchmark& result) {
  std::string text =
      "id,name,unit,mean,half_width_95,repetitions,paper,touch,touch_x,goal_min,goal_max\n";
  for (const auto* figures : {&result.table, &result.beyond}) {
    for (const Figure& figure : *figures) {
      const haptify::Mean mean = figure.mean();
      const haptify::Published& other = figure.published;
      const auto end = [](double value) { return std::isfinite(value) ? number(value) : ""; };
      text += csv_line({figure.id, figure.name, figure.unit, number(mean.value),
                        number(mean.half_width), std::to_string(mean.count), number(other.paper),
                        number(other.touch), number(other.touch_x), end(figure.goal.lb),
                        end(figure.goal.ub)});
    }
  }
  return text;
}

std::string repetitions_csv(const Benchmark& result) {
  std::string text = "id,unit,repetition,value\n";
  for (const auto* figures : {&result.table, &result.beyond}) {
    for (const Figure& figure : *figures) {
      for (std::size_t i = 0; i < figure.values.size(); ++i) {
        text += csv_line({figure.id, figure.unit, std::to_string(i + 1), number(figure.values[i])});
      }
    }
  }
  return text;
}

std::string table_csv(const haptify::Table& table) {
  std::string text = csv_line(table.columns);
  for (const std::vector<std::string>& row : table.rows) text += csv_line(row);
  return text;
}

}  // namespace hg::apps
