#include "apps/hapticgiant/experiments/rerun.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "apps/hapticgiant/run_setup.h"
#include "hg/recording/cdr_writer.h"
#include "hg/recording/recording_reader.h"
#include "hg/scenario/assembly.h"

namespace hg::apps {
namespace {

using recording::CdrWriter;
using recording::IsScalar;

/// Names and values of all fields of a message, in their order (hg/core/fields.h).
class Fields {
 public:
  struct Field {
    std::string name, value;
  };

  template <HasFields Message>
  static std::vector<Field> of(const std::string& name, const Message& message) {
    Fields fields;
    fields.put(name, message);
    return std::move(fields.list_);
  }

  template <typename T>
  void operator()(const char* name, const T& value, const char* = "") {
    put(path_ + name, value);
  }

  template <typename T, std::size_t kCapacity>
  void sequence(const char* name, const std::array<T, kCapacity>& items, int count, const char*) {
    for (int i = 0; i < count; ++i) {
      put(fmt::format("{}{}[{}]", path_, name, i), items[static_cast<std::size_t>(i)]);
    }
  }

 private:
  template <IsScalar T>
  void put(const std::string& name, T value) {
    if constexpr (std::is_enum_v<T>) {
      list_.push_back({name, fmt::format("{}", static_cast<int>(value))});
    } else if constexpr (std::floating_point<T>) {
      list_.push_back({name, fmt::format("{:.17g}", value)});
    } else {
      list_.push_back({name, fmt::format("{}", value)});
    }
  }

  template <HasFields T>
  void put(const std::string& name, const T& message) {
    const std::string outer = std::exchange(path_, name + ".");
    fields(*this, message);
    path_ = outer;
  }

  template <typename T>
  void put(const std::string& name, const std::vector<T>& items) {
    for (std::size_t i = 0; i < items.size(); ++i) put(fmt::format("{}[{}]", name, i), items[i]);
  }

  template <int kRows, int kCols, int kOptions, int kMaxRows, int kMaxCols>
  void put(const std::string& name,
           const Eigen::Matrix<double, kRows, kCols, kOptions, kMaxRows, kMaxCols>& matrix) {
    list_.push_back({name + " (count)", fmt::format("{}", matrix.size())});
    int i = 0;
    for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
      for (Eigen::Index col = 0; col < matrix.cols(); ++col) {
        put(fmt::format("{}[{}]", name, i++), matrix(row, col));
      }
    }
  }

  void put(const std::string& name, const std::string& text) { list_.push_back({name, text}); }

  std::string path_;
  std::vector<Field> list_;
};

template <HasFields Message>
std::string difference(const std::string& name, const Message& recorded, const Message& now) {
  const auto before = Fields::of(name, recorded), after = Fields::of(name, now);
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (before[i].name == after[i].name && before[i].value == after[i].value) continue;
    if (before[i].name != after[i].name) {
      return fmt::format("{} has another number of items", before[i].name);
    }
    return fmt::format("{} was {} and is {}", before[i].name, before[i].value, after[i].value);
  }
  return before.size() == after.size() ? "" : name + " has another number of items";
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
      const config::Scenario scenario = recorded_scenario(configuration_);
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
  const std::string text = difference("command", recorded.command, now.command);
  return text.empty() ? difference("record", recorded.record, now.record) : text;
}

Rerun rerun(const std::filesystem::path& file) {
  Runner runner;
  recording::read_recording(file, runner);
  return runner.result();
}

}  // namespace hg::apps
