#include "apps/hapticgiant/experiments/recorded_signals.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "apps/hapticgiant/experiments/condition_text.h"
#include "apps/hapticgiant/run_setup.h"
#include "hg/analysis/summary.h"
#include "hg/scenario/assembly.h"

namespace hg::apps {
namespace {

// Collects the configuration until the first sample, which needs it.
class Reader final : public recording::RecordingListener {
 public:
  Reader(RecordedSignals& signals, double period_s) : signals_(signals), period_s_(period_s) {}

  void configuration(const recording::NamedText& text) override {
    if (!signals_.scenario) signals_.configuration.push_back(text);
  }
  void event(const recording::Event& event) override { events_.push_back(event); }
  void sample(const Sample& sample) override {
    if (!signals_.scenario) begin();
    signals_.table->add(sample);
    signals_.hashes.push_back({sample.record.cycle, sample.record.state_hash});
    summary_->add(sample);
  }
  void finish() {
    const config::Scenario& scenario = *signals_.scenario;
    for (const recording::Event& event : events_) {
      const auto rule = std::ranges::find_if(
          scenario.events, [&](const auto& each) { return each.name == event.name; });
      const bool is_expected = rule != scenario.events.end();
      if (is_expected) summary_->add({event.name, event.time_s, event.text});
      signals_.marks.push_back(
          {is_expected ? paper_label(*rule) : event.name, event.time_s, event.text});
    }
    analysis::RunFacts facts = scenario::facts_of_scenario(scenario);
    facts.rate_Hz = scenario.device.model.rate_Hz;
    signals_.summary = nlohmann::ordered_json::parse(summary_->to_json(facts, {}));
  }

 private:
  void begin() {
    signals_.scenario =
        std::make_unique<config::Scenario>(recorded_scenario(signals_.configuration));
    signals_.table = std::make_unique<RunTable>(*signals_.scenario, period_s_);
    summary_.emplace(scenario::make_summary(*signals_.scenario));
  }

  RecordedSignals& signals_;
  double period_s_;
  std::vector<recording::Event> events_;
  std::optional<analysis::Summary> summary_;
};

}  // namespace

RecordedSignals read_signals(const std::filesystem::path& file, double period_s) {
  RecordedSignals signals;
  Reader reader(signals, period_s);
  signals.read = recording::read_recording(file, reader);
  reader.finish();
  return signals;
}

}  // namespace hg::apps
