/// `hapticgiant experiment timing`: computation time of a cycle of the Cartesian admittance,
/// compared with section VII-A of the paper.

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/output_file.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/version.h"
#include "apps/offline/paper_experiment_command.h"
#include "bench/bench_results.h"
#include "bench/cycle_table.h"
#include "bench/machine.h"
#include "hg/core/error.h"
#include "hg/experiments/moved_scenario.h"

namespace hg::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kPasses = 2;

// Computing times of one law at one rate.
Json measure(const PaperExperimentArguments& arguments, const std::string& law, double rate_Hz) {
  scenario::ScenarioOptions world;
  world.scenario = "free_space";  // of the Cartesian experiment
  world.seed = arguments.seed;
  world.rate_Hz = rate_Hz;
  world.law = law;
  world.device = arguments.device;
  world.twin = arguments.twin;
  const bool is_own = arguments.device.empty() && arguments.twin.empty();
  config::Scenario scenario = is_own ? scenario::load(world) : experiments::moved_scenario(world);
  if (arguments.duration_s) scenario.duration_s = *arguments.duration_s;
  if (isatty(STDERR_FILENO) != 0) draw_error(fmt::format("law {}, {:.0f} Hz ...", law, rate_Hz));
  const bench::CycleTimes times =
      bench::measure_cycle(scenario.title, scenario, kPasses, std::size_t{1} << 40U);
  if (!is_own) print_out(fmt::format("{}, law {}, {:g} Hz\n", scenario.title, law, rate_Hz));
  Json row = bench::json_of(times);
  row["law"] = law;
  row["rate_Hz"] = rate_Hz;
  return row;
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
  Json results = {{"kind", "timing"},
                  {"has_two_laws", has_two_laws},
                  {"duration_s", arguments.duration_s ? Json(*arguments.duration_s) : Json()},
                  {"machine", bench::describe_machine()}};
  for (const double rate_Hz : arguments.rates_Hz) {
    for (const std::string& law : laws) {
      results["rows"].push_back(measure(arguments, law, rate_Hz));
    }
  }
  if (isatty(STDERR_FILENO) != 0) draw_error("");
  write_output((folder / "results.json").string(),
               results.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  return become_reports({report_in(folder.string(), arguments.docs, results)});
}

}  // namespace hg::apps
