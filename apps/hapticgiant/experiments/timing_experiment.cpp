/// `hapticgiant experiment timing`: computation time of a cycle of the Cartesian admittance,
/// compared with section VII-A of the paper.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/docs_page.h"
#include "apps/hapticgiant/experiments/figure_program.h"
#include "apps/hapticgiant/experiments/html.h"
#include "apps/hapticgiant/experiments/paper_experiment_command.h"
#include "apps/hapticgiant/experiments/paper_experiments.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/run_setup.h"
#include "apps/hapticgiant/version.h"
#include "bench/cycle_table.h"
#include "bench/machine.h"
#include "hg/core/error.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

constexpr int kPasses = 2;
// [HG] VII-A: Intel Core i5-8600, 1 kHz, QuadProg++ below a cascade of problems
constexpr double kPaperMean_us = 529.0, kPaperP99_9_us = 616.0, kPaperMax_us = 707.0;
constexpr double kPaperSolver_percent = 92.6;

/// Results of one law at one rate.
struct Row {
  std::string law;
  double rate_Hz = 0.0;
  bench::CycleTimes times;

  double mean_us() const { return times.total.mean(); }
  double solver_percent() const {
    double whole = 0.0;
    for (const bench::Times& stage : times.stages) whole += stage.mean();
    return 100.0 * times.stages[static_cast<std::size_t>(Stage::kSolver)].mean() / whole;
  }
};

Row measure(const PaperExperimentArguments& arguments, const std::string& law, double rate_Hz) {
  RunArguments run;
  run.world.scenario = paper_experiment("cartesian").scenario;
  run.world.seed = arguments.seed;
  run.world.rate_Hz = rate_Hz;
  run.world.law = law;
  run.world.bounds = arguments.bounds;
  config::Scenario scenario = make_scenario(run);
  if (arguments.duration_s) scenario.duration_s = *arguments.duration_s;
  if (isatty(STDERR_FILENO) != 0) draw_error(fmt::format("law {}, {:.0f} Hz ...", law, rate_Hz));
  return {law, rate_Hz,
          bench::measure_cycle(scenario.title, scenario, kPasses, std::size_t{1} << 40U)};
}

Rows table(const std::vector<Row>& rows) {
  Rows text = {
      {"", "rate Hz", "mean us", "99.9 % us", "max us", "solver's share", "mean / period"}};
  text.push_back({"paper (Intel Core i5-8600)", "1000", fmt::format("{:.0f}", kPaperMean_us),
                  fmt::format("{:.0f}", kPaperP99_9_us), fmt::format("{:.0f}", kPaperMax_us),
                  fmt::format("{:.1f} %", kPaperSolver_percent),
                  fmt::format("{:.1f} %", kPaperMean_us * 1e-6 * 1000.0 * 100.0)});
  for (const Row& row : rows) {
    const analysis::Distribution d = row.times.total.distribution();
    text.push_back({"ours, law " + row.law, fmt::format("{:.0f}", row.rate_Hz),
                    fmt::format("{:.1f}", row.mean_us()), bench::to_text(d.p99_9, 1),
                    fmt::format("{:.1f}", d.max), fmt::format("{:.1f} %", row.solver_percent()),
                    fmt::format("{:.1f} %", 1e-4 * row.mean_us() * row.rate_Hz)});
  }
  return text;
}

std::string csv(const std::vector<Row>& rows) {
  std::string text = "law,rate_Hz,cycles,mean_us,median_us,p99_9_us,max_us,solver_percent\n";
  for (const Row& row : rows) {
    const analysis::Distribution d = row.times.total.distribution();
    text += fmt::format("{},{:g},{},{:.3f},{:.3f},{},{:.3f},{:.2f}\n", row.law, row.rate_Hz,
                        row.times.total.count(), row.mean_us(), d.median,
                        bench::to_text(d.p99_9, 3), d.max, row.solver_percent());
  }
  return text;
}

std::string histogram_csv(const std::vector<Row>& rows) {
  std::string text = "law,rate_Hz,from_us,to_us,cycles\n";
  for (const Row& row : rows) {
    for (const bench::Bin& bin : bench::histogram(row.times.total)) {
      text += fmt::format("{},{:g},{:.4g},{:.4g},{}\n", row.law, row.rate_Hz, bin.low, bin.high,
                          bin.count);
    }
  }
  return text;
}

Json histogram_data(const std::vector<Row>& rows, bool has_two_laws) {
  Json json = {{"kind", "timing"},
               {"note", ""},
               {"has_two_laws", has_two_laws},
               {"paper_us",
                {{"mean", kPaperMean_us}, {"99.9 %", kPaperP99_9_us}, {"maximum", kPaperMax_us}}},
               {"series", Json::array()}};
  for (const Row& row : rows) {
    Json series = {{"name", fmt::format("law {}, {:g} kHz", row.law, 1e-3 * row.rate_Hz)},
                   {"law", row.law},
                   {"rate_Hz", row.rate_Hz},
                   {"from_us", Json::array()},
                   {"share_percent", Json::array()}};
    const auto add = [&](double from_us, double share) {
      series["from_us"].push_back(from_us);
      series["share_percent"].push_back(share);
    };
    double end_us = 0.0;
    for (const bench::Bin& bin : bench::histogram(row.times.total)) {
      add(bin.low,
          100.0 * static_cast<double>(bin.count) / static_cast<double>(row.times.total.count()));
      end_us = bin.high;
    }
    add(end_us, 0.0);
    json["series"].push_back(series);
  }
  return json;
}

const char* how() {
  return "Each cycle of the Cartesian experiment is played twice and its faster time counts, so "
         "that "
         "what the system does in between does not show; the paper's figures are of one run under "
         "Preempt-RT. Both are computing time alone. The paper's mean time between two iterations, "
         "1003 us, is a matter of the system: see hapticgiant doctor.";
}

std::string report(const std::vector<Row>& rows, const fs::path& folder, const Json& machine) {
  std::string body =
      "<h1>Computing time of a cycle</h1>\n<p class=\"source\">Section VII-A of the "
      "paper</p>\n";
  body += fmt::format("<p>{}</p>\n", escaped(how()));
  body += html_table(table(rows));
  body += html_figure(folder / "figure.svg", "How long cycles compute, by law and rate.");
  body += "<h2>Machine</h2>\n";
  Rows facts = {{"", ""}};
  for (const auto& [name, value] : machine.items()) {
    facts.push_back({name, value.is_string() ? value.get<std::string>() : value.dump()});
  }
  return html_page("Computing time of a cycle", body + html_table(facts));
}

void check_rates(const std::vector<double>& rates_Hz) {
  for (const double rate_Hz : rates_Hz) {
    if (rate_Hz >= 100.0 && rate_Hz <= 20000.0) continue;
    throw SetupError(fmt::format("--rates: must be from 100 to 20000, got {:g}", rate_Hz));
  }
}

}  // namespace

int timing_experiment(const PaperExperimentArguments& arguments) {
  check_rates(arguments.rates_Hz);
  const fs::path folder = fs::path(arguments.out) / "timing";
  make_folder(folder.string());
  print_out(fmt::format("HapticGiant {}  computing time of a cycle\n\n", kVersion));

  const bool has_two_laws = arguments.law.empty() || arguments.law == "both";
  const std::vector<std::string> laws =
      has_two_laws ? std::vector<std::string>{"gauss", "paper"} : std::vector{arguments.law};
  std::vector<Row> rows;
  for (const double rate_Hz : arguments.rates_Hz) {
    for (const std::string& law : laws) rows.push_back(measure(arguments, law, rate_Hz));
  }
  if (isatty(STDERR_FILENO) != 0) draw_error("");

  print_out(markdown_table(table(rows)) + "\n");
  const Json machine = bench::describe_machine();
  write_output((folder / "timing.csv").string(), csv(rows));
  write_output((folder / "histogram.csv").string(), histogram_csv(rows));
  write_output((folder / "run.json").string(), histogram_data(rows, has_two_laws).dump(2) + "\n");
  if (const auto why = draw_figures(folder, {folder}); !why.empty()) print_out(why + "\n");
  write_output((folder / "report.html").string(), report(rows, folder, machine));
  if (!arguments.docs.empty()) {
    const std::string cut =
        arguments.duration_s ? fmt::format(" --duration {:g}", *arguments.duration_s) : "";
    std::string text =
        fmt::format("`hapticgiant experiment timing{}`, {}, {}. {}\n\n", cut,
                    machine["date"].get<std::string>(), machine["cpu"].get<std::string>(), how());
    refresh_page(arguments.docs, "timing", text + markdown_table(table(rows)),
                 folder / "figure.svg");
  }
  print_out(fmt::format("report      {}\n", (folder / "report.html").string()));
  return 0;
}

}  // namespace hg::apps
