/// What a run reports, printed for the person at the terminal.
#pragma once

#include <string>

#include "apps/command_line/output.h"
#include "apps/hapticgiant/status_line.h"
#include "hg/scenario/run/run_observer.h"
#include "hg/scenario/run/run_plan.h"

namespace hg::apps {

class RunPrinter final : public scenario::RunObserver {
 public:
  /// `output` must outlive it. `summary` is the file of --summary; empty = none.
  RunPrinter(const scenario::RunPlan& plan, std::string summary, bool is_terminal,
             const BackgroundOutput& output);

  void link(const std::string& url) override;
  void phase(scenario::RunPhase phase, double time_s, const std::string& wanted) override;
  void event(double time_s, std::string_view name, std::string_view text) override;
  void status(const Sample& sample, const config::Scenario& scenario) override;
  void note(std::string_view label, const std::string& text) override;
  void problem(const std::string& text) override;
  void summary(const scenario::RunSummary& summary) override;

  /// Whether the summary of the last run is in its file, where one is wanted.
  bool is_written() const { return is_written_; }

 private:
  const scenario::RunPageOptions page_;
  const bool is_fast_;
  const std::string file_;
  StatusLine line_;
  bool is_written_ = true;
};

}  // namespace hg::apps
