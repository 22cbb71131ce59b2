#include "apps/offline/recording_commands.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/offline/run_data.h"
#include "apps/offline/subcommand.h"
#include "hg/analysis/summary.h"
#include "hg/core/error.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct PlotArguments {
  std::vector<std::string> files;
  std::string out = "plots";
};

struct CompareArguments {
  std::string a, b;
};

constexpr double kTick_s = 1e-7;  // times are whole cycles up to rounding

// Collects the configuration until the first sample, which needs it.
class Reader final : public recording::RecordingListener {
 public:
  /// Keeps the columns `names` of the first sample in every `period_s`; 0 = of all.
  Reader(const std::vector<std::string>& names, double period_s)
      : columns_(names), period_s_(period_s) {}

  void configuration(const recording::NamedText& text) override {
    if (!scenario_) configuration_.push_back(text);
  }
  void event(const recording::Event& event) override {
    events_.push_back({{"name", event.name}, {"what", event.text}, {"time_s", event.time_s}});
  }
  void sample(const Sample& sample) override {
    if (!scenario_) {
      scenario_.emplace(scenario::recorded_scenario(configuration_));
      summary_.emplace(scenario::make_summary(*scenario_));
    }
    summary_->add(sample);
    if (sample.record.time_s < due_s_ - kTick_s) return;
    due_s_ = sample.record.time_s + period_s_;
    columns_.append(sample);
  }

  // What python/hapticgiant/report/runs.py reads of the recording, besides its columns.
  Json facts(const std::string& file, const char* kind, const recording::ReadResult& read) const {
    Json run = describe(*scenario_);
    run["kind"] = kind;
    run["note"] = fs::weakly_canonical(file).filename().string();
    run["file"] = file;
    run["is_complete"] = read.is_complete;
    run["losses"] = recording::to_text(read.losses);
    run["events"] = events_;
    run["expected"] = Json::array();
    for (const EventRule& rule : scenario_->events) {
      run["expected"].push_back(describe(rule, *scenario_));
    }
    for (const recording::NamedText& text : configuration_) {
      run["configuration"][text.name] = text.text;
    }
    analysis::RunFacts known = scenario::facts_of_scenario(*scenario_);
    known.rate_Hz = scenario_->device.model.rate_Hz;
    run["summary"] = summary_->to_json(known, {});
    return run;
  }

  const recording::Columns& columns() const noexcept { return columns_; }

  // The columns by their names; each has one whole number of 8 bytes per row.
  Json whole_numbers() const {
    Json numbers = Json::object();
    for (const recording::Column& column : columns_.all()) {
      if (!column.is_kept) continue;
      std::vector<std::uint64_t> values(column.data.size() / sizeof(std::uint64_t));
      std::memcpy(values.data(), column.data.data(), values.size() * sizeof(std::uint64_t));
      numbers[column.name] = values;
    }
    return numbers;
  }

 private:
  recording::Columns columns_;
  double period_s_, due_s_ = 0.0;
  std::vector<recording::NamedText> configuration_;
  std::optional<config::Scenario> scenario_;
  std::optional<analysis::Summary> summary_;
  Json events_ = Json::array();
};

// Without matplotlib only run.json and signals.npy are written, and a line says how to get
// figures.
int plot(const PlotArguments& arguments) {
  constexpr double kFigurePeriod_s = 0.01;
  const fs::path out = arguments.out;
  std::vector<fs::path> runs;
  for (const std::string& file : arguments.files) {
    // one run: into the folder itself; of several each has a folder of its own
    const std::string name = fmt::format("{}_{}", runs.size() + 1, fs::path(file).stem().string());
    runs.push_back(arguments.files.size() == 1 ? out : out / name);
    Reader reader(signal_names(), kFigurePeriod_s);
    const recording::ReadResult read = recording::read_recording(file, reader);
    make_folder(runs.back().string());
    write_run(runs.back(), reader.facts(file, "any", read), reader.columns());
  }
  Json folders = Json::array();
  for (const fs::path& run : runs) folders.push_back(fs::absolute(run).string());
  const auto signals_in = [&](const char* name) {
    return fmt::format("signals     {}\n", (runs.front() / name).string());
  };
  try {
    check_report_program();
  } catch (const SetupError& error) {
    print_out(fmt::format("no figures: {}\n{}", error.what(), signals_in("signals.npy")));
    return 0;
  }
  return become_reports(
      {{.results = {{"kind", "any"}, {"runs", folders}},
        .folder = arguments.out,
        .last_line = fmt::format("figures     {0}/figure.svg, {0}/figure.png\n{1}", arguments.out,
                                 signals_in("signals.csv"))}});
}

int compare(const CompareArguments& arguments) {
  check_report_program();
  Json results = {{"kind", "compare"}};
  for (const std::string& file : {arguments.a, arguments.b}) {
    Reader reader({"cycle", "state_hash"}, 0.0);
    const recording::ReadResult read = recording::read_recording(file, reader);
    results["runs"].push_back(
        {{"facts", reader.facts(file, "compare", read)}, {"columns", reader.whole_numbers()}});
  }
  return become_reports({{.results = results}});
}

}  // namespace

void add_plot_and_compare(Command app, int& exit_code) {
  const auto plotted = std::make_shared<PlotArguments>();
  const Command plot = add_offline(app, "plot");
  plot.footer(
      "Examples:\n"
      "  hapticgiant plot recordings/latest.mcap\n"
      "  hapticgiant plot one.mcap two.mcap --out figures");
  plot.add_option("files", plotted->files, "recordings, one to four")
      .required()
      .expected(1, 4)
      .existing_file();
  plot.add_option("-o,--out", plotted->out, "folder for figure.svg, figure.png and signals")
      .capture_default_str();
  plot.callback([plotted, &exit_code] { exit_code = apps::plot(*plotted); });

  const auto compared = std::make_shared<CompareArguments>();
  const Command compare = add_offline(app, "compare");
  compare.footer("Example:\n  hapticgiant compare before.mcap after.mcap");
  compare.add_option("a", compared->a, "recording").required().existing_file();
  compare.add_option("b", compared->b, "recording").required().existing_file();
  compare.callback([compared, &exit_code] { exit_code = apps::compare(*compared); });
}

}  // namespace hg::apps
