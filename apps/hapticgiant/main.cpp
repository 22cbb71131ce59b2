/// The program `hapticgiant`: what is needed beside a machine or its simulation, and the names of
/// all other commands, which are programs of their own.

#include "apps/hapticgiant/bridge_command.h"
#include "apps/hapticgiant/bus_command.h"
#include "apps/hapticgiant/check_command.h"
#include "apps/hapticgiant/commission_command.h"
#include "apps/hapticgiant/completion_command.h"
#include "apps/hapticgiant/doctor_command.h"
#include "apps/hapticgiant/explain_command.h"
#include "apps/hapticgiant/new_command.h"
#include "apps/hapticgiant/offline_commands.h"
#include "apps/hapticgiant/python_commands.h"
#include "apps/hapticgiant/replay_command.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/simulate_command.h"
#include "apps/hapticgiant/start.h"
#include "apps/hapticgiant/start_test_command.h"

int main(int argc, char** argv) {
  namespace apps = hg::apps;
  return apps::start(argc, argv, [argc, argv](apps::Command program, int& exit_code) {
    apps::add_run(program, argv[0], exit_code);
    apps::add_simulate(program, exit_code);
    apps::add_replay(program, exit_code);
    apps::add_explain(program, exit_code);
    apps::add_check(program, exit_code);
    apps::add_new(program, exit_code);
    apps::add_doctor(program, exit_code);
    apps::add_bus(program, exit_code);
    apps::add_start_test(program, exit_code);
    apps::add_commission(program, exit_code);
    apps::add_bridge(program);
    apps::add_offline_commands(program, argc, argv);
    apps::add_python_commands(program);
    apps::add_completion(program);
  });
}
