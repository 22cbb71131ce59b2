/// Tells in words what happened in a run: from its samples and events, in their order.
///
/// For people who were not there: each line says what, how much and, of a fault, what it means,
/// what the machine did and what releases it. Works on recordings, outside any loop.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hg/explanation/fault_figures.h"
#include "hg/signals/state.h"

namespace hg::explanation {

/// Something that happened.
struct Entry {
  double time_s = 0.0;
  std::string kind;                  ///< "mode", "limit", "warning", "FAULT", ...
  std::string text;                  ///< one line
  std::vector<std::string> details;  ///< further lines, "meaning      ..."
};

class Explainer {
 public:
  explicit Explainer(Names names);

  /// In their order.
  void add(const Sample& sample);
  /// What the recording itself says; `text` as in the recording.
  void add_event(double time_s, const std::string& name, const std::string& text);
  /// After the last sample: all entries by time.
  std::vector<Entry> finish();

  double first_s() const noexcept { return first_s_; }
  double last_s() const noexcept { return last_.time_s; }

 private:
  /// Something that goes on for a while, with interruptions too short to tell.
  struct Span {
    double begin_s = 0.0, end_s = 0.0;
    double active_s = 0.0;
    double peak = 0.0;
    const char* unit = "";  ///< of peak
  };
  /// What of the last sample is compared with the next.
  struct Last {
    std::uint64_t cycle = 0;
    double time_s = 0.0;
    Mode mode = Mode::kOff;
    FaultCode fault = FaultCode::kNone;
    TareStatus tare = TareStatus::kNone;
    bool is_autonomous = false;
  };
  /// Samples that are not there.
  struct Lost {
    std::uint64_t samples = 0, gaps = 0;
    double first_s = 0.0, longest_s = 0.0;
  };
  /// From a fault to the rest of the device.
  struct Aftermath {
    std::size_t entry = 0;
    double fault_s = 0.0;
    double off_s = -1.0;    ///< drives were off; < 0 = not seen
    double moved_s = -1.0;  ///< last motion seen
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
  std::map<std::pair<std::string, std::string>, Span> spans_;  ///< by kind and text
  Last last_;
  bool has_aftermath_ = false;
  Aftermath aftermath_;
  double first_s_ = -1.0;
  double period_s_ = 0.0;
  double force_before_ = 0.0, force_now_ = 0.0;  ///< largest of the last window and of this one
  double force_until_s_ = 0.0;                   ///< end of this one
};

}  // namespace hg::explanation
