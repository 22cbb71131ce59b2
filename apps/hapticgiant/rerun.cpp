#include "apps/hapticgiant/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "hg/messages/cdr_writer.h"
#include "hg/recording/columns.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/assembly.h"
#include "hg/scenario/recorded/recorded_scenario.h"

namespace hg::apps {
namespace {

using messages::CdrWriter;
using recording::Column;
using recording::Columns;

// Numbers of the first row of a column as text.
std::vector<std::string> numbers_of(const Column& column) {
  const auto numbers = [&](auto zero) {
    using T = decltype(zero);
    std::vector<std::string> texts;
    for (std::size_t i = 0; i * sizeof(T) < column.data.size(); ++i) {
      T value;
      std::memcpy(&value, column.data.data() + i * sizeof(T), sizeof(T));
      if constexpr (std::is_floating_point_v<T>) {
        texts.push_back(fmt::format("{:.17g}", value));
      } else {
        texts.push_back(fmt::format("{}", +value));
      }
    }
    return texts;
  };
  if (column.kind == 'f') return numbers(0.0);
  const bool is_signed = column.kind == 'i';
  switch (column.bytes) {
    case 1:
      return is_signed ? numbers(std::int8_t{}) : numbers(std::uint8_t{});
    case 2:
      return is_signed ? numbers(std::int16_t{}) : numbers(std::uint16_t{});
    case 4:
      return is_signed ? numbers(std::int32_t{}) : numbers(std::uint32_t{});
    default:
      return is_signed ? numbers(std::int64_t{}) : numbers(std::uint64_t{});
  }
}

bool is_output(const Column& column) {
  return !column.name.starts_with("sensors.") && !column.name.starts_with("operator_input.") &&
         !column.name.starts_with("truth.") && column.name != "cycle_time_us";
}

template <HasFields Message>
bool is_same(CdrWriter& left, CdrWriter& right, const Message& a, const Message& b) {
  return std::ranges::equal(left.encode(a), right.encode(b));
}

class Runner final : public recording::RecordingListener {
 public:
  void configuration(const recording::NamedText& text) override {
    if (!cycle_) configuration_.push_back(text);
  }
  void event(const recording::Event&) override {}
  void sample(const Sample& sample) override {
    if (is_over_) return;
    if (!cycle_ && sample.record.cycle != 0) {
      return end(fmt::format("cannot be run again: it begins with cycle {}, not with the first",
                             sample.record.cycle));
    }
    if (!cycle_) {
      const config::Scenario scenario = scenario::recorded_scenario(configuration_);
      cycle_.emplace(scenario::make_cycle(scenario));
    } else if (sample.record.cycle != result_.cycles) {
      return end(fmt::format("cycle {} is missing in the recording", result_.cycles));
    }
    now_->sensors = sample.sensors;
    now_->operator_input = sample.operator_input;
    cycle_->step(now_->sensors, now_->operator_input, now_->command, now_->record);
    if (is_same(left_, right_, sample.command, now_->command) &&
        is_same(left_, right_, sample.record, now_->record)) {
      ++result_.cycles;
      return;
    }
    end(fmt::format("different from cycle {} ({:.3f} s) on: {}", sample.record.cycle,
                    sample.record.time_s, first_difference(sample, *now_)));
  }

  const Rerun& result() const { return result_; }

 private:
  void end(const std::string& why) {
    is_over_ = true;
    result_.is_same = false;
    result_.text = why;
  }

  std::vector<recording::NamedText> configuration_;
  std::optional<controller::Cycle> cycle_;
  std::unique_ptr<Sample> now_ = std::make_unique<Sample>();
  CdrWriter left_, right_;
  Rerun result_;
  bool is_over_ = false;
};

}  // namespace

std::string first_difference(const Sample& recorded, const Sample& now) {
  Columns before, after;
  before.append(recorded);
  after.append(now);
  for (std::size_t i = 0; i < before.all().size(); ++i) {
    const Column& column = before.all()[i];
    if (!is_output(column) || column.data == after.all()[i].data) continue;
    const std::string name = (column.name.starts_with("command.") ? "" : "record.") + column.name;
    const auto was = numbers_of(column), is = numbers_of(after.all()[i]);
    if (was.size() != is.size()) return name + " has another number of items";
    const std::size_t place = std::ranges::mismatch(was, is).in1 - was.begin();
    if (place == was.size()) return name + " has other bits";  // two kinds of NaN
    const std::string item = column.is_wide ? fmt::format("[{}]", place) : "";
    return fmt::format("{}{} was {} and is {}", name, item, was[place], is[place]);
  }
  return {};
}

Rerun rerun(const std::filesystem::path& file) {
  Runner runner;
  recording::read_recording(file, runner);
  return runner.result();
}

}  // namespace hg::apps
