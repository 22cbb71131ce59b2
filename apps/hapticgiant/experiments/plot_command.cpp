#include "apps/hapticgiant/experiments/plot_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/hapticgiant/experiments/figure_program.h"
#include "apps/hapticgiant/experiments/recorded_signals.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/output_file.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;

// one run: into the folder itself; of several each has a folder of its own
std::vector<fs::path> folders_of(const PlotArguments& arguments) {
  const fs::path out = arguments.out;
  if (arguments.files.size() == 1) return {out};
  std::vector<fs::path> folders;
  for (const std::string& file : arguments.files) {
    folders.push_back(out /
                      fmt::format("{}_{}", folders.size() + 1, fs::path(file).stem().string()));
  }
  return folders;
}

}  // namespace

int plot(const PlotArguments& arguments) {
  const std::vector<fs::path> folders = folders_of(arguments);
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const std::string& file = arguments.files[i];
    const RecordedSignals signals = read_signals(file, kFigurePeriod_s);
    make_folder(folders[i].string());
    write_output((folders[i] / "signals.csv").string(), signals.table->to_csv(kFigurePeriod_s));
    const nlohmann::ordered_json facts =
        figure_data(*signals.scenario, *signals.table, signals.marks, "any",
                    fs::path(file).filename().string());
    write_output((folders[i] / "run.json").string(), facts.dump(2) + "\n");
    print_out(fmt::format(
        "{}: {}, {:.1f} s{}\n{}", file, signals.scenario->title, (*signals.table)["time_s"].back(),
        signals.read.is_complete ? "" : ", cut off", recording::to_text(signals.read.losses)));
  }
  const std::string why = draw_figures(arguments.out, folders);
  print_out(why.empty() ? fmt::format("figures     {0}/figure.svg, {0}/figure.png\n", arguments.out)
                        : why + "\n");
  print_out(fmt::format("signals     {}\n", (folders.front() / "signals.csv").string()));
  return 0;
}

}  // namespace hg::apps
