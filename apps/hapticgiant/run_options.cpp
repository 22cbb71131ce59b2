#include <fmt/format.h>

#include <memory>
#include <string>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/hapticgiant/run_command.h"
#include "apps/hapticgiant/scenario_options.h"
#include "hg/viewer_server/access.h"

namespace hg::apps {
namespace {

std::string web_origin(const std::string& text) {
  if (viewer_server::is_web_origin(text)) return "";
  return fmt::format("expected the origin of a page, as {}, got '{}'",
                     viewer_server::kOriginExample, text);
}

}  // namespace

void add_run(Command app, const std::string& program, int& exit_code) {
  const auto arguments = std::make_shared<RunArguments>();
  arguments->program = program;
  const Command command =
      app.add_subcommand("run", "A person at the device feels the twin (the main job).");
  command.footer(
      "Examples:\n"
      "  hapticgiant run                          the door, scripted hand, page in the browser\n"
      "  hapticgiant run excavator --fast --summary out.json\n"
      "  hapticgiant run door --user mouse        drag the handle in the page");
  add_scenario_options(command, arguments->world);
  command.add_option(
      "--device-address", arguments->device_address,
      "HOST:PORT of a remote device (hapticgiant simulate) instead of a simulated one, "
      "franka://HOST of a Franka FR3 (docs/start/franka.md), or ethercat://INTERFACE of a machine "
      "on a bus (docs/reference/ethercat.md)");
  command
      .add_option("--machine", arguments->machine,
                  "machine.yaml of a bus; default: the one beside the device file")
      .needs("--device-address");
  command
      .add_flag("--move-to-start", arguments->moves_to_start,
                "the device first moves by itself, slowly, to where the twin starts: with nobody "
                "at the handle and the override key on; keep its way clear")
      .needs("--device-address");
  command
      .add_option("--key-file", arguments->key_file,
                  "secret that the remote device has, too (docs/reference/device_protocol.md)")
      .needs("--device-address");
  command
      .add_flag("--without-start-test", arguments->without_start_test,
                "drive a machine whose brakes and stop inputs were not tested today")
      .needs("--device-address");
  command
      .add_option("--despite", arguments->despite,
                  "items of the doctor that are bad about this computer and are to be let pass, "
                  "as NAME,NAME")
      .delimiter(',')
      .allow_extra_args(false)
      .needs("--device-address");
  command
      .add_option("--posture-confirmed", arguments->confirmed_joints,
                  "joints of a machine that do stand elsewhere than the last run has left them, "
                  "as NAME,NAME")
      .delimiter(',')
      .allow_extra_args(false)
      .needs("--device-address");
  command
      .add_option("--duration", arguments->duration_s,
                  "seconds; default: until the script has played, with a page at a terminal until "
                  "Ctrl-C")
      .check(number_that("more than 0", [](double value) { return value > 0.0; }));
  const Option fast = command.add_flag(
      "--fast", arguments->is_fast, "as fast as it can instead of in real time; without the page");
  add_law_option(command, arguments->world.law);
  command.add_option("--summary", arguments->summary,
                     "write the closing summary as JSON to this file");
  const Option no_viewer =
      command.add_flag("!--no-viewer", arguments->has_viewer, "without the page");
  command
      .add_option("--bind", arguments->address,
                  "IP address that the page is served at; 0.0.0.0: all of this machine")
      .excludes(fast)
      .excludes(no_viewer)
      .transform(without_brackets)
      .capture_default_str();
  command.add_option("--port", arguments->port, "port of the page; default: any free one")
      .excludes(fast)
      .excludes(no_viewer)
      .check(whole_number(0.0, 65535.0));
  command
      .add_option("--embedded-in", arguments->embedders,
                  "the run is a trial of a study: pages of this origin, as "
                  "http://127.0.0.1:8123, may show its page inside themselves, and pages change "
                  "nothing about it; may be given several times")
      .allow_extra_args(false)
      .excludes(fast)
      .excludes(no_viewer)
      .check(web_origin);
  command.add_flag("!--no-browser", arguments->opens_browser, "print the link only");
  command
      .add_flag("--lsl", arguments->has_lab_streams,
                "send samples and events to the Lab Streaming Layer "
                "(docs/start/lab_streaming_layer.md)")
      .excludes(fast);
  command.add_option("--recordings", arguments->recordings, "folder of the recordings")
      .capture_default_str();
  command.add_flag("!--no-recording", arguments->has_recording, "without a recording");
  command
      .add_option("--flight-recorder", arguments->flight_recorder,
                  "when the last 10 s are written to a file of their own: fault, always or off")
      .one_of({"fault", "always", "off"})
      .capture_default_str();
  command
      .add_option(
          "--slow-solve", arguments->slow_solve,
          "keep problems of the solver that take this many active sets, beside the recording")
      .check(at_least(1))
      .capture_default_str();
  command
      .add_option("--priority", arguments->priority,
                  "SCHED_FIFO priority of the control thread, 1..99; 0: an ordinary thread")
      .check(number_that("from 0 to 99", [](double v) { return v >= 0.0 && v <= 99.0; }))
      .capture_default_str();
  command
      .add_option("--cpu", arguments->cpu, "the only processor of the control thread; default: any")
      .check(at_least(0));
  command.callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace hg::apps
