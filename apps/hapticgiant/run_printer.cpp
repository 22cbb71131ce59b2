#include "apps/hapticgiant/run_printer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/hapticgiant/open_page.h"
#include "apps/hapticgiant/output_file.h"
#include "hg/core/error.h"

namespace hg::apps {

RunPrinter::RunPrinter(const scenario::RunPlan& plan, std::string summary, bool is_terminal,
                       const BackgroundOutput& output)
    : page_(plan.page),
      is_fast_(plan.timing.is_fast),
      file_(std::move(summary)),
      line_(is_terminal, output) {}

void RunPrinter::link(const std::string& url) {
  present_page(url, page_.address, page_.opens_browser);
}

void RunPrinter::phase(scenario::RunPhase phase, double /*time_s*/, const std::string& /*wanted*/) {
  if (phase == scenario::RunPhase::kOver) line_.clear();
}

void RunPrinter::event(double time_s, std::string_view name, std::string_view text) {
  line_.print(fmt::format("{:8.3f} s  {:<18} {}", time_s, name, text));
}

void RunPrinter::status(const Sample& sample, const config::Scenario& scenario) {
  if (!is_fast_) line_.show(status_text(sample, scenario.limits, scenario.twin.model));
}

void RunPrinter::note(std::string_view label, const std::string& text) {
  line_.print(label.empty() ? text : fmt::format("{:<11} {}", label, text));
}

void RunPrinter::problem(const std::string& text) {
  line_.clear();
  print_error("{}\n", text);
}

void RunPrinter::summary(const scenario::RunSummary& summary) {
  print_out(summary.text);
  is_written_ = true;
  if (file_.empty()) return;
  try {
    write_output(file_,
                 summary.json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  } catch (const SetupError& error) {
    print_error("{}\n", error.what());
    is_written_ = false;
  }
}

}  // namespace hg::apps
