/// What is new in a sample of a run and worth a line while it lasts: results of requests, a device
/// that stands outside of its limits, contacts of the arm, faults.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/analysis/fault_figures.h"
#include "hg/signals/state.h"

namespace hg::analysis {

/// An item of news: the name of an event and its description in words.
struct News {
  std::string_view name;
  std::string text;
};

/// Reports each change once. Samples must be in order.
class RunNews {
 public:
  explicit RunNews(Names names) : names_(std::move(names)) {}

  std::vector<News> observe(const Sample& sample);

 private:
  std::string drift(const CycleRecord& record);

  Names names_;
  TareStatus tare_ = TareStatus::kNone;  ///< last result, the same after retries
  FaultCode fault_ = FaultCode::kNone;
  // drift of the force sensor: taken off, that of the last sample, and what is left
  Vector6 reported_zero_ = Vector6::Zero(), zero_ = Vector6::Zero(), left_ = Vector6::Zero();
  bool is_left_reported_ = false;
  bool is_touched_ = false;
  bool has_waited_ = false;  ///< the device was ready in the last sample
};

}  // namespace hg::analysis
