#include "apps/hapticgiant/explain_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/command.h"
#include "apps/command_line/output.h"
#include "hg/analysis/latency.h"
#include "hg/analysis/run_story.h"
#include "hg/core/error.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/names.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {
namespace {

// Collects the configuration until the first sample, which needs its names.
class Reader final : public recording::RecordingListener {
 public:
  void configuration(const recording::NamedText& text) override {
    if (!story_) configuration_.push_back(text);
  }
  void event(const recording::Event& event) override { events_.push_back(event); }
  void sample(const Sample& sample) override {
    if (!story_) story_ = std::make_unique<analysis::RunStory>(names());
    story_->add(sample);
    if (latency_) latency_->add(sample);
    ++samples_;
  }

  const std::string& title() const { return title_; }
  std::uint64_t samples() const { return samples_; }
  double first_s() const { return story_->first_s(); }
  std::string latency() const { return latency_ ? to_text(latency_->latency()) : ""; }
  double last_s() const { return story_->last_s(); }
  std::vector<analysis::Entry> entries() {
    for (const recording::Event& event : events_) {
      // the samples contain these events as well, in more detail
      if (event.name == "tare" || event.name == "request" || event.name == "fault" ||
          event.name == "stopped" || event.name == "contact") {
        continue;
      }
      story_->add_event(event.time_s, event.name, event.text);
    }
    for (const faults::Injection& fault : faults_) add_injected(fault);
    return story_->finish();
  }

 private:
  // a fault that the scenario injects, if it acts while the recording lasts
  void add_injected(const faults::Injection& fault) {
    const bool is_over = fault.for_s > 0.0 && fault.from_s + fault.for_s < first_s();
    if (is_over || fault.from_s > last_s()) return;
    std::string text = fmt::format("{}, {}", fault.kind->name, fault.kind->what);
    if (!fault.kind->unit.empty()) {
      text += fmt::format(", {:g} {}", fault.magnitude, fault.kind->unit);
    }
    if (fault.for_s > 0.0) text += fmt::format(", for {:g} s", fault.for_s);
    story_->add_event(fault.from_s, "injected fault", text);
  }

  analysis::Names names() {
    try {
      const config::Scenario scenario = scenario::recorded_scenario(configuration_);
      title_ = scenario.title;
      faults_ = scenario.faults;
      latency_.emplace(scenario.device.model.rate_Hz,
                       scenario.device.control.method == tracking::Method::kDrives);
      return scenario::part_names(scenario);
    } catch (const SetupError& error) {
      const std::string why = error.what();
      title_ = "its configuration is not understood, parts are numbered: " +
               why.substr(0, why.find('\n'));
    }
    return {};
  }

  std::vector<recording::NamedText> configuration_;
  std::vector<recording::Event> events_;
  std::vector<faults::Injection> faults_;
  std::unique_ptr<analysis::RunStory> story_;
  std::optional<analysis::LatencyWatch> latency_;
  std::string title_;
  std::uint64_t samples_ = 0;
};

void print(const analysis::Entry& entry) {
  print_out(fmt::format("{:9.3f} s  {:<8} {}\n", entry.time_s, entry.kind, entry.text));
  for (const std::string& detail : entry.details) {
    print_out(fmt::format("{:>21}{}\n", "", detail));
  }
}

}  // namespace

int explain_recording(const std::string& file) {
  Reader reader;
  const recording::ReadResult read = recording::read_recording(file, reader);
  const char* cut_off =
      "; CUT OFF: its end is missing. A program that ended early loses at most a second, an "
      "incomplete copy any part";
  print_out(fmt::format("{}\n{:.3f} .. {:.3f} s of the run, {} samples{}\n{}\n", reader.title(),
                        reader.first_s(), reader.last_s(), reader.samples(),
                        read.is_complete ? "" : cut_off, recording::to_text(read.losses)));
  const std::vector<analysis::Entry> entries = reader.entries();
  for (const analysis::Entry& entry : entries) print(entry);
  const bool has_fault = std::ranges::any_of(
      entries, [](const analysis::Entry& entry) { return entry.kind == "FAULT"; });
  if (!has_fault) print_out("\nno fault\n");
  const std::string latency = reader.latency();
  if (!latency.empty()) print_out(fmt::format("latency: {}\n", latency));
  return 0;
}

void add_explain(Command app, int& exit_code) {
  const auto file = std::make_shared<std::string>();
  const Command command =
      app.add_subcommand("explain", "Describes what happened in a recording, in order.");
  command.footer("Example:\n  hapticgiant explain recordings/latest.mcap");
  command.add_option("file", *file, "recording, also one that a crash has cut off")
      .required()
      .existing_file();
  command.callback([file, &exit_code] { exit_code = explain_recording(*file); });
}

}  // namespace hg::apps
