/// The story of a run in words, from its samples and events in their order.
///
/// Each line states what happened and how much; for a fault also its meaning, the reaction of the
/// machine and what releases it. Works on recordings, outside any loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hg/analysis/fault_figures.h"
#include "hg/signals/state.h"

namespace hg::analysis {

/// An entry of the explanation.
struct Entry {
  double time_s = 0.0;
  std::string kind;                  ///< kind, e.g. "mode", "limit", "warning", "FAULT"
  std::string text;                  ///< text, one line
  std::vector<std::string> details;  ///< further lines, "meaning      ..."
};

class RunStory {
 public:
  explicit RunStory(Names names);

  /// Adds the next sample; samples must be in order.
  void add(const Sample& sample);
  /// Adds an event of the recording; `text` as in the recording.
  void add_event(double time_s, const std::string& name, const std::string& text);
  /// Returns all entries by time; call it after the last sample.
  std::vector<Entry> finish();

  double first_s() const noexcept { return first_s_; }
  double last_s() const noexcept { return last_.time_s; }

 private:
  /// A lasting condition, with interruptions too short to report.
  struct Span {
    double begin_s = 0.0, end_s = 0.0;
    double active_s = 0.0;
    double peak = 0.0;
    const char* unit = "";  ///< unit of `peak`
  };
  /// Values of the last sample that are compared with the next.
  struct Last {
    std::uint64_t cycle = 0;
    double time_s = 0.0;
    Mode mode = Mode::kOff;
    FaultCode fault = FaultCode::kNone;
    TareStatus tare = TareStatus::kNone;
    bool is_autonomous = false;
  };
  /// Missing samples.
  struct Lost {
    std::uint64_t samples = 0, gaps = 0;
    double first_s = 0.0, longest_s = 0.0;
  };
  /// Time from a fault to standstill of the device.
  struct Aftermath {
    std::size_t entry = 0;
    double fault_s = 0.0;
    double off_s = -1.0;    ///< time when the drives were off; < 0 = not seen
    double moved_s = -1.0;  ///< time of the last motion seen
    double force = 0.0, speed = 0.0;
    Stop stop = Stop::kNone;
  };

  void begin(const Sample& sample);
  void remember(const Sample& sample);
  void add_gap(const CycleRecord& record);
  void add_modes(const Sample& sample);
  void add_requests(const CycleRecord& record);
  void add_limits(const CycleRecord& record);
  void add_others(const Sample& sample);
  void add_fault(const Sample& sample);
  void follow(const Sample& sample);
  void end_aftermath();
  void extend(const char* kind, const std::string& text, double time_s, double value = 0.0,
              const char* unit = "");
  void close_spans(double now_s, bool all);

  Names names_;
  std::vector<Entry> entries_;
  Lost lost_;
  std::map<std::pair<std::string, std::string>, Span> spans_;  ///< spans by kind and text
  Last last_;
  bool has_aftermath_ = false;
  Aftermath aftermath_;
  double first_s_ = -1.0;
  double period_s_ = 0.0;
  /// Largest force of the last window and of this one
  double force_before_ = 0.0, force_now_ = 0.0;
  double force_until_s_ = 0.0;  ///< end of this window
};

}  // namespace hg::analysis
