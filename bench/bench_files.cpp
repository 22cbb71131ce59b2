#include "bench/bench_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <string_view>

#include "bench/figures.h"
#include "hg/core/whole_file.h"

namespace hg::bench {
namespace {

using nlohmann::ordered_json;

template <typename Item>
ordered_json rows_of(const std::vector<Item>& items) {
  ordered_json rows = ordered_json::array();
  for (const Item& item : items) {
    const ordered_json row = to_json(item);
    if (row.is_array()) {
      rows.insert(rows.end(), row.begin(), row.end());
    } else {
      rows.push_back(row);
    }
  }
  return rows;
}

std::string cell(const ordered_json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// Parts of parts become columns of their own, lists one text.
void flatten(const std::string& prefix, const ordered_json& value, ordered_json& flat) {
  if (value.is_object()) {
    for (const auto& [key, part] : value.items()) {
      flatten(prefix.empty() ? key : prefix + "_" + key, part, flat);
    }
  } else if (value.is_array()) {
    flat[prefix] = fmt::format("{}", fmt::join(value.get<std::vector<std::string>>(), " "));
  } else {
    flat[prefix] = value;
  }
}

ordered_json flat_rows(const ordered_json& rows) {
  ordered_json result = ordered_json::array();
  for (const ordered_json& row : rows) {
    ordered_json flat = ordered_json::object();
    flatten("", row, flat);
    result.push_back(flat);
  }
  return result;
}

void add_bins(const char* group, const std::string& name, const char* kind, const std::string& what,
              const bench::Times& times, ordered_json& rows) {
  for (const bench::Bin& bin : bench::histogram(times)) {
    rows.push_back({{group, name},
                    {kind, what},
                    {"low_us", bin.low},
                    {"high_us", bin.high},
                    {"count", bin.count}});
  }
}

ordered_json solver_bins(const BenchResults& results) {
  ordered_json rows = ordered_json::array();
  for (const bench::SolverSet& set : results.solver) {
    for (const bench::SolverRun& run : set.runs) {
      add_bins("set", set.name, "solver", std::string(run.solver), run.times, rows);
    }
  }
  return rows;
}

ordered_json cycle_bins(const BenchResults& results) {
  ordered_json rows = ordered_json::array();
  for (const bench::CycleTimes& times : results.cycles) {
    add_bins("scenario", times.scenario, "stage", "total", times.total, rows);
    for (std::size_t i = 0; i < times.stages.size(); ++i) {
      add_bins("scenario", times.scenario, "stage", to_string(static_cast<Stage>(i)),
               times.stages[i], rows);
    }
  }
  return rows;
}

bench::Figure solver_figure(const BenchResults& results) {
  bench::Figure figure = {"Time of the solver", "µs per problem", "problems", {}};
  for (const bench::SolverSet& set : results.solver) {
    bench::Panel panel = {
        fmt::format("{} (n = {}, {} levels)", set.name, set.variables, set.levels), {}};
    for (const std::string_view solver : {"warm", "cold", "cascade"}) {
      bench::Series series;
      for (const bench::SolverRun& run : set.runs) {
        if (run.solver == solver) series = bench::outline(std::string(solver), run.times);
      }
      panel.series.push_back(series);
    }
    figure.panels.push_back(panel);
  }
  return figure;
}

bench::Figure cycle_figure(const BenchResults& results) {
  bench::Figure figure = {
      "Time of Cycle::step and its longest stages, law gauss", "µs", "cycles", {}};
  for (const bench::CycleTimes& times : results.cycles) {
    bench::Panel panel = {times.scenario, {bench::outline("Cycle::step", times.total)}};
    for (const Stage stage : {Stage::kSolver, Stage::kRenderingSetUp, Stage::kReactions}) {
      panel.series.push_back(
          bench::outline(to_string(stage), times.stages[static_cast<std::size_t>(stage)]));
    }
    figure.panels.push_back(panel);
  }
  return figure;
}

bench::Figure growth_figure(const BenchResults& results) {
  bench::Figure figure = {"Growth on random problems, median", "variables", "µs", {}, true};
  for (const bool is_warm : {false, true}) {
    std::map<int, bench::Series> by_levels;
    for (const bench::GrowthRow& row : results.growth) {
      bench::Series& series = by_levels[row.levels];
      series.label = fmt::format("{} level{}", row.levels, row.levels > 1 ? "s" : "");
      series.points.emplace_back(row.variables,
                                 (is_warm ? row.warm : row.cold).distribution().median);
    }
    bench::Panel panel = {is_warm ? "warm, after a small change" : "cold", {}};
    for (const auto& [levels, series] : by_levels) panel.series.push_back(series);
    figure.panels.push_back(panel);
  }
  return figure;
}

}  // namespace

ordered_json to_json(const BenchResults& results) {
  return {{"version", results.machine.at("version")},
          {"machine", results.machine},
          {"solver", rows_of(results.solver)},
          {"cycle", rows_of(results.cycles)},
          {"growth", rows_of(results.growth)},
          {"growth_exponents", rows_of(results.exponents)},
          {"runs", rows_of(results.laws)}};
}

std::string to_csv(const ordered_json& rows) {
  if (rows.empty()) return "";
  std::string text;
  for (const auto& [key, value] : rows.front().items()) text += (text.empty() ? "" : ",") + key;
  text += "\n";
  for (const ordered_json& row : rows) {
    std::string line;
    for (const auto& [key, value] : row.items()) {
      if (&value != &row.begin().value()) line += ",";
      line += cell(value);
    }
    text += line + "\n";
  }
  return text;
}

void check_folder(const std::string& folder) {
  if (folder.empty()) return;
  make_folder(folder);
  check_writable((std::filesystem::path(folder) / "machine.txt").string());
}

void write_files(const std::string& folder, const BenchResults& results) {
  const auto write = [&](const char* name, const std::string& text) {
    write_whole_file((std::filesystem::path(folder) / name).string(), text);
  };
  std::string machine;
  for (const auto& [key, value] : results.machine.items()) {
    machine += fmt::format("{}: {}\n", key, cell(value));
  }
  write("machine.txt", machine);
  write("solver.csv", to_csv(rows_of(results.solver)));
  write("solver_histogram.csv", to_csv(solver_bins(results)));
  write("solver_histogram.svg", bench::to_svg(solver_figure(results)));
  write("cycle.csv", to_csv(rows_of(results.cycles)));
  write("cycle_histogram.csv", to_csv(cycle_bins(results)));
  write("cycle_histogram.svg", bench::to_svg(cycle_figure(results)));
  write("growth.csv", to_csv(rows_of(results.growth)));
  write("growth_exponents.csv", to_csv(rows_of(results.exponents)));
  write("growth.svg", bench::to_svg(growth_figure(results)));
  write("laws.csv", to_csv(flat_rows(rows_of(results.laws))));
}

}  // namespace hg::bench
