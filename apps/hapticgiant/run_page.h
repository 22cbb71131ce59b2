/// The page of a run: what it is shown, and what its commands change. Stays while runs follow each
/// other. Stops do not wait for it: the server takes them to the operator's desk, where the control
/// loop finds them; here they are told.
///
/// For the observer thread.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apps/hapticgiant/hand_analysis.h"
#include "apps/hapticgiant/prepared_run.h"
#include "hg/config/twin_form.h"
#include "hg/explanation/fault_figures.h"
#include "hg/runtime/runtime.h"
#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::apps {

class RunPage {
 public:
  /// Called for everything that a command has changed: what, and how in words.
  using Note = std::function<void(std::string_view name, const std::string& text)>;

  RunPage(const viewer_server::Options& options, const PreparedRun& first);

  std::string url() const { return server_.url(); }
  /// Number of pages connected.
  std::uint64_t clients() const { return server_.counters().clients; }

  /// Where the control loop finds what pages do.
  OperatorDesk& desk() { return *desk_; }

  /// Shows `run` from now on; it outlives the next call. `recording` is the name of its file.
  void begin(const PreparedRun& run, const std::string& recording);

  /// Every sample, in their order.
  void observe(const Sample& sample, const Note& note);
  /// The newest sample, as often as there is one.
  void show(const Sample& sample);
  void announce(double time_s, std::string_view name, std::string_view text) {
    server_.announce_event(time_s, name, text);
  }

  /// Follows hand and commands. `runtime` is nullptr when the run is over.
  void follow(runtime::Runtime* runtime, const Note& note);

  bool stop_was_asked() const { return stop_was_asked_; }
  bool has_next() const { return next_ != nullptr; }
  /// One has been chosen, and is not ready yet.
  bool is_preparing() const { return prepared_.valid(); }
  /// The run that was chosen to follow, once.
  std::unique_ptr<PreparedRun> take_next();

 private:
  /// A run that was chosen, or why there is none.
  struct Prepared {
    std::unique_ptr<PreparedRun> run;
    std::string refusal;
  };
  /// A mode that a page has asked for, until a cycle has followed or refused it.
  struct Asked {
    viewer_server::Command command;
    ModeRequest request = ModeRequest::kNone;
    bool is_next = false;  ///< the pause before the request has been seen: they act on their edge
    std::uint32_t samples = 0;  ///< seen since it is the first
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
  std::vector<double> values_;  ///< of the form, as targets
  std::unique_ptr<OperatorDesk> desk_ = std::make_unique<OperatorDesk>();
  viewer_server::ViewerServer server_;
  explanation::Names names_;
  std::optional<HandAnalysis> analysis_;
  viewer_server::View view_;
  std::unique_ptr<Sample> newest_;
  bool has_news_ = false;  ///< that no page has seen
  bool stop_was_asked_ = false;
  std::deque<Asked> asked_;  ///< in their order
  std::unique_ptr<PreparedRun> next_;
  viewer_server::Command chosen_;   ///< what `prepared_` comes from
  std::future<Prepared> prepared_;  ///< by a thread of its own: it takes seconds
};

/// The page's server for `run`, or nullptr: not wanted, or not built, which is said.
std::unique_ptr<RunPage> open_page(const PreparedRun& run);

/// Where the built page lies; empty when it is not built, after saying how to get it.
std::string find_page();

/// Says where the page is, who can reach it, and opens it where there is a display and somebody at
/// a terminal.
void present_page(const std::string& url, const std::string& address, bool opens_browser);

}  // namespace hg::apps
