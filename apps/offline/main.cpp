/// The program `hapticgiant-offline`: the commands of `hapticgiant` that no machine needs.

#include "apps/hapticgiant/start.h"
#include "apps/offline/bench_command.h"
#include "apps/offline/design_command.h"
#include "apps/offline/experiment_command.h"
#include "apps/offline/export_command.h"
#include "apps/offline/faults_command.h"
#include "apps/offline/haptify_command.h"
#include "apps/offline/hqp_solve.h"
#include "apps/offline/identify_command.h"
#include "apps/offline/recording_commands.h"
#include "apps/offline/tune_command.h"

int main(int argc, char** argv) {
  namespace apps = hg::apps;
  return apps::start(argc, argv, [](apps::Command program, int& exit_code) {
    apps::add_export(program, exit_code);
    apps::add_plot_and_compare(program, exit_code);
    apps::add_hqp(program, exit_code);
    apps::add_identify(program, exit_code);
    apps::add_experiment(program, exit_code);
    apps::add_bench(program, exit_code);
    apps::add_faults(program, exit_code);
    apps::add_haptify(program, exit_code);
    apps::add_tune(program, exit_code);
    apps::add_design(program, exit_code);
  });
}
