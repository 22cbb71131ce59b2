#include "apps/hapticgiant/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "hg/core/error.h"
#include "hg/model/urdf.h"
#include "hg/page/page_scene.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"

namespace hg::apps {
namespace {

using viewer_server::Command;
using viewer_server::CommandName;

std::vector<double> values_of(const std::vector<config::FormField>& form) {
  std::vector<double> values;
  for (const config::FormField& field : form) values.push_back(field.value);
  return values;
}

// commands that a run follows whatever its device is
constexpr CommandName kAlways[] = {CommandName::kStop, CommandName::kSet, CommandName::kMode,
                                   CommandName::kEmergencyStop, CommandName::kReleaseStop};
// and those that need a simulated device, which waits and can be reset
constexpr CommandName kSimulated[] = {
    CommandName::kPause,   CommandName::kResume,   CommandName::kStep, CommandName::kSpeed,
    CommandName::kRestart, CommandName::kScenario, CommandName::kTwin, CommandName::kLaw,
    CommandName::kPerson,  CommandName::kPanel};

constexpr std::string_view kRunIsOver = "the run is over: start it again";
constexpr std::uint32_t kMostSamples = 10'000;  // in which a request must be seen

struct NamedRequest {
  std::string_view name;
  ModeRequest request;
};
constexpr NamedRequest kRequests[] = {{"arm", ModeRequest::kArm},
                                      {"run", ModeRequest::kRun},
                                      {"run_alone", ModeRequest::kAutonomous},
                                      {"reset", ModeRequest::kReset}};

std::string refusal_of_device(const PreparedRun& run) {
  if (run.remote == nullptr) return {};
  return "the device at " + run.arguments.device_address + " keeps its own time";
}

constexpr std::string_view kStopped = "a stop came after it";

bool is_choice_of_run(CommandName name) {
  return name == CommandName::kRestart || name == CommandName::kScenario ||
         name == CommandName::kTwin || name == CommandName::kLaw || name == CommandName::kPerson;
}

viewer_server::ServerOptions with(OperatorDesk* desk, viewer_server::ServerOptions options) {
  options.desk = desk;
  return options;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

RunPage::RunPage(const viewer_server::ServerOptions& options, const PreparedRun& first)
    : run_(&first),
      form_(config::twin_form(first.scenario.twin.model)),
      values_(values_of(form_)),
      server_(with(desk_.get(), options), scene_of(first)),
      newest_(std::make_unique<Sample>()) {}

viewer_server::Scene RunPage::scene_of(const PreparedRun& run) const {
  viewer_server::Scene scene = page::page_scene(run.scenario);
  scene.run = number_;
  scene.duration_s = scenario::planned_duration_s(run.scenario);
  scene.choices = page::page_choices(run.arguments.world);
  scene.choices.law = rendering::to_string(run.scenario.device.rendering.law);
  scene.settings = page::page_settings(form_);
  scene.commands.assign(std::begin(kAlways), std::end(kAlways));
  scene.refusal = refusal_of_device(run);
  if (scene.refusal.empty()) {
    scene.commands.insert(scene.commands.end(), std::begin(kSimulated), std::end(kSimulated));
  }
  return scene;
}

void RunPage::begin(const PreparedRun& run, const std::string& recording) {
  const bool is_first = !analysis_;
  if (!is_first) {
    run_ = &run;
    ++number_;
    form_ = config::twin_form(run.scenario.twin.model);
    values_ = values_of(form_);
    server_.set_scene(scene_of(run));
  }
  server_.set_values(values_);
  analysis_.emplace(run.scenario);
  names_ = scenario::part_names(run.scenario);
  view_ = {};
  view_.run = number_;
  view_.run_state.recording = recording;
  stop_was_asked_ = false;
  refuse_asked(kRunIsOver);
  has_news_ = false;
}

// The device's supervisor decides. If that sample was lost, the result is unknown.
void RunPage::answer_asked(const Sample& sample) {
  if (asked_.empty()) return;
  Asked& first = asked_.front();
  const ModeRequest request = sample.operator_input.request;
  first.is_next = first.is_next || request == ModeRequest::kNone;
  const bool is_seen = first.is_next && request == first.request;
  if (!is_seen && ++first.samples < kMostSamples) return;
  const Refusal refusal = sample.record.refusal;
  server_.answer(first.command, !is_seen ? "it is not known whether it was followed"
                                : refusal != Refusal::kNone ? to_string(refusal)
                                                            : std::string_view{});
  asked_.pop_front();
}

void RunPage::refuse_asked(std::string_view why) {
  for (const Asked& asked : asked_) server_.answer(asked.command, why);
  asked_.clear();
}

void RunPage::observe(const Sample& sample, const Note& note) {
  answer_asked(sample);
  view_.cycle_time_max_us = std::max(view_.cycle_time_max_us, sample.cycle_time_us);
  if (sample.record.change == ChangeStatus::kNone) return;
  const int field = config::field_of(form_, sample.operator_input.change);
  if (field < 0) return;
  const auto index = static_cast<std::size_t>(field);
  if (sample.record.change == ChangeStatus::kRefused) {
    note("refused", form_[index].name + " stays as it is");
  } else {
    values_[index] = sample.operator_input.change.value;
  }
  server_.set_values(values_);
}

void RunPage::show(const Sample& sample) {
  *newest_ = sample;
  has_news_ = true;
  if (server_.is_due()) publish();
}

void RunPage::publish() {
  view_.record = newest_->record;
  view_.hand = newest_->operator_input.hand_target;
  view_.cycle_time_us = newest_->cycle_time_us;
  view_.status_text = run_->scenario.description;
  view_.budget = analysis_->budget(newest_->record);
  view_.singularity = analysis_->singularity(newest_->record);
  view_.run_state.position_s = newest_->record.time_s;
  view_.safety = page::safety_view(*newest_, names_);
  server_.publish(view_);
  view_.cycle_time_max_us = 0.0;
  has_news_ = false;
}

void RunPage::follow(runtime::Runtime* runtime, const Note& note) {
  HandTarget target;
  if (server_.take_hand_target(target) && runtime != nullptr) runtime->set_hand_target(target);
  for (const Command& command : server_.take_commands()) {
    has_news_ = true;
    if (command.is_done) {
      tell_done(command, note);
      continue;
    }
    const std::string why_not = obey(command, runtime, note);
    const bool is_asked = command.name == CommandName::kMode || is_choice_of_run(command.name);
    if (!is_asked || !why_not.empty()) server_.answer(command, why_not);
  }
  while (!asked_.empty() && asked_.front().command.stops != desk_->stops()) {
    server_.answer(asked_.front().command, kStopped);
    asked_.pop_front();
  }
  if (runtime == nullptr) refuse_asked(kRunIsOver);
  take_prepared(note);
  drop_overtaken(note);
  const std::uint32_t lost = desk_->take_lost();
  if ((lost & 1u) != 0) note("operator_enable", "let go: its page is gone or silent");
  if ((lost & 2u) != 0) note("override_key", "turned off: its page is gone or silent");
  viewer_server::RunState& state = view_.run_state;
  const bool is_paused = runtime != nullptr && runtime->pace().is_paused();
  const double speed = runtime != nullptr ? runtime->pace().speed() : state.speed;
  const bool is_over = runtime == nullptr;
  has_news_ =
      has_news_ || is_paused != state.is_paused || speed != state.speed || is_over != state.is_over;
  state.is_paused = is_paused;
  state.speed = speed;
  state.is_over = is_over;
  if (has_news_ && server_.is_due()) publish();
}

void RunPage::tell_done(const Command& command, const Note& note) const {
  const std::string page = fmt::format("page {}", command.page);
  const std::string_view on_off = command.value != 0.0 ? "on" : "off";
  switch (command.name) {
    case CommandName::kEmergencyStop:
      return note("emergency_stop", "pressed by " + page);
    case CommandName::kReleaseStop:
      return note("release_stop",
                  fmt::format("of {} by {}",
                              command.value == 0.0 ? std::string("the script")
                                                   : fmt::format("page {}", command.value),
                              page));
    case CommandName::kPanel:
      return note(command.argument, fmt::format("{} by {}", on_off, page));
    default:
      return note(command.argument, "asked for in the page");
  }
}

// reason for a refusal; empty = executed, or another run is being prepared
std::string RunPage::obey(const Command& command, runtime::Runtime* runtime, const Note& note) {
  const std::string refusal = refusal_of_device(*run_);
  const bool needs_simulation =
      std::find(std::begin(kSimulated), std::end(kSimulated), command.name) != std::end(kSimulated);
  if (needs_simulation && !refusal.empty()) return refusal;
  if (is_choice_of_run(command.name)) return choose(command);
  if (command.name == CommandName::kSeek) return "this is a run, not a recording";
  if (runtime == nullptr) return std::string(kRunIsOver);
  if (command.name == CommandName::kSet) return set(command, *runtime, note);
  if (command.name == CommandName::kMode) return obey_mode(command, *runtime, note);
  if (command.name == CommandName::kStop) {
    runtime->request_stop();
    stop_was_asked_ = true;
    next_.reset();  // discards the previous choice
    note("stop", "asked for in the page");
    return {};
  }
  return obey_pace(command, runtime->pace(), note);
}

std::string RunPage::obey_mode(const Command& command, runtime::Runtime& runtime,
                               const Note& note) {
  const auto named = std::find_if(std::begin(kRequests), std::end(kRequests),
                                  [&](const auto& r) { return r.name == command.argument; });
  if (named == std::end(kRequests)) return "there is no such mode: " + command.argument;
  if (command.stops != desk_->stops()) return std::string(kStopped);
  // one button resets the safety controller as well, and first
  if (named->request == ModeRequest::kReset) runtime.press_reset();
  const bool is_taken = runtime.request(ModeRequest::kNone, command.stops) &&
                        runtime.request(ModeRequest::kNone, command.stops) &&
                        runtime.request(named->request, command.stops);
  if (!is_taken) return "too many commands are waiting";
  note(command.argument, "asked for in the page");
  asked_.push_back({command, named->request});
  return {};
}

std::string RunPage::obey_pace(const Command& command, runtime::Pace& pace, const Note& note) {
  switch (command.name) {
    case CommandName::kPause:
      pace.pause();
      note("pause", "simulated time stands still");
      return {};
    case CommandName::kResume:
      pace.resume();
      note("resume", "simulated time goes on");
      return {};
    case CommandName::kStep:
      if (!pace.step(command.value)) {
        return fmt::format("a step is 1 .. {} cycles of a paused run", runtime::Pace::kMostSteps);
      }
      note("step", fmt::format("{} cycles", command.value));
      return {};
    default:
      if (!pace.set_speed(command.value)) {
        return fmt::format("the speed must be {} .. 1", runtime::Pace::kSlowest);
      }
      note("speed", fmt::format("{} of real time", command.value));
      return {};
  }
}

// prepares the next run; the present one continues meanwhile, and also if that fails
std::string RunPage::choose(const Command& command) {
  if (is_preparing()) return "another run is being prepared";
  RunArguments arguments = run_->arguments;
  const viewer_server::Choices choices = page::page_choices(arguments.world);
  const auto take = [&](const std::vector<viewer_server::Choice>& list, std::string& value) {
    if (!page::is_choice(list, command.argument)) return false;
    value = command.argument;
    return true;
  };
  scenario::ScenarioOptions& world = arguments.world;
  bool is_known = true;
  if (command.name == CommandName::kScenario) {
    is_known = take(choices.scenarios, world.scenario);
    world.twin.clear();
  }
  if (command.name == CommandName::kTwin) is_known = take(choices.twins, world.twin);
  const bool is_other_twin =
      command.name == CommandName::kScenario || command.name == CommandName::kTwin;
  // a script is made for one twin
  if (is_other_twin && world.user != "mouse" && world.user != "none") world.user.clear();
  if (command.name == CommandName::kLaw) is_known = take(choices.laws, arguments.world.law);
  if (command.name == CommandName::kPerson) is_known = take(choices.people, world.user);
  if (!is_known) return "there is no such choice: " + command.argument;
  chosen_ = command;
  prepared_ = std::async(std::launch::async, [arguments]() -> Prepared {
    try {
      return {std::make_unique<PreparedRun>(arguments), {}};
    } catch (const SetupError& error) {
      return {nullptr, first_line(error.what())};
    }
  });
  return {};
}

void RunPage::take_prepared(const Note& note) {
  if (!is_preparing() || prepared_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  auto [run, refusal] = prepared_.get();
  if (refusal.empty() && chosen_.stops != desk_->stops()) refusal = kStopped;
  if (refusal.empty()) {
    next_ = std::move(run);
    note("restart", chosen_.argument.empty() ? "again" : chosen_.argument);
  }
  server_.answer(chosen_, refusal);
}

// A stop that came after a run was chosen is one for that run as well.
void RunPage::drop_overtaken(const Note& note) {
  if (!next_ || chosen_.stops == desk_->stops()) return;
  next_.reset();
  stop_was_asked_ = true;
  note("restart", "left out: a stop came after it");
}

std::unique_ptr<PreparedRun> RunPage::take_next() {
  if (chosen_.stops != desk_->stops()) next_.reset();
  return std::move(next_);
}

std::string RunPage::set(const Command& command, runtime::Runtime& runtime, const Note& note) {
  const auto field = std::find_if(
      form_.begin(), form_.end(),
      [&](const config::FormField& candidate) { return candidate.name == command.argument; });
  if (field == form_.end()) return "there is no such setting: " + command.argument;
  const auto index = static_cast<int>(field - form_.begin());
  std::string why_not = config::refusal(form_, index, command.value, values_);
  if (!why_not.empty()) return why_not;
  for (ParameterChange change : field->changes) {
    change.value = command.value;
    if (!runtime.change(change)) return "too many changes are waiting";
  }
  note("set", fmt::format("{} = {} {}", field->name, model::to_text(command.value), field->unit));
  return {};
}

}  // namespace hg::apps
