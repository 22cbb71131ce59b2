/// The program `hapticgiant`: what is needed beside a machine or its simulation, and the names of
/// all other commands, which are programs of their own.

#include <vector>

#include "apps/hapticgiant/advice.h"
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

namespace {

constexpr char kFirstSteps[] =
    "HapticGiant: feel the digital twin of any serial chain.\n\n"
    "First steps:\n"
    "  hapticgiant run                      a scripted hand opens a door; the page shows it\n"
    "  hapticgiant run door --user mouse    drag the handle yourself, on the page\n"
    "  hapticgiant run --list               everything that is ready to run\n"
    "  hapticgiant new device MY_ARM.urdf   begin with an arm of your own\n";

void group(hg::apps::Command program) {
  program.describe(kFirstSteps);
  program.group("Runs", {"run", "replay", "render", "explain", "plot", "compare", "export"});
  program.group("Your own device and twin", {"new", "check", "identify", "tune", "design", "imus"});
  program.group("The machine", {"doctor", "bus", "commission", "start-test"});
  program.group("Studies and experiments",
                {"study", "sweep", "experiment", "haptify", "faults", "bench", "hqp"});
  program.group("Other programs", {"simulate", "bridge"});
  program.group("This program", {"help", "completion"});
}

}  // namespace

int main(int argc, char** argv) {
  namespace apps = hg::apps;
  std::vector<char*> words = apps::with_help_as_option(argc, argv);
  const int count = static_cast<int>(words.size()) - 1;
  const auto add = [&](apps::Command program, int& exit_code) {
    apps::add_run(program, argv[0], exit_code);
    apps::add_replay(program, exit_code);
    apps::add_explain(program, exit_code);
    apps::add_new(program, exit_code);
    apps::add_check(program, exit_code);
    apps::add_doctor(program, exit_code);
    apps::add_bus(program, exit_code);
    apps::add_commission(program, exit_code);
    apps::add_start_test(program, exit_code);
    apps::add_offline_commands(program, count, words.data());
    apps::add_python_commands(program);
    apps::add_simulate(program, exit_code);
    apps::add_bridge(program);
    apps::add_completion(program);
    apps::add_help(program);
    group(program);
  };
  return apps::start(count, words.data(), add, apps::advices());
}
