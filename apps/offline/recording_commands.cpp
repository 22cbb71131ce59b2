#include "apps/offline/recording_commands.h"

#include <fmt/format.h>

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
#include "apps/hapticgiant/run_setup.h"
#include "apps/offline/run_data.h"
#include "apps/offline/subcommand.h"
#include "hg/analysis/summary.h"
#include "hg/core/error.h"
#include "hg/core/scratch_folder.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"

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
      scenario_.emplace(recorded_scenario(configuration_));
      summary_.emplace(scenario::make_summary(*scenario_));
    }
    summary_->add(sample);
    if (sample.record.time_s < due_s_ - kTick_s) return;
    due_s_ = sample.record.time_s + period_s_;
    columns_.append(sample);
  }

  // Writes run.json and signals.npy of the recording into a folder.
  void write(const fs::path& folder, const std::string& file, const char* kind,
             const recording::ReadResult& read) {
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
    analysis::RunFacts facts = scenario::facts_of_scenario(*scenario_);
    facts.rate_Hz = scenario_->device.model.rate_Hz;
    run["summary"] = summary_->to_json(facts, {});
    make_folder(folder.string());
    write_run(folder, run, columns_);
  }

 private:
  recording::Columns columns_;
  double period_s_, due_s_ = 0.0;
  std::vector<recording::NamedText> configuration_;
  std::optional<config::Scenario> scenario_;
  std::optional<analysis::Summary> summary_;
  Json events_ = Json::array();
};

void write_recording(const std::string& file, const char* kind, const fs::path& folder,
                     const std::vector<std::string>& names, double period_s) {
  Reader reader(names, period_s);
  const recording::ReadResult read = recording::read_recording(file, reader);
  reader.write(folder, file, kind, read);
}

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
    write_recording(file, "any", runs.back(), signal_names(), kFigurePeriod_s);
  }
  std::string signals = "signals.npy";
  try {
    write_report(out, {}, runs);
    print_out(fmt::format("figures     {0}/figure.svg, {0}/figure.png\n", arguments.out));
    signals = "signals.csv";
  } catch (const SetupError& error) {
    print_out(fmt::format("no figures: {}\n", error.what()));
  }
  print_out(fmt::format("signals     {}\n", (runs.front() / signals).string()));
  return 0;
}

int compare(const CompareArguments& arguments) {
  check_report_program();
  const ScratchFolder scratch;
  const fs::path folder = scratch.path();
  const std::vector<fs::path> runs = {folder / "first", folder / "second"};
  const std::vector<std::string> names = {"time_s", "cycle", "state_hash"};
  write_recording(arguments.a, "compare", runs[0], names, 0.0);
  write_recording(arguments.b, "compare", runs[1], names, 0.0);
  return write_report(folder, {}, runs);
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
  plot.add_option("--out", plotted->out, "folder for figure.svg, figure.png and signals")
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
