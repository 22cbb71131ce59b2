#include "hg/scenario/run/run_player.h"

#include <fmt/format.h>

#include <utility>

#include "hg/page/built_page.h"
#include "hg/scenario/run/plan_options.h"
#include "hg/scenario/run/run_streams.h"
#include "hg/scenario/run/single_run.h"
#include "hg/viewer_server/access.h"

namespace hg::scenario {
namespace {

std::unique_ptr<lab_streaming::Liblsl> load_liblsl(const RunRecords& records, const RunHost& host) {
  if (!records.has_lab_streams) return nullptr;
  return std::make_unique<lab_streaming::Liblsl>(host.lab_libraries.empty() ? lab_libraries()
                                                                            : host.lab_libraries);
}

const RunPlan& checked(const RunPlan& plan) {
  check_plan(plan);
  return plan;
}

}  // namespace

RunPlayer::RunPlayer(const RunPlan& plan, const RunHost& host)
    : plan_(checked(plan)), host_(host), liblsl_(load_liblsl(plan.records, host)) {
  if (moves_by_law(plan_.machine)) {
    way_ = prepare_way(plan_.world, plan_.machine, plan_.timing, plan_.records);
  } else {
    present_ =
        std::make_unique<PreparedRun>(plan_.world, plan_.machine, plan_.timing, plan_.records);
  }
}

std::string RunPlayer::fixed_by() const {
  return plan_.page.is_trial() ? "this run is a trial of a study" : "";
}

void RunPlayer::open_page(RunObserver& observer) {
  if (!plan_.page.is_served || plan_.timing.is_fast) return;
  const std::string folder = page::built_page();
  if (folder.empty()) return observer.note("page", page::kNoPage);
  viewer_server::ServerOptions options;
  options.page = folder;
  options.address = plan_.page.address;
  options.port = plan_.page.port;
  options.embedders = plan_.page.embedders;
  if (!plan_.page.token_file.empty()) {
    options.token = viewer_server::kept_token(plan_.page.token_file);
  }
  const page::ShownRun first =
      way_.run ? way_.run->shown(kMovesItself) : present_->shown(fixed_by());
  page_ = std::make_unique<page::RunPage>(options, first, [this](const ScenarioOptions& world) {
    next_ = std::make_unique<PreparedRun>(world, plan_.machine, plan_.timing, plan_.records);
  });
  observer.link(page_->url());
  link_ = std::make_unique<live::LinkFile>(live::live_address(page_->url()));
  if (!link_->problem().empty()) {
    observer.note("note", "bridges need --live: " + link_->problem());
  }
}

// Why the device is not there; empty = it is, and the run is prepared.
std::string RunPlayer::come_to_start(RunObserver& observer, const std::atomic<bool>& stop) {
  const std::uint32_t stops = page_ ? page_->desk().stops() : 0;
  std::string problem =
      move_to_start(way_, plan_.timing, machine_memory(plan_.machine, plan_.records.folder),
                    page_.get(), observer, stop);
  last_ = std::exchange(way_.run, nullptr);
  if (!problem.empty()) return problem;
  present_ = std::make_unique<PreparedRun>(plan_.world, plan_.machine, plan_.timing, plan_.records);
  // a stop that came while it was prepared is one for it, too
  return page_ && page_->desk().stops() != stops ? "it was stopped" : "";
}

RunOutcome RunPlayer::play(RunObserver& observer, const std::atomic<bool>& stop) {
  open_page(observer);
  if (way_.run) {
    const std::string problem = come_to_start(observer, stop);
    if (!problem.empty()) {
      observer.problem(fmt::format("--move-to-start: {}; the run does not begin", problem));
      return {.exit_code = kNotThere};
    }
  }
  while (true) {
    const RunOutcome outcome = play_single(*present_, {.plan = plan_,
                                                       .host = host_,
                                                       .observer = observer,
                                                       .stop = stop,
                                                       .page = page_.get(),
                                                       .liblsl = liblsl_.get(),
                                                       .fixed_by = fixed_by()});
    if (!page_ || stop.load() || !page_->take_next()) return outcome;
    last_ = std::move(present_);
    present_ = std::move(next_);
  }
}

RunOutcome play(const RunPlan& plan, RunObserver& observer, const std::atomic<bool>& stop) {
  return RunPlayer(plan).play(observer, stop);
}

}  // namespace hg::scenario
