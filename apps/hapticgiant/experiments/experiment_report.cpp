#include "apps/hapticgiant/experiments/experiment_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/condition_text.h"
#include "apps/hapticgiant/experiments/html.h"
#include "apps/hapticgiant/version.h"

namespace hg::apps {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

std::string expected_text(const EventResult& event) {
  return event.window == nullptr
             ? "in this order"
             : fmt::format("{:.1f} .. {:.1f} s", event.window_from_s, event.window_to_s);
}

std::string found_text(const EventResult& event) {
  if (!event.found_s) return "MISSING";
  return fmt::format("{:.3f} s{}", *event.found_s, event.is_as_expected() ? "" : ", NOT THERE");
}

// without the law where there are two
std::string common_note(const std::vector<ReportedRun>& runs) {
  const std::string note = run_note(runs.front().result);
  return runs.size() == 1 ? note : note.substr(note.find(", ") + 2);
}

Rows event_rows(const std::vector<ReportedRun>& runs) {
  Rows rows = {{"event", "condition", "expected"}};
  for (const ReportedRun& run : runs) rows.front().push_back("found, law " + run.law);
  const ExperimentResult& first = runs.front().result;
  for (std::size_t i = 0; i < first.events.size(); ++i) {
    const EventResult& event = first.events[i];
    rows.push_back({paper_label(*event.rule), condition_text(*event.rule, *first.scenario),
                    expected_text(event)});
    for (const ReportedRun& run : runs) rows.back().push_back(found_text(run.result.events[i]));
  }
  return rows;
}

Rows statement_rows(const std::vector<ReportedRun>& runs) {
  Rows rows = {{"", "paper (real machine)"}};
  for (const ReportedRun& run : runs) rows.front().push_back("simulated, law " + run.law);
  const std::vector<Statement>& first = runs.front().statements;
  for (std::size_t i = 0; i < first.size(); ++i) {
    rows.push_back({first[i].what, first[i].paper.empty() ? "-" : first[i].paper});
    for (const ReportedRun& run : runs) rows.back().push_back(run.statements[i].ours);
  }
  return rows;
}

// "elbow x 0.12 mm": the limit that was exceeded most
std::string worst_text(const Json& limits) {
  std::string text = "none";
  double worst = 0.0;
  for (const auto& [name, limit] : limits.items()) {
    const double value = limit["worst_violation"].get<double>();
    if (value <= worst) continue;
    worst = value;
    text =
        fmt::format("{} by {:.3f} {}", name, 1e3 * value, limit["unit"] == "rad" ? "mrad" : "mm");
  }
  return text;
}

Rows figure_rows(const std::vector<ReportedRun>& runs) {
  Rows rows = {{""},
               {"limits exceeded by the reference (allowed: 2 mm, 5 mrad)"},
               {"limits exceeded in truth (allowed: 1 mm, 2 mrad)"},
               {"user's force, mean / largest"},
               {"active-set changes per second"},
               {"problems solved / not"}};
  for (const ReportedRun& run : runs) {
    const Json& summary = run.result.summary;
    const Json& status = summary["solver"]["status"];
    std::uint64_t unsolved = 0;
    for (const auto& [name, count] : status.items()) {
      if (name != "solved" && name != "not run") unsolved += count.get<std::uint64_t>();
    }
    rows[0].push_back("law " + run.law);
    rows[1].push_back(worst_text(summary["limits"]));
    rows[2].push_back(summary.contains("reality") ? worst_text(summary["reality"]["limits"]) : "-");
    rows[3].push_back(fmt::format("{:.1f} / {:.1f} N", summary["force"]["mean_N"].get<double>(),
                                  summary["force"]["max_N"].get<double>()));
    rows[4].push_back(
        fmt::format("{:.1f}", summary["solver"]["active_set_changes_per_second"].get<double>()));
    rows[5].push_back(fmt::format("{} / {}", status.value("solved", std::uint64_t{0}), unsolved));
  }
  return rows;
}

std::string verdict_html(const std::vector<ReportedRun>& runs) {
  std::string html;
  for (const ReportedRun& run : runs) {
    if (run.result.failures.empty()) {
      html += fmt::format("<p class=\"good\">Law {}: all {} events as expected, limits held.</p>\n",
                          run.law, run.result.events.size());
    }
    for (const std::string& failure : run.result.failures) {
      html += fmt::format("<p class=\"bad\">Law {}: {}</p>\n", run.law, escaped(failure));
    }
  }
  return html;
}

}  // namespace

std::string run_note(const ExperimentResult& result) {
  return fmt::format(
      "law {}, {} bounds, seed {}, {:g} Hz, simulated {}", result.summary["law"].get<std::string>(),
      result.summary["bounds"].get<std::string>(), result.summary["seed"].get<std::uint64_t>(),
      result.summary["rate_Hz"].get<double>(), result.scenario->device.name);
}

Json events_json(const ReportedRun& run) {
  const ExperimentResult& result = run.result;
  Json json = {{"experiment", result.experiment->name}, {"scenario", result.summary["scenario"]},
               {"law", result.summary["law"]},          {"bounds", result.summary["bounds"]},
               {"seed", result.summary["seed"]},        {"events", Json::array()}};
  for (const EventResult& event : result.events) {
    Json entry = {{"label", paper_label(*event.rule)},
                  {"name", event.rule->name},
                  {"what", event.rule->what},
                  {"condition", condition_text(*event.rule, *result.scenario)},
                  {"all_of", condition_json(*event.rule, *result.scenario)}};
    if (event.window != nullptr) {
      entry["expected"] = {{"from_s", event.window_from_s},
                           {"to_s", event.window_to_s},
                           {"because", event.window->because}};
    }
    entry["found_s"] = event.found_s ? Json(*event.found_s) : Json(nullptr);
    entry["is_as_expected"] = event.is_as_expected();
    json["events"].push_back(entry);
  }
  return json;
}

Json results_json(const ReportedRun& run) {
  Json json = {{"experiment", run.result.experiment->name},
               {"source", run.result.experiment->source},
               {"is_as_expected", run.result.failures.empty()},
               {"failures", run.result.failures}};
  for (const Statement& statement : run.statements) {
    json["statements"].push_back({{"what", statement.what},
                                  {"paper_real_machine", statement.paper},
                                  {"ours_simulated", statement.ours}});
  }
  json["summary"] = run.result.summary;
  return json;
}

std::string report_html(const std::vector<ReportedRun>& runs, const std::filesystem::path& folder,
                        const std::string& command) {
  const PaperExperiment& experiment = *runs.front().result.experiment;
  std::string body = fmt::format(
      "<h1>{}</h1>\n<p class=\"source\">{} of the paper; {}</p>\n<p>{}</p>\n", experiment.title,
      experiment.source, escaped(common_note(runs)), experiment.about);
  body += verdict_html(runs);
  body += html_figure(
      folder / "figure.svg",
      fmt::format("{}, as {} of the paper, from a simulated machine. Events are marked, limits are "
                  "dotted{}.",
                  experiment.title, experiment.source,
                  experiment.name == "door" ? ", shaded while the door is locked" : ""));
  body += "<h2>Events</h2>\n" + html_table(event_rows(runs));
  body += "<h2>Beside the paper</h2>\n" + html_table(statement_rows(runs));
  body += fmt::format("<p>{}</p>\n", escaped(experiment.comment));
  body += "<h2>The run as a whole</h2>\n" + html_table(figure_rows(runs));
  body += fmt::format(
      "<p class=\"source\">HapticGiant {}. Again: <code>{}</code>. Beside this page: "
      "recording.mcap, "
      "events.json, results.json, signals.csv, figure.svg, figure.png; times of computation in "
      "timing.json.</p>\n",
      kVersion, escaped(command));
  return html_page(std::string(experiment.title), body);
}

std::string report_markdown(const std::vector<ReportedRun>& runs, const std::string& command) {
  std::string text = fmt::format("`{}`; {}.\n\n### Events\n\n", command, common_note(runs));
  text += markdown_table(event_rows(runs));
  text +=
      "\n### Beside the paper\n\nThe paper's column comes from a real machine, ours from a "
      "simulated one.\n\n";
  text += markdown_table(statement_rows(runs));
  text += "\n### The run as a whole\n\n" + markdown_table(figure_rows(runs));
  return text;
}

}  // namespace hg::apps
