#include "apps/hapticgiant/run_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <iterator>
#include <memory>
#include <vector>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/report.h"
#include "apps/hapticgiant/run_printer.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/core/whole_file.h"
#include "hg/scenario/run/json_lines.h"
#include "hg/scenario/run/plan_options.h"
#include "hg/scenario/run/run_player.h"
#include "hg/scenario/run/run_streams.h"

namespace hg::apps {
namespace {

std::string request_text(const std::string& file) {
  if (file != "-") return read_file(file);
  return {std::istreambuf_iterator<char>(std::cin), {}};
}

scenario::RunPlan plan_of(const RunArguments& arguments) {
  scenario::RunPlan plan = arguments.request.empty()
                               ? arguments.plan
                               : scenario::plan_of_request(request_text(arguments.request));
  plan.timing.continues = isatty(STDOUT_FILENO) == 1;
  return plan;
}

scenario::RunHost host_of(const RunArguments& arguments, const scenario::RunRecords& records) {
  scenario::RunHost host{.program = arguments.program};
  if (!records.has_lab_streams) return host;
  const std::string package = python_package_folder("pylsl");
  host.lab_libraries = scenario::lab_libraries(
      package.empty() ? std::vector<std::string>{} : std::vector{package + "/lib/liblsl.so"});
  return host;
}

// the reports go to `observers`, besides being printed
int play(const RunArguments& arguments, std::vector<scenario::RunObserver*> observers) {
  const scenario::RunPlan plan = plan_of(arguments);
  scenario::RunPlayer player(plan, host_of(arguments, plan.records));
  const std::atomic<bool>& interrupted = watch_interruption();
  const BackgroundOutput output(interrupted);
  RunPrinter printer(plan, arguments.summary, isatty(STDOUT_FILENO) == 1, output);
  observers.insert(observers.begin(), &printer);
  scenario::RunObservers all(std::move(observers));
  const scenario::RunOutcome outcome = player.play(all, interrupted);
  return outcome.exit_code == 0 && !printer.is_written() ? kNotWritten : outcome.exit_code;
}

}  // namespace

int run(const RunArguments& arguments) {
  if (arguments.is_list) {
    print_shipped();
    return 0;
  }
  check_writable(arguments.summary, kJson);
  if (!arguments.report_to) return play(arguments, {});
  scenario::LineWriter writer(*arguments.report_to);
  scenario::JsonObserver reports([&writer](const auto& report, scenario::Worth worth) {
    writer.push(scenario::to_line(report), worth);
  });
  try {
    const int exit_code = play(arguments, {&reports});
    const std::string failure = writer.end();
    if (failure.empty()) return exit_code;
    fmt::print(stderr, "--report-to {}: {}: reports are missing\n", *arguments.report_to, failure);
    return exit_code == 0 ? kNotWritten : exit_code;
  } catch (const SetupError& error) {
    reports.refused(error.what());
    throw;
  }
}

}  // namespace hg::apps
