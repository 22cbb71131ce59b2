/// The program `hapticgiant`: parses the command line and hands over to one subcommand.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <exception>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "apps/hapticgiant/bench_command.h"
#include "apps/hapticgiant/check_command.h"
#include "apps/hapticgiant/doctor_command.h"
#include "apps/hapticgiant/experiment_command.h"
#include "apps/hapticgiant/experiments/command_line.h"
#include "apps/hapticgiant/explain_command.h"
#include "apps/hapticgiant/faults_command.h"
#include "apps/hapticgiant/haptify_command.h"
#include "apps/hapticgiant/hqp_solve.h"
#include "apps/hapticgiant/identify_command.h"
#include "apps/hapticgiant/new_command.h"
#include "apps/hapticgiant/option_checks.h"
#include "apps/hapticgiant/output.h"
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

using hg::apps::at_least;
using hg::apps::number_that;
using hg::apps::number_within;
using hg::apps::print_error;
using hg::apps::print_out;
using hg::apps::whole_number;

constexpr char kSimulationHelp[] =
    "simulation.yaml instead of the device's, or the NAME of a simulation_NAME.yaml beside it: "
    "as_published, harder";
constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

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
    print_out(out.str());
    print_error(errors.str());
    return code == 0 ? 0 : kBadInput;
  }
  print_error("{}\nRun with --help for more information.\n", missing_subcommand(*last));
  return kBadInput;
}

// an IPv6 address as it stands in a link
std::string without_brackets(const std::string& text) {
  const bool has_both = text.size() > 2 && text.starts_with('[') && text.ends_with(']');
  return has_both ? text.substr(1, text.size() - 2) : text;
}

// options shared by run and simulate
void add_scenario_options(CLI::App& command, hg::apps::ScenarioArguments& world) {
  command
      .add_option("scenario", world.scenario,
                  "scenario file, or door, excavator, free_space, path, walk, surfaces")
      ->capture_default_str();
  command.add_option("--device", world.device, "device.yaml instead of the scenario's");
  command.add_option("--twin", world.twin,
                     "twin.yaml, or the name of a shipped one, instead of the scenario's");
  command.add_option("--plant", world.plant, "elastic: all that makes haptics hard; or ideal")
      ->check(CLI::IsMember({"elastic", "ideal"}));
  command.add_option("--simulation", world.simulation, kSimulationHelp);
  command.add_option("--sensors", world.sensors, "real: with all their errors; or ideal")
      ->check(CLI::IsMember({"real", "ideal"}));
  command.add_option("--hand", world.hand, "how hard the simulated hand is made")
      ->check(CLI::IsMember({"relaxed", "normal", "stiff"}));
  command.add_option("--seed", world.seed, "of noise and tremor: the same seed, the same run")
      ->check(whole_number(0.0));
  command.add_option("--step", world.step_s, "largest step of the simulated machine, s")
      ->check(number_that("from 1e-5 to 2e-3",
                          [](double value) { return value >= 1e-5 && value <= 2e-3; }));
  command.add_option("--user", world.user, "file or name of a script, mouse or none");
  command.add_option("--rate-hz", world.rate_Hz, "control rate, 100..20000; default: the device's")
      ->check(number_that("from 100 to 20000",
                          [](double value) { return value >= 100.0 && value <= 20000.0; }));
}

void add_run(CLI::App& app, hg::apps::RunArguments& run, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("run", "A person at the device feels the twin (the main job).");
  command->footer(
      "Examples:\n"
      "  hapticgiant run                          the door, scripted hand, page in the browser\n"
      "  hapticgiant run excavator --fast --summary out.json\n"
      "  hapticgiant run door --user mouse        drag the handle in the page");
  add_scenario_options(*command, run.world);
  command->add_option(
      "--device-address", run.device_address,
      "HOST:PORT of a remote device (hapticgiant simulate) instead of a simulated one");
  command
      ->add_option("--key-file", run.key_file,
                   "secret that the remote device has, too (docs/reference/device_protocol.md)")
      ->needs("--device-address");
  command
      ->add_flag("--without-start-test", run.without_start_test,
                 "drive a machine whose brakes and stop inputs were not tested today")
      ->needs("--device-address");
  command
      ->add_option("--posture-confirmed", run.confirmed_joints,
                   "joints of a machine that do stand elsewhere than the last run has left them, "
                   "as NAME,NAME")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs("--device-address");
  command
      ->add_option("--duration", run.duration_s,
                   "seconds; default: until the script has played, with a page at a terminal until "
                   "Ctrl-C")
      ->check(number_that("more than 0", [](double value) { return value > 0.0; }));
  CLI::Option* fast = command->add_flag(
      "--fast", run.is_fast, "as fast as it can instead of in real time; without the page");
  command->add_option("--law", run.law, "gauss or paper; default: the device's")
      ->check(CLI::IsMember({"gauss", "paper"}));
  command->add_option("--bounds", run.bounds, "recoverable or paper; default: the device's")
      ->check(CLI::IsMember({"recoverable", "paper"}));
  command->add_option("--gantry", run.gantry, "law or rule; default: the device's")
      ->check(CLI::IsMember({"law", "rule"}));
  command->add_option("--braking", run.braking, "alone or together; default: the device's")
      ->check(CLI::IsMember({"alone", "together"}));
  command
      ->add_option("--passivity", run.passivity,
                   "off, observe or act on a hand and a device that shake each other; default: the "
                   "device's")
      ->check(CLI::IsMember({"off", "observe", "act"}));
  command->add_option("--summary", run.summary, "write the closing summary as JSON to this file");
  CLI::Option* no_viewer = command->add_flag("!--no-viewer", run.has_viewer, "without the page");
  command
      ->add_option("--bind", run.address,
                   "IP address that the page is served at; 0.0.0.0: all of this machine")
      ->excludes(fast)
      ->excludes(no_viewer)
      ->transform(without_brackets)
      ->capture_default_str();
  command->add_option("--port", run.port, "port of the page; default: any free one")
      ->excludes(fast)
      ->excludes(no_viewer)
      ->check(whole_number(0.0, 65535.0));
  command->add_flag("!--no-browser", run.opens_browser, "print the link only");
  command->add_option("--recordings", run.recordings, "folder of the recordings")
      ->capture_default_str();
  command->add_flag("!--no-recording", run.has_recording, "without a recording");
  command
      ->add_option("--flight-recorder", run.flight_recorder,
                   "when the last 10 s are written to a file of their own: fault, always or off")
      ->check(CLI::IsMember({"fault", "always", "off"}))
      ->capture_default_str();
  command
      ->add_option(
          "--slow-solve", run.slow_solve,
          "keep problems of the solver that take this many active sets, beside the recording")
      ->check(at_least(1))
      ->capture_default_str();
  command
      ->add_option("--priority", run.priority,
                   "SCHED_FIFO priority of the control thread, 1..99; 0: an ordinary thread")
      ->check(number_that("from 0 to 99", [](double v) { return v >= 0.0 && v <= 99.0; }))
      ->capture_default_str();
  command->add_option("--cpu", run.cpu, "the only processor of the control thread; default: any")
      ->check(at_least(0));
  command->callback([&run, &exit_code] { exit_code = hg::apps::run(run); });
}

void add_doctor(CLI::App& app, hg::apps::DoctorArguments& doctor, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "doctor", "How ready this computer is for a control loop, and what to change.");
  command->footer(
      "Examples:\n"
      "  hapticgiant doctor                       a quarter of a minute\n"
      "  hapticgiant doctor --seconds 600 --cpu 3 --json doctor.json");
  command->add_option("--seconds", doctor.seconds, "of each of the four measurements")
      ->check(number_that("from 0.1 to 100000", [](double v) { return v >= 0.1 && v <= 1e5; }))
      ->capture_default_str();
  command->add_option("--priority", doctor.priority, "as in run")
      ->check(number_that("from 1 to 99", [](double v) { return v >= 1.0 && v <= 99.0; }))
      ->capture_default_str();
  command->add_option("--cpu", doctor.cpu, "as in run")->check(at_least(0));
  command->add_option("--json", doctor.json, "write everything as JSON to this file");
  command->callback([&doctor, &exit_code] { exit_code = hg::apps::doctor(doctor); });
}

void add_replay(CLI::App& app, hg::apps::ReplayArguments& replay, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "replay", "Runs the cycle of a recording again, bit for bit; or look at it again.");
  command->footer(
      "Examples:\n"
      "  hapticgiant replay recordings/latest.mcap        does the cycle still give the same?\n"
      "  hapticgiant replay recordings/latest.mcap --view\n"
      "  hapticgiant replay one.mcap --compare two.mcap --view --speed 0.5");
  command->add_option("file", replay.file, "recording of hapticgiant run")
      ->required()
      ->check(CLI::ExistingFile);
  CLI::Option* view =
      command->add_flag("--view", replay.has_view, "in the page, with play, pause and scrubbing");
  command->add_option("--compare", replay.compare, "a second recording, shown through the first")
      ->needs(view)
      ->check(CLI::ExistingFile);
  command->add_option("--speed", replay.speed, "recorded seconds per second, 0.1..8")
      ->needs(view)
      ->check(number_that("from 0.1 to 8", [](double v) { return v >= 0.1 && v <= 8.0; }));
  command->add_option("--bind", replay.address, "as in run")
      ->needs(view)
      ->transform(without_brackets)
      ->capture_default_str();
  command->add_option("--port", replay.port, "as in run")
      ->needs(view)
      ->check(whole_number(0.0, 65535.0));
  command->add_flag("!--no-browser", replay.opens_browser, "as in run");
  command->callback([&replay, &exit_code] { exit_code = hg::apps::replay(replay); });
}

void add_explain(CLI::App& app, std::string& file, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("explain", "Tells in words what happened in a recording, in order.");
  command->footer("Example:\n  hapticgiant explain recordings/latest.mcap");
  command->add_option("file", file, "recording, also one that a crash has cut off")
      ->required()
      ->check(CLI::ExistingFile);
  command->callback([&file, &exit_code] { exit_code = hg::apps::explain_recording(file); });
}

void add_simulate(CLI::App& app, hg::apps::SimulateArguments& simulate, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Device and person of a scenario for a controller elsewhere, over UDP.");
  command->footer(
      "Examples:\n"
      "  hapticgiant simulate door --listen 127.0.0.1:4810     then, in another terminal:\n"
      "  hapticgiant run door --device-address 127.0.0.1:4810");
  add_scenario_options(*command, simulate.world);
  command
      ->add_option(
          "--listen", simulate.listen,
          "HOST:PORT to serve at; whoever can reach it can move the device, or has to have "
          "the key")
      ->required();
  command->add_option("--key-file", simulate.key_file,
                      "secret that clients must have, too (docs/reference/device_protocol.md)");
  command->add_flag("--fast", simulate.is_fast,
                    "lock-step: each side waits for the other (run --fast) instead of real time");
  command->add_option("--capture", simulate.capture,
                      "write every datagram to this pcap file (docs/reference/device_protocol.md)");
  command->callback([&simulate, &exit_code] { exit_code = hg::apps::simulate(simulate); });
}

void add_start_test(CLI::App& app, hg::apps::StartTestArguments& test, int& exit_code) {
  CLI::App* command = app.add_subcommand("start-test",
                                         "Brakes and stop inputs, step by step, before the first "
                                         "run of a day (docs/reference/start_test.md).");
  command->footer(
      "Examples:\n"
      "  hapticgiant start-test                   the simulated device, with a simulated operator\n"
      "  hapticgiant start-test --device my_arm_device.yaml --device-address 192.168.1.20:4810");
  add_scenario_options(*command, test.world);
  command->add_option("--device-address", test.device_address,
                      "HOST:PORT of a remote device instead of a simulated one");
  command
      ->add_option("--key-file", test.key_file,
                   "secret that the remote device has, too (docs/reference/device_protocol.md)")
      ->needs("--device-address");
  command->add_flag("--fast", test.is_fast, "lock-step with a remote device that is simulated")
      ->needs("--device-address");
  command
      ->add_option("--priority", test.priority,
                   "SCHED_FIFO priority with a remote device, 1..99; 0: an ordinary thread")
      ->check(number_that("from 0 to 99", [](double v) { return v >= 0.0 && v <= 99.0; }))
      ->capture_default_str();
  command->add_option("--recordings", test.recordings, "folder that keeps the result")
      ->capture_default_str();
  command->callback([&test, &exit_code] { exit_code = hg::apps::start_test(test); });
}

void add_new(CLI::App& app, hg::apps::NewArguments& arguments, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("new", "Write a first device.yaml or twin.yaml for a URDF.");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hapticgiant new device my_arm.urdf\n"
      "  hapticgiant new twin my_gate.urdf --device my_arm_device.yaml");
  const auto add = [&](const char* kind, const char* text,
                       int (*run)(const hg::apps::NewArguments&)) {
    CLI::App* what = command->add_subcommand(kind, text);
    what->add_option("urdf", arguments.part.urdf, "URDF of the robot or mechanism")
        ->required()
        ->check(CLI::ExistingFile);
    what->add_option("--root-link", arguments.part.root_link,
                     "first link of the part that is taken");
    what->add_option("--tip-link", arguments.part.tip_link, "last link of the part that is taken");
    what->add_option("-o,--output", arguments.output,
                     "file to write; default: URDF name + _device.yaml or _twin.yaml");
    what->add_flag("--force", arguments.may_overwrite, "overwrite the file");
    what->callback([&arguments, &exit_code, run] { exit_code = run(arguments); });
    return what;
  };
  add("device", "the robot whose handle is held", hg::apps::new_device);
  add("twin", "the mechanism that is felt", hg::apps::new_twin)
      ->add_option("--device", arguments.device, "device.yaml that the twin is placed for");
}

void add_bench(CLI::App& app, hg::apps::BenchArguments& arguments, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "bench",
      "How fast and how right solver, cycle and laws are; minutes (docs/reports/benchmarks.md).");
  command->footer(
      "Examples:\n"
      "  hapticgiant bench                        everything, on the three scenarios\n"
      "  hapticgiant bench door --quick           a first look, in seconds\n"
      "  hapticgiant bench --out results --json results/bench.json");
  command->add_option("scenarios", arguments.scenarios, "scenario files or names")
      ->capture_default_str();
  command->add_flag("--quick", arguments.is_quick, "fewer problems and passes");
  command->add_option("--json", arguments.json, "write all tables as JSON to this file");
  command->add_option("--out", arguments.out,
                      "write tables (CSV) and figures (SVG) to this folder");
  command->callback([&arguments, &exit_code] { exit_code = hg::apps::bench(arguments); });
}

void add_hqp(CLI::App& app, hg::apps::HqpSolveArguments& arguments, int& exit_code) {
  CLI::App* hqp = app.add_subcommand("hqp", "The lexicographic QP solver on its own.");
  hqp->require_subcommand(1);
  CLI::App* solve = hqp->add_subcommand("solve", "Solve the problems of a file (plain or .gz).");
  solve->footer(
      "Examples:\n"
      "  hapticgiant hqp solve tests/reference/exc_two.hqp.gz --timing\n"
      "  hapticgiant hqp solve tests/reference/exc_two.hqp.gz --problem 7 --explain");
  solve->add_option("file", arguments.file, "problem file, format in docs/concepts/hqp.md")
      ->required();
  solve->add_option("--problem", arguments.problem, "only this problem, counted from 0")
      ->check(at_least(0));
  solve->add_flag("--explain", arguments.explains, "levels, rows that act and why, in words");
  solve->add_option("--level", arguments.level, "as --explain, with the multipliers of this level")
      ->check(at_least(0));
  solve->add_flag("--timing", arguments.has_timing, "microseconds, cold and warm");
  solve->callback([&arguments, &exit_code] { exit_code = hg::apps::run_hqp_solve(arguments); });
}

void add_check(CLI::App& app, hg::apps::CheckArguments& check, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "check", "What is wrong with configuration files, and how to fix it; datasheet of a device.");
  command->footer(
      "Examples:\n"
      "  hapticgiant check models/scenarios/door.yaml\n"
      "  hapticgiant check my_device.yaml my_twin.yaml   each, and whether they fit together\n"
      "  hapticgiant check models/haptic_giant/device.yaml --map capability.svg");
  command
      ->add_option("files", check.files,
                   "device, twin, scenario, tool or script files; the kind is told from their keys")
      ->required();
  command->add_option("--json", check.json, "write findings and datasheets as JSON to this file");
  command->add_option("--map", check.map,
                      "draw the force over the workspace of the first device to this SVG file");
  command->callback([&check, &exit_code] { exit_code = hg::apps::run_check(check); });
}

void add_identify(CLI::App& app, hg::apps::IdentifyArguments& arguments,
                  hg::apps::IdentifyFrictionArguments& recorded, int& exit_code) {
  CLI::App* identify = app.add_subcommand("identify", "Parameters of a device from measurements.");
  identify->require_subcommand(1);
  CLI::App* payload = identify->add_subcommand(
      "payload", "Mass and centre of what hangs beyond the force/torque sensor.");
  payload->footer(
      "Examples:\n"
      "  hapticgiant identify payload             the simulated device takes the poses itself\n"
      "  hapticgiant identify payload poses.csv   columns a_x a_y a_z f_x f_y f_z n_x n_y n_z "
      "pose");
  payload->add_option("files", arguments.files, "CSV files of poses at rest; none: simulate");
  payload->add_option("--device", arguments.device, "device.yaml")->capture_default_str();
  payload->add_option("--poses", arguments.poses, "poses of the simulated device")
      ->check(at_least(1))
      ->capture_default_str();
  payload->callback(
      [&arguments, &exit_code] { exit_code = hg::apps::identify_payload(arguments); });
  CLI::App* friction = identify->add_subcommand(
      "friction",
      "Friction of each joint from a recording of its motion (docs/concepts/friction.md).");
  friction->footer(
      "Examples:\n"
      "  hapticgiant run free_space --user friction --fast   moves all joints\n"
      "  hapticgiant identify friction recordings/latest.mcap");
  friction->add_option("file", recorded.file, "recording of hapticgiant run")
      ->required()
      ->check(CLI::ExistingFile);
  friction->add_option("--device", recorded.device,
                       "device.yaml to compare with instead of that of the recording");
  friction->add_option("--json", recorded.json, "write all figures as JSON to this file");
  friction->callback(
      [&recorded, &exit_code] { exit_code = hg::apps::identify_friction(recorded); });
}

void add_seeds(CLI::App& experiment, hg::apps::SeedsArguments& arguments, int& exit_code) {
  CLI::App* command = experiment.add_subcommand(
      "seeds", "what scenarios show over many seeds and hands: limits, faults, events, errors");
  command->add_option("scenarios", arguments.scenarios, "scenario files or names")
      ->capture_default_str();
  command->add_option("--hands", arguments.hands, "own: that of each scenario; or presets")
      ->delimiter(',')
      ->check(CLI::IsMember({"own", "relaxed", "normal", "stiff"}))
      ->capture_default_str();
  command->add_option("--count", arguments.count, "seeds per scenario and hand")
      ->check(whole_number(1.0, 1e6))
      ->capture_default_str();
  command->add_option("--first", arguments.first, "the first of them")
      ->check(whole_number(0.0))
      ->capture_default_str();
  command->add_option("--law", arguments.law, "gauss or paper; default: the device's")
      ->check(CLI::IsMember({"gauss", "paper"}));
  command->add_option("--bounds", arguments.bounds, "recoverable or paper; default: the device's")
      ->check(CLI::IsMember({"recoverable", "paper"}));
  command->add_option("--gantry", arguments.gantry, "law or rule; default: the device's")
      ->check(CLI::IsMember({"law", "rule"}));
  command->add_option("--braking", arguments.braking, "alone or together; default: the device's")
      ->check(CLI::IsMember({"alone", "together"}));
  command->add_option("--json", arguments.json, "write all runs as JSON to this file");
  command->add_option("--markdown", arguments.markdown, "write the table as Markdown to this file");
  command->callback(
      [&arguments, &exit_code] { exit_code = hg::apps::experiment_seeds(arguments); });
}

void add_contact(CLI::App& experiment, hg::apps::ContactArguments& arguments, int& exit_code) {
  CLI::App* command = experiment.add_subcommand(
      "contact",
      "the arm hits somebody in its way: force and pressure, with and without giving way");
  command->add_option("--seeds", arguments.seeds, "seeds per case, from 1 on")
      ->check(whole_number(1.0, 1e3))
      ->capture_default_str();
  command->add_option("--json", arguments.json, "write all figures as JSON to this file");
  command->add_option("--docs", arguments.docs,
                      "refresh the page contact.md of this folder (make experiments)");
  command->callback(
      [&arguments, &exit_code] { exit_code = hg::apps::experiment_contact(arguments); });
}

void add_inertial(CLI::App& experiment, hg::apps::InertialArguments& arguments, int& exit_code) {
  CLI::App* command = experiment.add_subcommand(
      "inertial", "what inertial units on the links know that encoders do not");
  command->add_option("scenarios", arguments.scenarios, "scenario files or names")
      ->capture_default_str();
  command->add_option("--simulation", arguments.simulation, kSimulationHelp);
  command->add_option("--seeds", arguments.seeds, "seeds per case, from 1 on")
      ->check(whole_number(1.0, 1e3))
      ->capture_default_str();
  command->add_option("--json", arguments.json, "write all figures as JSON to this file");
  command->add_flag(
      "--feel", arguments.feels,
      "what a hand feels where the control uses them: transparency, light bodies, wall");
  command->callback(
      [&arguments, &exit_code] { exit_code = hg::apps::experiment_inertial(arguments); });
}

void add_experiment(CLI::App& app, hg::apps::ExperimentArguments& arguments,
                    hg::apps::ContactArguments& contact, hg::apps::InertialArguments& inertial,
                    hg::apps::SeedsArguments& seeds, hg::apps::ExperimentsArguments& more,
                    int& exit_code) {
  CLI::App* command =
      app.add_subcommand("experiment",
                         "The paper's experiments, and what the simulated device is like to hold "
                         "(docs/experiments, docs/reports/simulated_machine.md).");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n"
      "  hapticgiant experiment all               Figs. 6, 8 and 9 of the paper, and its path\n"
      "  hapticgiant experiment door --law both --out results\n"
      "  hapticgiant experiment free-space        force and vibration on a slow walk, what makes "
      "them\n"
      "  hapticgiant experiment stability-map --svg stability.svg\n"
      "  hapticgiant experiment impedance --json impedance.json\n"
      "  hapticgiant experiment contact           the arm hits somebody in its way\n"
      "  hapticgiant experiment inertial --simulation harder\n"
      "  hapticgiant experiment seeds free_space --hands own,stiff --count 16");
  hg::apps::add_paper_experiments(*command, more.paper, exit_code);
  const auto add = [&](const char* name, const char* text,
                       int (*run)(const hg::apps::ExperimentArguments&)) {
    CLI::App* what = command->add_subcommand(name, text);
    what->add_option("--json", arguments.json, "write all figures as JSON to this file");
    what->callback([&arguments, &exit_code, run] { exit_code = run(arguments); });
    return what;
  };
  add("free-space", "force and vibration at the handle of a free body, and what makes them",
      hg::apps::experiment_free_space);
  CLI::App* map = add("stability-map",
                      "how stiff a hand may be for how light a body, before contact is unstable",
                      hg::apps::experiment_stability_map);
  map->add_option("--svg", arguments.svg, "draw the map to this file");
  map->add_option("--device", arguments.device, "device.yaml instead of the reference device's");
  map->add_option("--simulation", arguments.simulation, kSimulationHelp);
  add("impedance", "how far the handle gives way, by frequency and under a constant push",
      hg::apps::experiment_impedance);
  add_contact(*command, contact, exit_code);
  add_inertial(*command, inertial, exit_code);
  add_seeds(*command, seeds, exit_code);
}

void add_faults(CLI::App& app, hg::apps::FaultsArguments& arguments, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "faults",
      "Breaks the simulated machine on purpose, hundreds of times (docs/concepts/safety.md).");
  command->footer(
      "Examples:\n"
      "  hapticgiant faults\n"
      "  hapticgiant faults --cases 60 --seed 7 --scenario door --json faults.json");
  command->add_option("--cases", arguments.campaign.cases, "number of runs")
      ->check(whole_number(1.0, 1e9));
  command->add_option("--seed", arguments.campaign.seed, "of scenarios, times and sizes")
      ->check(whole_number(0.0));
  command->add_option("--scenario", arguments.scenarios, "scenarios with a script");
  CLI::Option* processes = command->add_flag(
      "--processes", arguments.plays_processes,
      "faults of the controller's process (terminal, disk, memory, ...) instead, in real time");
  command->add_option("--repetitions", arguments.repetitions, "of the faults of processes")
      ->check(whole_number(1.0, 1e6))
      ->needs(processes);
  command->add_option("--json", arguments.json, "write all cases as JSON to this file");
  command->add_option("--markdown", arguments.markdown, "write the table as a page to this file")
      ->excludes(processes);
  command->callback([&arguments, &exit_code] { exit_code = hg::apps::faults(arguments); });
}

void add_haptify(CLI::App& app, hg::apps::HaptifyArguments& arguments, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "haptify",
      "Table III of the paper on the simulated device: how good it is to hold; minutes.");
  command->footer(
      "Examples:\n"
      "  hapticgiant haptify                      report in haptify/report.html\n"
      "  hapticgiant haptify --quick              a look, in seconds\n"
      "  hapticgiant haptify --seed 7 --repetitions 10 --out results\n"
      "  hapticgiant haptify --quick --simulation as_published\n"
      "  hapticgiant haptify --goals --repetitions 16   the worst of seeds, heights and hands");
  command->add_option("--out", arguments.out, "folder of the report")->capture_default_str();
  command->add_option("--seed", arguments.options.seed, "of the first repetition")
      ->check(whole_number(0.0))
      ->capture_default_str();
  command->add_option("--repetitions", arguments.options.repetitions, "with other seeds")
      ->check(whole_number(2.0, 100.0))
      ->capture_default_str();
  command->add_flag("--quick", arguments.options.is_quick, "few samples and short runs");
  command->add_flag("--goals", arguments.only_goals,
                    "only what the device shall reach, at three heights in three hands");
  command->add_option(
      "--twin", arguments.twin,
      "free body that is held (with --goals: the light one), as a file or a shipped name");
  command->add_option("--simulation", arguments.simulation, kSimulationHelp);
  command->add_option("--docs", arguments.docs,
                      "refresh the page haptify.md of this folder (make experiments)");
  command->callback([&arguments, &exit_code] { exit_code = hg::apps::run_haptify(arguments); });
}

void add_tune(CLI::App& app, hg::apps::TuneArguments& arguments, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "tune", "Filters and poles for the torque control of a device, with their proof; minutes.");
  command->footer(
      "Examples:\n"
      "  hapticgiant tune models/haptic_giant/device.yaml         report in tune/report.md\n"
      "  hapticgiant tune device.yaml --vibration 0.03 --front    less vibration, and the trade\n"
      "  hapticgiant tune device.yaml --check                     the proof of what is there");
  command->add_option("device", arguments.device, "device.yaml")->capture_default_str();
  command->add_option("--out", arguments.out, "folder of the report")->capture_default_str();
  command
      ->add_option("--vibration", arguments.vibration,
                   "largest above 20 Hz, m/s^2; without: what the device has now")
      ->check(number_within(1e-4, 10.0));
  command->add_option("--mass", arguments.mass, "of the body that is rendered, kg")
      ->check(number_within(0.1, 100.0))
      ->capture_default_str();
  command->add_option("--damping", arguments.damping, "likewise, Ns/m")
      ->check(number_within(0.0, 1000.0))
      ->capture_default_str();
  command->add_option("--postures", arguments.postures, "in which it must hold")
      ->check(whole_number(1.0, 1000.0))
      ->capture_default_str();
  command->add_option("--seed", arguments.seed, "of the postures")
      ->check(whole_number(0.0, 4294967295.0))
      ->capture_default_str();
  CLI::Option* front =
      command->add_flag("--front", arguments.has_front, "also for less and for more vibration");
  command
      ->add_flag("--check", arguments.only_checks,
                 "figures and proof of what the device has now; searches and writes nothing")
      ->excludes(front);
  command->callback([&arguments, &exit_code] { exit_code = hg::apps::run_tune(arguments); });
}

// an empty text (a variable of a script that is not set) is no file, key or name
void refuse_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() > 0) {
      option->check(
          [](const std::string& text) { return text.empty() ? "must not be empty" : ""; });
    }
  }
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

// `exit_code` is that of the subcommand that the command line names, which runs at once
int parse(CLI::App& app, int argc, char** argv, const int& exit_code) {
  try {
    app.parse(argc, argv);
    return exit_code;
  } catch (const CLI::ParseError& error) {
    return explain(app, error);
  } catch (const hg::SetupError& error) {
    print_error("{}\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    print_error("internal error: {}\n", error.what());
    return kInternalError;
  }
}

}  // namespace

int main(int argc, char** argv) {
  hg::apps::open_standard_files();
  if (const std::string lack = hg::apps::provide_stack(); !lack.empty()) {
    print_error("{}\n", lack);
    return kBadInput;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file that must not grow is an error of that file

  CLI::App app("HapticGiant: feel the digital twin of any serial chain.", "hapticgiant");
  app.set_version_flag("--version", hg::apps::kVersion);
  app.require_subcommand(1);

  int exit_code = 0;
  hg::apps::RunArguments run;
  run.program = argv[0];
  hg::apps::DoctorArguments examined;
  hg::apps::ReplayArguments replayed;
  std::string explained;
  hg::apps::SimulateArguments simulate;
  hg::apps::StartTestArguments tested;
  hg::apps::CheckArguments check;
  hg::apps::NewArguments created;
  hg::apps::HqpSolveArguments hqp;
  hg::apps::IdentifyArguments identified;
  hg::apps::IdentifyFrictionArguments rubbed;
  hg::apps::ExperimentArguments measured;
  hg::apps::ContactArguments contact;
  hg::apps::InertialArguments inertial;
  hg::apps::SeedsArguments seeds;
  hg::apps::ExperimentsArguments experiments;
  hg::apps::BenchArguments compared;
  hg::apps::FaultsArguments broken;
  hg::apps::HaptifyArguments haptified;
  hg::apps::TuneArguments tuned;
  add_run(app, run, exit_code);
  add_doctor(app, examined, exit_code);
  add_replay(app, replayed, exit_code);
  add_explain(app, explained, exit_code);
  add_simulate(app, simulate, exit_code);
  add_start_test(app, tested, exit_code);
  add_check(app, check, exit_code);
  add_new(app, created, exit_code);
  add_hqp(app, hqp, exit_code);
  add_identify(app, identified, rubbed, exit_code);
  add_experiment(app, measured, contact, inertial, seeds, experiments, exit_code);
  hg::apps::add_plot_and_compare(app, experiments, exit_code);
  add_bench(app, compared, exit_code);
  add_faults(app, broken, exit_code);
  add_haptify(app, haptified, exit_code);
  add_tune(app, tuned, exit_code);
  refuse_empty_values(app);

  return hg::apps::code_after_output(parse(app, argc, argv, exit_code));
}
