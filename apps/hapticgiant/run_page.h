/// Page of a run: updates its display and executes its commands. It persists over successive runs.
/// Stops do not wait for it: the server passes them to the operator's desk, where the control loop
/// reads them; here they are only reported.
///
/// Used by the observer thread.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/hapticgiant/prepared_run.h"
#include "hg/analysis/fault_figures.h"
#include "hg/config/twin_form.h"
#include "hg/page/hand_analysis.h"
#include "hg/runtime/runtime.h"
#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::apps {

class RunPage {
 public:
  /// Callback for every change by a command: name, and description in words.
  using Note = std::function<void(std::string_view name, const std::string& text)>;

  RunPage(const viewer_server::ServerOptions& options, const PreparedRun& first);

  std::string url() const { return server_.url(); }
  /// Number of pages connected.
  std::uint64_t clients() const { return server_.counters().clients; }

  /// Operator's desk, from which the control loop reads the actions of pages.
  OperatorDesk& desk() { return *desk_; }

  /// Shows `run` from now on; it outlives the next call. `recording` is the name of its file.
  void begin(const PreparedRun& run, const std::string& recording);

  /// Processes every sample, in order.
  void observe(const Sample& sample, const Note& note);
  /// Shows the newest sample.
  void show(const Sample& sample);
  void announce(double time_s, std::string_view name, std::string_view text) {
    server_.announce_event(time_s, name, text);
  }

  /// Applies hand input and commands. `runtime` is nullptr when the run is over.
  void follow(runtime::Runtime* runtime, const Note& note);

  bool stop_was_asked() const { return stop_was_asked_; }
  bool has_next() const { return next_ != nullptr; }
  /// Whether a chosen run is still being prepared.
  bool is_preparing() const { return prepared_.valid(); }
  /// Returns the chosen next run, once.
  std::unique_ptr<PreparedRun> take_next();

 private:
  /// A chosen run, or the reason why there is none.
  struct Prepared {
    std::unique_ptr<PreparedRun> run;
    std::string refusal;
  };
  /// A mode requested by a page, until a cycle has accepted or refused it.
  struct Asked {
    viewer_server::Command command;
    ModeRequest request = ModeRequest::kNone;
    /// The pause before the request has been seen: requests act on their edge
    bool is_next = false;
    std::uint32_t samples = 0;  ///< number of samples seen since the request is the first
  };

  void tell_done(const viewer_server::Command& command, const Note& note) const;
  void answer_asked(const Sample& sample);
  void refuse_asked(std::string_view why);
  void drop_overtaken(const Note& note);
  std::string obey(const viewer_server::Command& command, runtime::Runtime* runtime,
                   const Note& note);
  std::string obey_mode(const viewer_server::Command& command, runtime::Runtime& runtime,
                        const Note& note);
  std::string obey_pace(const viewer_server::Command& command, runtime::Pace& pace,
                        const Note& note);
  std::string choose(const viewer_server::Command& command);
  void take_prepared(const Note& note);
  std::string set(const viewer_server::Command& command, runtime::Runtime& runtime,
                  const Note& note);
  viewer_server::Scene scene_of(const PreparedRun& run) const;
  void publish();

  const PreparedRun* run_;
  std::uint64_t number_ = 1;
  std::vector<config::FormField> form_;
  std::vector<double> values_;  ///< values of the form, as targets
  std::unique_ptr<OperatorDesk> desk_ = std::make_unique<OperatorDesk>();
  viewer_server::ViewerServer server_;
  analysis::Names names_;
  std::optional<page::HandAnalysis> analysis_;
  viewer_server::View view_;
  std::unique_ptr<Sample> newest_;
  bool has_news_ = false;  ///< there is news not yet shown on any page
  bool stop_was_asked_ = false;
  std::deque<Asked> asked_;  ///< requested modes, in order
  std::unique_ptr<PreparedRun> next_;
  viewer_server::Command chosen_;   ///< command from which `prepared_` results
  std::future<Prepared> prepared_;  ///< run prepared on a separate thread, which takes seconds
};

/// Opens the page's server for `run`; nullptr if not wanted, or if not built, which is reported.
std::unique_ptr<RunPage> open_page(const PreparedRun& run);

/// Path of the built page; empty when it is not built, after printing how to get it.
std::string find_page();

/// Prints the page's URL and who can reach it, and opens it if there is a display and an
/// interactive terminal.
void present_page(const std::string& url, const std::string& address, bool opens_browser);

}  // namespace hg::apps
