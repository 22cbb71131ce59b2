#include "hg/scenario/run/run_watch.h"

#include <cmath>
#include <thread>
#include <utility>

#include "hg/controller/safety/rules.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/names.h"

namespace hg::scenario {
namespace {

constexpr std::chrono::milliseconds kIdle(2);
constexpr std::chrono::milliseconds kStatusPeriod(100);
constexpr std::chrono::milliseconds kLatencyPeriod(250);

}  // namespace

RunWatch::RunWatch(WatchParts parts)
    : parts_(std::move(parts)),
      names_(part_names(parts_.scenario)),
      detector_(parts_.scenario.events, parts_.scenario.limits),
      summary_(make_summary(parts_.scenario)),
      news_(names_),
      latency_(parts_.scenario.device.model.rate_Hz,
               parts_.scenario.device.control.method == tracking::Method::kDrives) {}

void RunWatch::notify(double time_s, std::string_view name, std::string_view what) {
  parts_.observer.event(time_s, name, what);
  parts_.recording.event(time_s, name, what);
  if (parts_.streams) parts_.streams->mark(time_s, name, what);
  if (parts_.page != nullptr) parts_.page->announce(time_s, name, what);
}

// callback for changes by pages, at the time of `sample`
page::RunPage::Note RunWatch::note_at(const Sample& sample) {
  return [this, &sample](std::string_view name, const std::string& text) {
    notify(sample.record.time_s, name, text);
  };
}

void RunWatch::observe_fault(const Sample& sample) {
  const FaultCode before = summary_.fault().code;
  const bool has_shaken = summary_.has_shaken();
  summary_.add(sample);
  if (!has_shaken && summary_.has_shaken()) report_latency(sample.record.time_s);
  const Fault& fault = summary_.fault();
  if (fault.code == before || !safety::is_fault(fault.code)) return;
  fault_figures_ = analysis::figures_of(fault, names_, sample.sensors);
  parts_.observer.fault({sample.record.time_s, fault, fault_figures_});
  report_latency(sample.record.time_s);
}

// Link and page measure without samples.
void RunWatch::look_at_latency() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_latency_ < kLatencyPeriod) return;
  last_latency_ = now;
  if (parts_.remote != nullptr) latency_.add_link(parts_.remote->round_trip_s());
  if (parts_.page == nullptr) return;
  latency_.add_page(parts_.page->counters().round_trip_s);
  parts_.page->set_latency(to_text(latency_.latency()));
}

// Why a run shook or ended may be that something is slow.
void RunWatch::report_latency(double time_s) {
  last_latency_ = {};
  look_at_latency();
  const analysis::Latency latency = latency_.latency();
  const bool is_measured_here = std::isfinite(latency.link) || std::isfinite(latency.page);
  if (is_measured_here) notify(time_s, "latency", to_text(latency));
}

void RunWatch::observe(const Sample& sample) {
  const double time_s = sample.record.time_s;
  parts_.observer.sample(sample);
  latency_.add(sample);
  if (parts_.script_end_s > 0.0 && time_s > parts_.script_end_s) {
    parts_.script_end_s = 0.0;
    parts_.observer.note("", "the script has played; drag the handle in the page");
  }
  if (mode_ != sample.record.mode) {
    mode_ = sample.record.mode;
    parts_.observer.phase(phase_of(*mode_), time_s, "");
  }
  observe_fault(sample);
  for (const analysis::News& news : news_.observe(sample)) notify(time_s, news.name, news.text);
  parts_.recording.push(sample);
  if (parts_.streams) parts_.streams->push(sample);
  if (const auto event = detector_.observe(sample.record)) {
    summary_.add(*event);
    notify(event->time_s, event->name, event->what);
  }
  if (parts_.page != nullptr) parts_.page->observe(sample, note_at(sample));
}

// shows the sample at display rate
void RunWatch::show(const Sample& sample) {
  if (parts_.page != nullptr) parts_.page->show(sample);
  const auto now = std::chrono::steady_clock::now();
  if (now - last_status_ < kStatusPeriod) return;
  last_status_ = now;
  parts_.observer.status(sample, parts_.scenario);
}

void RunWatch::check_parts(const runtime::Runtime& runtime, double time_s) {
  look_at_latency();
  const std::string problems = parts_.dumps.look_at(runtime.kept_problems());
  if (!problems.empty()) parts_.observer.note("", problems);
  const std::string why = parts_.recording.news();
  if (!why.empty()) {
    notify(time_s, "recording", "has ended early, the run continues: " + why);
  }
  if (!parts_.streams) return;
  if (const std::optional<lab_streaming::ClockNews> clock = parts_.streams->news()) {
    notify(time_s, "lab clock", to_text(*clock));
    parts_.recording.lab_clock({.time_s = time_s, .offset_s = clock->offset_s});
  }
}

void RunWatch::watch(runtime::Runtime& runtime) {
  auto sample = std::make_unique<Sample>();
  while (true) {
    const bool is_finished = runtime.is_finished();
    bool any = false;
    while (runtime.pop(*sample)) {
      observe(*sample);
      any = true;
    }
    if (any) show(*sample);
    check_parts(runtime, sample->record.time_s);
    if (is_finished) break;
    if (parts_.page != nullptr) {
      parts_.page->follow(&runtime, note_at(*sample));
      if (parts_.page->has_next()) runtime.request_stop();
    }
    if (!any) std::this_thread::sleep_for(kIdle);
  }
  const std::string problems = parts_.dumps.finish(runtime.kept_problems());
  if (!problems.empty()) parts_.observer.note("", problems);
}

void RunWatch::follow_page() {
  const Sample none;
  if (parts_.page != nullptr) parts_.page->follow(nullptr, note_at(none));
}

std::optional<lab_streaming::StreamCounts> RunWatch::close_streams() {
  if (!parts_.streams) return std::nullopt;
  return parts_.streams->close();
}

}  // namespace hg::scenario
