#include <fmt/format.h>

#include <memory>
#include <string>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/hapticgiant/machine_options.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/core/error.h"
#include "hg/scenario/run/plan_options.h"
#include "hg/viewer_server/access.h"

namespace hg::apps {
namespace {

std::string web_origin(const std::string& text) {
  if (viewer_server::is_web_origin(text)) return "";
  return fmt::format("expected the origin of a page, as {}, got '{}'",
                     viewer_server::kOriginExample, text);
}

void add_machine_address(Command command, scenario::MachineAddress& machine) {
  command.add_option("--device-address", machine.address, address_help(false));
  command
      .add_option("--machine", machine.machine_file,
                  "machine.yaml of a bus; default: the one beside the device file")
      .needs("--device-address");
  command
      .add_flag("--move-to-start", machine.moves_to_start,
                "the device first moves, slowly, to where the twin starts: with no hand "
                "at the handle and the override key on; keep its way clear")
      .needs("--device-address");
  command
      .add_option("--key-file", machine.key_file,
                  "secret that the remote device has, too (docs/reference/device_protocol.md)")
      .needs("--device-address");
  command
      .add_flag("--without-start-test", machine.without_start_test,
                "drive a machine whose brakes and stop inputs were not tested today")
      .needs("--device-address");
  command
      .add_option("--despite", machine.despite,
                  "items of the doctor that are bad about this computer and are to be let pass, "
                  "as NAME,NAME")
      .delimiter(',')
      .allow_extra_args(false)
      .needs("--device-address");
  command
      .add_option("--posture-confirmed", machine.confirmed_joints,
                  "joints of a machine that do stand elsewhere than the last run has left them, "
                  "as NAME,NAME")
      .delimiter(',')
      .allow_extra_args(false)
      .needs("--device-address");
}

void add_duration(Command command, scenario::RunTiming& timing) {
  command
      .add_option("--duration", timing.duration_s,
                  "seconds; default: until the script has played, with a page at a terminal until "
                  "Ctrl-C")
      .check(number_that(scenario::kDurationRule));
  command.add_flag("--fast", timing.is_fast,
                   "as fast as it can instead of in real time; without the page");
}

void add_page(Command command, scenario::RunPageOptions& page) {
  command.add_flag("!--no-viewer", page.is_served, "without the page");
  command
      .add_option("--bind", page.address,
                  "IP address that the page is served at; 0.0.0.0: all of this machine")
      .excludes("--fast")
      .excludes("--no-viewer")
      .transform(without_brackets)
      .capture_default_str();
  command.add_option("--port", page.port, "port of the page; default: any free one")
      .excludes("--fast")
      .excludes("--no-viewer")
      .check(number_that(scenario::kPortRule));
  command
      .add_option("--token-file", page.token_file,
                  "file that keeps the secret of the link, made if missing: with --port the link "
                  "stays the same when the program starts again")
      .excludes("--fast")
      .excludes("--no-viewer");
  command
      .add_option("--embedded-in", page.embedders,
                  "the run is a trial of a study: pages of this origin, as "
                  "http://127.0.0.1:8123, may show its page inside themselves, and pages change "
                  "nothing about it; may be given several times")
      .allow_extra_args(false)
      .excludes("--fast")
      .excludes("--no-viewer")
      .check(web_origin);
  command.add_flag("!--no-browser", page.opens_browser, "print the link only");
}

void add_records(Command command, scenario::RunRecords& records) {
  command
      .add_flag("--lsl", records.has_lab_streams,
                "send samples and events to the Lab Streaming Layer "
                "(docs/start/lab_streaming_layer.md)")
      .excludes("--fast");
  command.add_option("--recordings", records.folder, "folder of the recordings")
      .capture_default_str();
  command.add_flag("!--no-recording", records.has_recording, "without a recording");
  command
      .add_option("--flight-recorder", records.flight_recorder,
                  "when the last 10 s are written to a file of their own: fault, always or off")
      .one_of({"fault", "always", "off"})
      .capture_default_str();
  command
      .add_option(
          "--slow-solve", records.slow_solve,
          "keep problems of the solver that take this many active sets, beside the recording")
      .check(number_that(scenario::kSlowSolveRule))
      .capture_default_str();
}

void add_thread(Command command, scenario::RunTiming& timing) {
  command
      .add_option("--priority", timing.priority,
                  "SCHED_FIFO priority of the control thread, 1..99; 0: an ordinary thread")
      .check(number_that(scenario::kPriorityRule))
      .capture_default_str();
  command.add_option("--cpu", timing.cpu, "the only processor of the control thread; default: any")
      .check(number_that(scenario::kCpuRule));
}

void add_protocol(Command command, RunArguments& arguments) {
  command.add_option("--request", arguments.request,
                     "JSON file with all options of the run, or - for standard input "
                     "(docs/reference/run_protocol.md)");
  command.add_option("--report-to", arguments.report_to,
                     "open descriptor, from 3 on, to write to, line by line as JSON, what happens "
                     "(docs/reference/run_protocol.md)");
}

// A request has all options that make a plan.
void refuse_options_beside_request(Command command) {
  for (const std::string& name : command.given_options()) {
    if (name == "--request" || name == "--report-to" || name == "--summary") continue;
    throw SetupError(fmt::format("{}: --request has all options of the run, leave it out", name));
  }
}

}  // namespace

void add_run(Command app, const std::string& program, int& exit_code) {
  const auto arguments = std::make_shared<RunArguments>();
  arguments->program = program;
  scenario::RunPlan& plan = arguments->plan;
  const Command command =
      app.add_subcommand("run", "A person at the device feels the twin (the main job).");
  command.footer(
      "Examples:\n"
      "  hapticgiant run                          the door, scripted hand, page in the browser\n"
      "  hapticgiant run fr3/open_drawer          one of those of run --list\n"
      "  hapticgiant run excavator --fast --summary out.json\n"
      "  hapticgiant run door --user mouse        drag the handle in the page");
  command.add_flag("--list", arguments->is_list,
                   "list the scenarios, devices and twins that are ready, and run nothing");
  add_scenario_options(command, plan.world);
  add_machine_address(command, plan.machine);
  add_duration(command, plan.timing);
  add_law_option(command, plan.world.law);
  command.add_option("--summary", arguments->summary,
                     "write the closing summary as JSON to this file");
  add_page(command, plan.page);
  add_records(command, plan.records);
  add_thread(command, plan.timing);
  add_protocol(command, *arguments);
  command.callback([arguments, command, &exit_code] {
    if (!arguments->request.empty()) refuse_options_beside_request(command);
    exit_code = run(*arguments);
  });
}

}  // namespace hg::apps
