#include "apps/hapticgiant/replay_command.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/option_checks.h"
#include "apps/command_line/output.h"
#include "apps/hapticgiant/interruption.h"
#include "apps/hapticgiant/open_page.h"
#include "apps/hapticgiant/rerun.h"
#include "hg/live/link_file.h"
#include "hg/page/recording_page.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::apps {
namespace {

constexpr std::chrono::milliseconds kIdle(4);

void print_content(const page::RecordingPage& show) {
  print_out(fmt::format("{}\n{}\n", show.scenario().title, show.scenario().description));
  print_out("duration    {:.3f} s\n{}", show.run().duration_s(),
            recording::to_text(show.run().losses()));
  for (const recording::Event& event : show.run().events()) {
    print_out(fmt::format("{:8.3f} s  {:<18} {}\n", event.time_s, event.name, event.text));
  }
}

void play(page::RecordingPage& show, viewer_server::ViewerServer& server,
          const std::atomic<bool>& interrupted) {
  using Clock = std::chrono::steady_clock;
  for (const recording::Event& event : show.run().events()) {
    server.announce_event(event.time_s, event.name, event.text);
  }
  for (live::Message& message : show.live_descriptions()) server.latch_live(std::move(message));
  for (auto last = Clock::now(); !interrupted.load(); std::this_thread::sleep_for(kIdle)) {
    for (const viewer_server::Command& command : server.take_commands()) {
      server.answer(command, show.obey(command));
    }
    const auto now = Clock::now();
    show.advance(std::chrono::duration<double>(now - std::exchange(last, now)).count());
    if (server.is_due()) server.publish(show.view());
    if (!server.has_live_clients()) {
      show.forget_live();
      continue;
    }
    live::Batch batch = show.live_batch(server.live_wanted());
    if (!batch.messages.empty()) server.publish_live(std::move(batch));
  }
}

// whether the cycle still gives what it gave
int run_again(const std::string& file) {
  const Rerun result = rerun(file);
  print_out(result.is_same
                ? fmt::format("run again   {} cycles, the same bit for bit\n", result.cycles)
                : fmt::format("run again   {}\n            {} cycles are the same\n", result.text,
                              result.cycles));
  return result.is_same ? 0 : 1;
}

}  // namespace

int replay(const ReplayArguments& arguments) {
  page::RecordingPage show(arguments.file, arguments.compare, arguments.speed);
  if (!arguments.has_view) {
    print_content(show);
    return run_again(arguments.file);
  }
  const std::atomic<bool>& interrupted = watch_interruption();
  const BackgroundOutput output(interrupted);
  print_content(show);
  viewer_server::ServerOptions options;
  options.page = find_page();
  if (options.page.empty()) return 0;
  options.address = arguments.address;
  options.port = arguments.port;
  viewer_server::ViewerServer server(options, show.scene());
  present_page(server.url(), arguments.address, arguments.opens_browser);
  const live::LinkFile link(live::live_address(server.url()));  // by which bridges find it
  if (!link.problem().empty()) print_out("note        bridges need --live: {}\n", link.problem());
  print_out("stop        Ctrl-C\n");
  play(show, server, interrupted);
  return 0;
}

void add_replay(Command app, int& exit_code) {
  const auto arguments = std::make_shared<ReplayArguments>();
  const Command command = app.add_subcommand(
      "replay", "Runs the cycle of a recording again, bit for bit; or look at it again.");
  command.footer(
      "Examples:\n"
      "  hapticgiant replay recordings/latest.mcap        does the cycle still give the same?\n"
      "  hapticgiant replay recordings/latest.mcap --view\n"
      "  hapticgiant replay one.mcap --compare two.mcap --view --speed 0.5");
  command.add_option("file", arguments->file, "recording of hapticgiant run")
      .required()
      .existing_file();
  const Option view = command.add_flag("--view", arguments->has_view,
                                       "in the page, with play, pause and scrubbing");
  command.add_option("--compare", arguments->compare, "a second recording, shown through the first")
      .needs(view)
      .existing_file();
  command.add_option("--speed", arguments->speed, "recorded seconds per second, 0.1..8")
      .needs(view)
      .check(number_that("from 0.1 to 8", [](double v) { return v >= 0.1 && v <= 8.0; }));
  command.add_option("--bind", arguments->address, "as in run")
      .needs(view)
      .transform(without_brackets)
      .capture_default_str();
  command.add_option("--port", arguments->port, "as in run")
      .needs(view)
      .check(whole_number(0.0, 65535.0));
  command.add_flag("!--no-browser", arguments->opens_browser, "as in run");
  command.callback([arguments, &exit_code] { exit_code = replay(*arguments); });
}

}  // namespace hg::apps
