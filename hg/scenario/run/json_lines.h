/// What a run reports, as JSON: docs/reference/run_protocol.md.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "hg/scenario/run/run_observer.h"

namespace hg::scenario {

/// How much is lost without a report.
enum class Worth {
  kReport,  ///< counted when it is lost
  kStatus,  ///< soon replaced by the next one; left out while others wait
};

/// Every report as one JSON object.
class JsonObserver : public RunObserver {
 public:
  using Take = std::function<void(const nlohmann::ordered_json& report, Worth worth)>;
  explicit JsonObserver(Take take) : take_(std::move(take)) {}

  void link(const std::string& url) override;
  void phase(RunPhase phase, double time_s, const std::string& wanted) override;
  void event(double time_s, std::string_view name, std::string_view text) override;
  void status(const Sample& sample, const config::Scenario& scenario) override;
  void note(std::string_view label, const std::string& text) override;
  void problem(const std::string& text) override;
  void fault(const RunFault& fault) override;
  void summary(const RunSummary& summary) override;

  /// The run was refused: bad input.
  void refused(const std::string& why);

 private:
  Take take_;
};

/// Compact JSON in one line; text that is not UTF-8 is replaced.
std::string to_line(const nlohmann::ordered_json& report);

/// Writes lines to a file descriptor and never waits for its reader: a thread writes. Beyond 1 MiB
/// of waiting text, lines are dropped; {"lost": NUMBER} says how many once reading continues. When
/// the reader has closed, all is dropped.
class LineWriter {
 public:
  /// Takes `file`, a descriptor that is open for writing, from 3 on. Throws SetupError.
  explicit LineWriter(int file);
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  void push(const std::string& line, Worth worth);
  /// Waits until all is read, at most two seconds; nothing may be pushed afterwards. Returns why
  /// writing failed, as a full disk; empty if it did not, or if the reader has closed.
  std::string end();

 private:
  class Queue;

  const std::unique_ptr<Queue> queue_;
  std::thread thread_;
};

}  // namespace hg::scenario
