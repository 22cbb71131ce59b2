/// The program `hapticgiant`: parses the command line and hands over to one subcommand.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include "apps/hapticgiant/bench_command.h"
#include "apps/hapticgiant/bridge_command.h"
#include "apps/hapticgiant/bus_command.h"
#include "apps/hapticgiant/check_command.h"
#include "apps/hapticgiant/commission_command.h"
#include "apps/hapticgiant/design_command.h"
#include "apps/hapticgiant/doctor_command.h"
#include "apps/hapticgiant/experiment_command.h"
#include "apps/hapticgiant/experiments/recording_commands.h"
#include "apps/hapticgiant/explain_command.h"
#include "apps/hapticgiant/export_command.h"
#include "apps/hapticgiant/faults_command.h"
#include "apps/hapticgiant/haptify_command.h"
#include "apps/hapticgiant/hqp_solve.h"
#include "apps/hapticgiant/identify_command.h"
#include "apps/hapticgiant/new_command.h"
#include "apps/hapticgiant/option_checks.h"
#include "apps/hapticgiant/output.h"
#include "apps/hapticgiant/python_commands.h"
#include "apps/hapticgiant/replay_command.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/simulate_command.h"
#include "apps/hapticgiant/stack.h"
#include "apps/hapticgiant/start_test_command.h"
#include "apps/hapticgiant/tune_command.h"
#include "apps/hapticgiant/version.h"
#include "hg/core/error.h"
#include "hg/core/nearest_name.h"

namespace {

namespace apps = hg::apps;

constexpr int kInternalError = 1, kBadInput = 2;

// The subcommand of `app` that was missed, and which there are.
std::string missing_subcommand(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  for (const std::string& word : app.remaining()) {
    if (word.starts_with('-')) continue;
    return fmt::format("{}: no such subcommand of {}, did you mean '{}'?", word, app.get_name(),
                       hg::nearest_name(word, names));
  }
  return fmt::format("{}: expected a subcommand: {}", app.get_name(), fmt::join(names, ", "));
}

int explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* last = &app;
  while (!last->get_subcommands().empty()) last = last->get_subcommands().back();
  if (dynamic_cast<const CLI::RequiredError*>(&error) == nullptr ||
      last->get_require_subcommand_min() == 0) {
    std::ostringstream out;
    std::ostringstream errors;
    const int code = app.exit(error, out, errors);
    apps::print_out(out.str());
    apps::print_error(errors.str());
    return code == 0 ? 0 : kBadInput;
  }
  apps::print_error("{}\nRun with --help for more information.\n", missing_subcommand(*last));
  return kBadInput;
}

// `exit_code` is that of the subcommand that the command line names, which runs at once
int parse(CLI::App& app, int argc, char** argv, const int& exit_code) {
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  } catch (const hg::SetupError& error) {
    apps::print_error("{}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    apps::print_error("internal error: {}\n", error.what());
    return kInternalError;
  }
}

}  // namespace

int main(int argc, char** argv) {
  apps::open_standard_files();
  if (const std::string lack = apps::provide_stack(); !lack.empty()) {
    apps::print_error("{}\n", lack);
    return kBadInput;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that must not grow is an error of that file

  CLI::App app("HapticGiant: feel the digital twin of any serial chain.", "hapticgiant");
  app.set_version_flag("--version", apps::kVersion);
  app.require_subcommand(1);

  int exit_code = 0;
  apps::add_run(app, argv[0], exit_code);
  apps::add_doctor(app, exit_code);
  apps::add_bus(app, exit_code);
  apps::add_bridge(app, exit_code);
  apps::add_replay(app, exit_code);
  apps::add_explain(app, exit_code);
  apps::add_export(app, exit_code);
  apps::add_simulate(app, exit_code);
  apps::add_start_test(app, exit_code);
  apps::add_commission(app, exit_code);
  apps::add_check(app, exit_code);
  apps::add_new(app, exit_code);
  apps::add_hqp(app, exit_code);
  apps::add_identify(app, exit_code);
  apps::add_experiment(app, exit_code);
  apps::add_plot_and_compare(app, exit_code);
  apps::add_bench(app, exit_code);
  apps::add_faults(app, exit_code);
  apps::add_haptify(app, exit_code);
  apps::add_tune(app, exit_code);
  apps::add_design(app);
  apps::add_python_commands(app);
  apps::refuse_empty_values(app);

  return apps::code_after_output(parse(app, argc, argv, exit_code));
}
