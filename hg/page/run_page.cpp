#include "hg/page/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "hg/config/law_names.h"
#include "hg/core/error.h"
#include "hg/core/text.h"
#include "hg/page/page_scene.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"
#include "hg/scenario/recorded/robot_models.h"
#include "hg/scenario/start_posture.h"

namespace hg::page {
namespace {

using scenario::ScenarioOptions;
using viewer_server::Choice;
using viewer_server::Choices;
using viewer_server::Command;
using viewer_server::CommandName;

// What may change while a run of the scenario lasts.
std::vector<config::FormField> form_of(const config::Scenario& scenario) {
  std::vector<config::FormField> form = config::twin_form(scenario.twin.model);
  const auto& teleoperation = scenario.teleoperation;
  if (teleoperation && teleoperation->mapping != teleoperation::Mapping::kJoints) {
    config::add_remote_scales(teleoperation->motion_scale, teleoperation->force_scale, form);
  }
  return form;
}

std::vector<double> values_of(const std::vector<config::FormField>& form) {
  std::vector<double> values;
  for (const config::FormField& field : form) values.push_back(field.value);
  return values;
}

constexpr std::string_view kRunIsOver = "the run is over: start it again";
constexpr std::string_view kStopped = "a stop came after it";
constexpr std::uint32_t kMostSamples = 10'000;  // in which a request must be seen
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();  // equal to no wrench

struct NamedRequest {
  std::string_view name;
  ModeRequest request;
};
constexpr NamedRequest kRequests[] = {{"tare", ModeRequest::kTare},
                                      {"arm", ModeRequest::kArm},
                                      {"run", ModeRequest::kRun},
                                      {"run_alone", ModeRequest::kAutonomous},
                                      {"reset", ModeRequest::kReset}};

/// What a page may choose for the next run: from which list, and which option it replaces.
struct Chooser {
  CommandName command;
  std::vector<Choice> Choices::*list;
  std::string ScenarioOptions::*option;
};
constexpr Chooser kChoosers[] = {
    {CommandName::kScenario, &Choices::scenarios, &ScenarioOptions::scenario},
    {CommandName::kTwin, &Choices::twins, &ScenarioOptions::twin},
    {CommandName::kDevice, &Choices::devices, &ScenarioOptions::device},
    {CommandName::kSurfaces, &Choices::surface_sets, &ScenarioOptions::surfaces},
    {CommandName::kLaw, &Choices::laws, &ScenarioOptions::law},
    {CommandName::kPerson, &Choices::people, &ScenarioOptions::user}};

viewer_server::ServerOptions with(OperatorDesk* desk, viewer_server::ServerOptions options) {
  options.desk = desk;
  return options;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// What follows from the choice of another part: another scenario is played as it stands, the one
/// that the program was started with as it was given; and a script is made for one twin.
void settle_choice(CommandName chosen, const ScenarioOptions& given, ScenarioOptions& options) {
  const bool is_scenario = chosen == CommandName::kScenario;
  const bool is_given = is_scenario && options.scenario == given.scenario;
  if (is_scenario) {
    options.twin = is_given ? given.twin : "";
    options.device = is_given ? given.device : "";
    options.surfaces = is_given ? given.surfaces : "";
  }
  const bool has_script = options.user != "mouse" && options.user != "none";
  if (has_script && (is_scenario || chosen == CommandName::kTwin)) {
    options.user = is_given ? given.user : "";
  }
}

std::string text_of_done(const Command& command) {
  const std::string page = fmt::format("page {}", command.page);
  switch (command.name) {
    case CommandName::kEmergencyStop:
      return "pressed by " + page;
    case CommandName::kReleaseStop:
      return fmt::format(
          "of {} by {}",
          command.value == 0.0 ? "the script" : fmt::format("page {}", command.value), page);
    case CommandName::kPanel:
      return fmt::format("{} by {}", command.value != 0.0 ? "on" : "off", page);
    case CommandName::kClutch:
      return fmt::format("{} by {}", command.value != 0.0 ? "opened" : "closed", page);
    default:
      return "requested in the page";
  }
}

std::string_view name_of_done(const Command& command) {
  if (command.name == CommandName::kEmergencyStop) return "emergency_stop";
  if (command.name == CommandName::kClutch) return "clutch";
  return command.name == CommandName::kReleaseStop ? "release_stop"
                                                   : std::string_view(command.argument);
}

}  // namespace

struct RunPage::Order {
  CommandName name;
  bool needs_simulation;  ///< the device has to wait, to start again, or to have a hand of ours
  bool changes_run;       ///< a trial would no longer be what was planned
  /// How it is executed; nullptr = by the server, at the operator's desk
  std::string (RunPage::*obey)(const Command&, runtime::Runtime*, const Note&);

  bool is_choice() const { return obey == &RunPage::choose; }
};

std::span<const RunPage::Order> RunPage::orders() {
  static constexpr Order kOrders[] = {{CommandName::kStop, false, false, &RunPage::stop},
                                      {CommandName::kSet, false, true, &RunPage::set},
                                      {CommandName::kMode, false, false, &RunPage::request_mode},
                                      {CommandName::kMark, false, false, &RunPage::mark},
                                      {CommandName::kEmergencyStop, false, false, nullptr},
                                      {CommandName::kReleaseStop, false, false, nullptr},
                                      {CommandName::kAskForHand, true, true, nullptr},
                                      {CommandName::kClutch, false, false, nullptr},
                                      {CommandName::kPause, true, true, &RunPage::set_pace},
                                      {CommandName::kResume, true, true, &RunPage::set_pace},
                                      {CommandName::kStep, true, true, &RunPage::set_pace},
                                      {CommandName::kSpeed, true, true, &RunPage::set_pace},
                                      {CommandName::kRestart, true, true, &RunPage::choose},
                                      {CommandName::kScenario, true, true, &RunPage::choose},
                                      {CommandName::kTwin, true, true, &RunPage::choose},
                                      {CommandName::kDevice, true, true, &RunPage::choose},
                                      {CommandName::kSurfaces, true, true, &RunPage::choose},
                                      {CommandName::kLaw, true, true, &RunPage::choose},
                                      {CommandName::kPerson, true, true, &RunPage::choose},
                                      {CommandName::kPanel, true, false, nullptr}};
  return kOrders;
}

RunPage::RunPage(const viewer_server::ServerOptions& options, const ShownRun& first,
                 Prepare prepare)
    : run_(first),
      given_(*first.options),
      prepare_(std::move(prepare)),
      form_(form_of(*first.scenario)),
      values_(values_of(form_)),
      server_(with(desk_.get(), options), scene_of(first)),
      newest_(std::make_unique<Sample>()) {}

viewer_server::Scene RunPage::scene_of(const ShownRun& run) {
  viewer_server::Scene scene = page_scene(*run.scenario);
  scene.run = number_;
  scene.duration_s = scenario::planned_duration_s(*run.scenario);
  choices_ = page_choices(*run.options, given_);
  scene.choices = choices_;
  scene.choices.law = config::preset_name(run.scenario->device.rendering);
  scene.settings = page_settings(form_);
  scene.refusal = run.fixed_by.empty() ? run.refusal : run.fixed_by;
  for (const Order& order : orders()) {
    if (refusal_of(order, run).empty()) scene.commands.push_back(order.name);
  }
  return scene;
}

// Why `run` does not take this command; empty = it does.
std::string RunPage::refusal_of(const Order& order, const ShownRun& run) {
  const bool has_clutch = run.scenario->teleoperation.has_value();
  if (order.name == CommandName::kClutch && !has_clutch) return "there is no remote machine";
  if (order.changes_run && !run.fixed_by.empty()) return run.fixed_by;
  return order.needs_simulation ? run.refusal : std::string();
}

void RunPage::begin(const ShownRun& run, const std::string& recording,
                    std::chrono::system_clock::time_point start) {
  const bool is_first = !analysis_;
  run_ = run;
  if (!is_first) {
    ++number_;
    form_ = form_of(*run.scenario);
    values_ = values_of(form_);
    server_.set_scene(scene_of(run));
  }
  server_.set_values(values_);
  has_new_values_ = false;
  analysis_.emplace(*run.scenario);
  names_ = scenario::part_names(*run.scenario);
  view_ = {};
  view_.run = number_;
  view_.run_state.recording = recording;
  stop_was_asked_ = false;
  refuse_asked(kRunIsOver);
  has_news_ = false;
  begin_live(start);
}

void RunPage::begin_live(std::chrono::system_clock::time_point start) {
  const config::Scenario& scenario = *run_.scenario;
  live_.emplace(scenario::run_names(scenario), scenario::link_tree(scenario),
                scenario.device.model.rate_Hz, start);
  marks_ = 0;
  wrench_client_ = 0;
  next_wrench_.reset();
  sent_wrench_.setConstant(kUnknown);
  server_.latch_live(
      live_->description(live::Topic::kDeviceDescription, scenario::device_description(scenario)));
  server_.latch_live(
      live_->description(live::Topic::kTwinDescription, scenario::twin_description(scenario)));
}

void RunPage::announce(double time_s, std::string_view name, std::string_view text) {
  server_.announce_event(time_s, name, text);
  if (live_) server_.publish_live({.time_ns = 0, .messages = {live_->event(time_s, name, text)}});
}

void RunPage::publish_live(const Sample& sample) {
  if (!live_ || !live_->observe(sample) || !server_.has_live_clients()) return;
  server_.publish_live(live_->batch(sample, server_.live_wanted()));
}

// The device's supervisor decides. If that sample was lost, the result is unknown.
void RunPage::answer_asked(const Sample& sample) {
  if (asked_.empty()) return;
  Asked& first = asked_.front();
  const ModeRequest request = sample.operator_input.request;
  first.is_next = first.is_next || request == ModeRequest::kNone;
  const bool is_now = !first.is_seen && first.is_next && request == first.request;
  first.is_seen = first.is_seen || is_now;
  const bool is_lost = ++first.samples >= kMostSamples;
  const bool is_tare = first.request == ModeRequest::kTare;
  const TareStatus tare = sample.record.tare;
  const Refusal refusal = is_now ? sample.record.refusal : Refusal::kNone;
  if (!is_lost && (!first.is_seen || (is_tare && tare == TareStatus::kUnderWay))) return;
  std::string_view why_not;
  if (is_lost) {
    why_not = "it is not known whether it was followed";
  } else if (refusal != Refusal::kNone) {
    why_not = to_string(refusal);
  } else if (is_tare && tare != TareStatus::kDone) {
    why_not = to_string(tare);
  }
  server_.answer(first.command, why_not);
  asked_.pop_front();
}

void RunPage::refuse_asked(std::string_view why) {
  for (const Asked& asked : asked_) server_.answer(asked.command, why);
  asked_.clear();
}

void RunPage::observe(const Sample& sample, const Note& note) {
  answer_asked(sample);
  publish_live(sample);
  view_.cycle_time_max_us = std::max(view_.cycle_time_max_us, sample.cycle_time_us);
  if (sample.record.change == ChangeStatus::kNone) return;
  const int field = config::field_of(form_, sample.operator_input.change);
  if (field < 0) return;
  if (sample.record.change == ChangeStatus::kRefused) {
    forget_sent(form_[field]);
    note("refused", form_[field].name + " stays as it is");
  } else {
    values_[field] = sample.operator_input.change.value;
  }
  has_new_values_ = true;
}

void RunPage::show(const Sample& sample) {
  *newest_ = sample;
  has_news_ = true;
  if (server_.is_due()) publish();
}

void RunPage::publish() {
  view_.record = newest_->record;
  view_.twin_base = newest_->operator_input.twin_base;
  view_.hand = newest_->operator_input.hand_target;
  view_.cycle_time_us = newest_->cycle_time_us;
  view_.status_text = run_.scenario->description;
  view_.budget = analysis_->budget(newest_->record);
  view_.singularity = analysis_->singularity(newest_->record);
  view_.run_state.position_s = newest_->record.time_s;
  view_.safety = safety_view(*newest_, names_);
  view_.teleoperation = teleoperation_view(*run_.scenario, *newest_);
  server_.publish(view_);
  view_.cycle_time_max_us = 0.0;
  has_news_ = false;
}

void RunPage::follow(runtime::Runtime* runtime, const Note& note) {
  HandTarget target;
  if (server_.take_hand_target(target)) next_target_ = target;
  if (next_target_ && (runtime == nullptr || runtime->set_hand_target(*next_target_))) {
    next_target_.reset();
  }
  take_reference_wrench(runtime, note);
  for (const Command& command : server_.take_commands()) take(command, runtime, note);
  while (!asked_.empty() && asked_.front().command.stops != desk_->stops()) {
    server_.answer(asked_.front().command, kStopped);
    asked_.pop_front();
  }
  if (runtime == nullptr) refuse_asked(kRunIsOver);
  send_values();
  take_prepared(note);
  drop_overtaken(note);
  note_lost(note);
  viewer_server::RunState state = view_.run_state;
  state.is_over = runtime == nullptr;
  state.is_paused = runtime != nullptr && runtime->pace().is_paused();
  if (runtime != nullptr) state.speed = runtime->pace().speed();
  has_news_ = has_news_ || state != view_.run_state;
  view_.run_state = state;
  if (has_news_ && server_.is_due()) publish();
}

// The next reference wrench is sent whatever was sent before.
void RunPage::forget_sent(const config::FormField& field) {
  for (const ParameterChange& change : field.changes) {
    if (change.parameter == Parameter::kReferenceWrench) sent_wrench_[change.index] = kUnknown;
  }
}

// A stream of changes, as of a reference wrench, is not sent to the pages value by value.
void RunPage::send_values() {
  constexpr std::chrono::milliseconds kPeriod(30);
  const auto now = std::chrono::steady_clock::now();
  if (!has_new_values_ || now - values_sent_ < kPeriod) return;
  values_sent_ = now;
  has_new_values_ = false;
  server_.set_values(values_);
}

void RunPage::take(const Command& command, runtime::Runtime* runtime, const Note& note) {
  has_news_ = true;
  if (command.is_done) return note_done(command, note);
  const auto order = std::ranges::find(orders(), command.name, &Order::name);
  const bool is_known = order != orders().end();
  std::string why_not;
  if (is_known) why_not = refusal_of(*order, run_);
  if (!why_not.empty()) {
    // said
  } else if (!is_known || order->obey == nullptr) {
    why_not = "this is a run, not a recording";
  } else if (runtime == nullptr && !order->is_choice()) {
    why_not = kRunIsOver;
  } else {
    why_not = (this->*order->obey)(command, runtime, note);
    // answered by the cycle, or when it is prepared
    const bool is_under_way = command.name == CommandName::kMode || order->is_choice();
    if (is_under_way && why_not.empty()) return;
  }
  server_.answer(command, why_not);
}

// A command that is repeated many times a second is reported twice a second.
void RunPage::note_done(const Command& command, const Note& note) {
  constexpr std::chrono::milliseconds kPeriod(500);
  std::string text = text_of_done(command);
  const std::string_view name = name_of_done(command);
  const auto now = std::chrono::steady_clock::now();
  const bool is_same = name == done_.first && text == done_.second;
  if (is_same && now - done_at_ < kPeriod) return;
  done_ = {std::string(name), text};
  done_at_ = now;
  note(name, text);
}

void RunPage::note_lost(const Note& note) {
  const std::uint32_t lost = desk_->take_lost();
  if ((lost & 1u) != 0) note("operator_enable", "let go: its page is gone or silent");
  if ((lost & 2u) != 0) note("override_key", "turned off: its page is gone or silent");
}

std::string RunPage::stop(const Command&, runtime::Runtime* runtime, const Note& note) {
  runtime->request_stop();
  stop_was_asked_ = true;
  has_next_ = false;  // discards the previous choice
  note("stop", "requested in the page");
  return {};
}

std::string RunPage::request_mode(const Command& command, runtime::Runtime* runtime,
                                  const Note& note) {
  const auto named = std::ranges::find(kRequests, command.argument, &NamedRequest::name);
  if (named == std::end(kRequests)) return "there is no such mode: " + command.argument;
  if (command.stops != desk_->stops()) return std::string(kStopped);
  // one button resets the safety controller as well, and first
  if (named->request == ModeRequest::kReset) runtime->press_reset();
  const bool is_taken = runtime->request(ModeRequest::kNone, command.stops) &&
                        runtime->request(ModeRequest::kNone, command.stops) &&
                        runtime->request(named->request, command.stops);
  if (!is_taken) return "too many commands are waiting";
  note(command.argument, "requested in the page");
  asked_.push_back({command, named->request});
  return {};
}

std::string RunPage::mark(const Command& command, runtime::Runtime*, const Note& note) {
  note("mark", fmt::format("{}{}{}", ++marks_, command.argument == "mark" ? "" : " ",
                           command.argument == "mark" ? "" : command.argument));
  return {};
}

// Like the settings of the same names, but without a line of text for each message.
void RunPage::take_reference_wrench(runtime::Runtime* runtime, const Note& note) {
  Vector6 w;
  std::uint64_t client = 0;
  const bool is_new = server_.take_reference_wrench(w, client);
  if (runtime == nullptr) return next_wrench_.reset();
  if (!run_.fixed_by.empty()) {
    if (is_new && client != 0) server_.warn(client, "/reference_wrench: " + run_.fixed_by);
    return;
  }
  if (is_new && client != wrench_client_) {
    note("reference_wrench",
         client == 0 ? std::string("ended: zero") : fmt::format("given by page {}", client));
    wrench_client_ = client;
  }
  if (is_new && accepts(w, client)) next_wrench_ = w;
  if (next_wrench_ && send_wrench(*runtime, *next_wrench_)) next_wrench_.reset();
}

// All components or none: a part would have a direction that was not asked for.
bool RunPage::accepts(const Vector6& w, std::uint64_t client) {
  for (int i = 0; i < 6; ++i) {
    const int number = field_of_wrench(i);
    const std::string why_not =
        number < 0 ? std::string() : config::refusal(form_, number, w[i], values_);
    if (why_not.empty()) continue;
    server_.warn(client, "/reference_wrench: " + why_not);
    return false;
  }
  return true;
}

// Field of the form; -1 = this run has none that can be changed.
int RunPage::field_of_wrench(int i) const {
  const int number =
      config::field_of(form_, {Parameter::kReferenceWrench, static_cast<std::int16_t>(i), 0.0});
  return number < 0 || form_[number].changes.empty() ? -1 : number;
}

// Sends the components that differ from those sent last; false when some have no place yet.
bool RunPage::send_wrench(runtime::Runtime& runtime, const Vector6& w) {
  for (int i = 0; i < 6; ++i) {
    const int number = field_of_wrench(i);
    if (number < 0 || w[i] == sent_wrench_[i]) continue;
    for (ParameterChange change : form_[number].changes) {
      change.value = w[i];
      if (!runtime.change(change)) return false;
    }
    sent_wrench_[i] = w[i];
  }
  return true;
}

std::string RunPage::set_pace(const Command& command, runtime::Runtime* runtime, const Note& note) {
  runtime::Pace& pace = runtime->pace();
  switch (command.name) {
    case CommandName::kPause:
      pace.pause();
      note("pause", "simulated time stands still");
      return {};
    case CommandName::kResume:
      pace.resume();
      note("resume", "simulated time continues");
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
std::string RunPage::choose(const Command& command, runtime::Runtime*, const Note&) {
  if (is_preparing() || has_next_) return "another run is being prepared";
  ScenarioOptions options = *run_.options;
  const auto* chooser = std::ranges::find(kChoosers, command.name, &Chooser::command);
  if (chooser != std::end(kChoosers)) {
    if (!is_choice(choices_.*chooser->list, command.argument)) {
      return "there is no such choice: " + command.argument;
    }
    options.*chooser->option = command.argument;
  }
  settle_choice(command.name, given_, options);
  chosen_ = command;
  prepared_ = std::async(std::launch::async, [this, options]() -> std::string {
    try {
      prepare_(options);
      return {};
    } catch (const scenario::StartError& error) {
      return fmt::format("the {} cannot hold the handle of the {} where it starts ({})",
                         error.device, error.twin, error.why);
    } catch (const SetupError& error) {
      return first_line(error.what());
    }
  });
  return {};
}

void RunPage::take_prepared(const Note& note) {
  if (!is_preparing() || prepared_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return;
  }
  std::string refusal = prepared_.get();
  if (refusal.empty() && chosen_.stops != desk_->stops()) refusal = kStopped;
  has_next_ = refusal.empty();
  if (has_next_) note("restart", chosen_.argument.empty() ? "again" : chosen_.argument);
  server_.answer(chosen_, refusal);
}

// A stop that came after a run was chosen is one for that run as well.
void RunPage::drop_overtaken(const Note& note) {
  if (!has_next_ || chosen_.stops == desk_->stops()) return;
  has_next_ = false;
  stop_was_asked_ = true;
  note("restart", "left out: a stop came after it");
}

bool RunPage::take_next() {
  return std::exchange(has_next_, false) && chosen_.stops == desk_->stops();
}

std::string RunPage::set(const Command& command, runtime::Runtime* runtime, const Note& note) {
  const auto field = std::ranges::find(form_, command.argument, &config::FormField::name);
  if (field == form_.end()) return "there is no such setting: " + command.argument;
  const auto number = static_cast<int>(field - form_.begin());
  std::string why_not = config::refusal(form_, number, command.value, values_);
  if (!why_not.empty()) return why_not;
  forget_sent(*field);
  for (ParameterChange change : field->changes) {
    change.value = command.value;
    if (!runtime->change(change)) return "too many changes are waiting";
  }
  note("set", fmt::format("{} = {} {}", field->name, to_text(command.value), field->unit));
  return {};
}

}  // namespace hg::page
