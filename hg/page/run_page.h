/// Page of a run: updates its display and executes its commands. It persists over successive runs.
/// Stops do not wait for it: the server passes them to the operator's desk, where the control loop
/// reads them; here they are only reported.
///
/// Used by the observer thread.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/analysis/fault_figures.h"
#include "hg/config/twin_form.h"
#include "hg/live/publisher.h"
#include "hg/page/hand_analysis.h"
#include "hg/runtime/runtime.h"
#include "hg/scenario/options.h"
#include "hg/signals/operator_desk.h"
#include "hg/viewer_server/viewer_server.h"

namespace hg::page {

/// A run as its page sees it. What is pointed at outlives the begin of the next run.
struct ShownRun {
  const config::Scenario* scenario = nullptr;
  const scenario::ScenarioOptions* options = nullptr;  ///< with which the scenario was loaded
  /// Why the device neither waits nor starts again; empty = it does, being simulated here
  std::string refusal;
  /// Why pages start no other run and change neither its pace nor its twin; empty = they may
  std::string fixed_by;
};

class RunPage {
 public:
  /// Callback for every change by a command: name, and description in words.
  using Note = std::function<void(std::string_view name, const std::string& text)>;
  /// Prepares the run that a page has chosen, on a thread of its own, for when take_next() returns
  /// true. Throws SetupError.
  using Prepare = std::function<void(const scenario::ScenarioOptions& options)>;

  RunPage(const viewer_server::ServerOptions& options, const ShownRun& first, Prepare prepare);

  std::string url() const { return server_.url(); }
  /// Pages connected, and how far they are away.
  viewer_server::Counters counters() const { return server_.counters(); }
  /// Sets the delays of the run, in words.
  void set_latency(std::string text) { view_.latency = std::move(text); }

  /// Operator's desk, from which the control loop reads the actions of pages.
  OperatorDesk& desk() { return *desk_; }

  /// Shows `run` from now on. `recording` is the name of its file; `start` is the time of its begin
  /// in that file and in live messages.
  void begin(const ShownRun& run, const std::string& recording,
             std::chrono::system_clock::time_point start);

  /// Processes every sample, in order.
  void observe(const Sample& sample, const Note& note);
  /// Shows the newest sample.
  void show(const Sample& sample);
  void announce(double time_s, std::string_view name, std::string_view text);

  /// Applies hand input and commands. `runtime` is nullptr when the run is over.
  void follow(runtime::Runtime* runtime, const Note& note);

  bool stop_was_asked() const { return stop_was_asked_; }
  /// Whether a chosen run is prepared, and the present one has to end.
  bool has_next() const { return has_next_; }
  /// Whether a chosen run is still being prepared.
  bool is_preparing() const { return prepared_.valid(); }
  /// Whether the prepared run is to be played now; true once.
  bool take_next();

 private:
  /// How the page executes a command.
  struct Order;
  static std::span<const Order> orders();

  /// A mode requested by a page, until a cycle has accepted or refused it.
  struct Asked {
    viewer_server::Command command;
    ModeRequest request = ModeRequest::kNone;
    /// The pause before the request has been seen: requests act on their edge
    bool is_next = false;
    bool is_seen = false;       ///< a cycle has taken the request
    std::uint32_t samples = 0;  ///< number of samples seen since the request is the first
  };

  void answer_asked(const Sample& sample);
  void refuse_asked(std::string_view why);
  void take(const viewer_server::Command& command, runtime::Runtime* runtime, const Note& note);
  void take_prepared(const Note& note);
  void drop_overtaken(const Note& note);
  void note_lost(const Note& note);
  void send_values();
  void take_reference_wrench(runtime::Runtime* runtime, const Note& note);
  bool accepts(const Vector6& w, std::uint64_t client);
  int field_of_wrench(int i) const;
  bool send_wrench(runtime::Runtime& runtime, const Vector6& w);
  void forget_sent(const config::FormField& field);
  void note_done(const viewer_server::Command& command, const Note& note);
  void begin_live(std::chrono::system_clock::time_point start);
  void publish_live(const Sample& sample);

  static std::string refusal_of(const Order& order, const ShownRun& run);

  // Execute a command; return the reason for a refusal, empty = executed or under way.
  std::string set(const viewer_server::Command& command, runtime::Runtime* runtime,
                  const Note& note);
  std::string mark(const viewer_server::Command& command, runtime::Runtime* runtime,
                   const Note& note);
  std::string request_mode(const viewer_server::Command& command, runtime::Runtime* runtime,
                           const Note& note);
  std::string stop(const viewer_server::Command& command, runtime::Runtime* runtime,
                   const Note& note);
  std::string set_pace(const viewer_server::Command& command, runtime::Runtime* runtime,
                       const Note& note);
  std::string choose(const viewer_server::Command& command, runtime::Runtime* runtime,
                     const Note& note);

  viewer_server::Scene scene_of(const ShownRun& run);
  void publish();

  ShownRun run_;
  scenario::ScenarioOptions given_;  ///< with which the program was started
  viewer_server::Choices choices_;   ///< of the scene that is shown
  Prepare prepare_;
  std::uint64_t number_ = 1;
  std::vector<config::FormField> form_;
  std::vector<double> values_;   ///< values of the form, as targets
  bool has_new_values_ = false;  ///< values_ not yet sent to the pages
  std::chrono::steady_clock::time_point values_sent_;
  std::unique_ptr<OperatorDesk> desk_ = std::make_unique<OperatorDesk>();
  viewer_server::ViewerServer server_;
  analysis::Names names_;
  std::optional<HandAnalysis> analysis_;
  std::optional<live::Publisher> live_;  ///< messages of this run for live clients
  std::uint64_t wrench_client_ = 0;      ///< live client that gives the reference wrench; 0 = none
  std::optional<Vector6> next_wrench_;   ///< accepted, and not yet sent as a whole
  Vector6 sent_wrench_ = Vector6::Zero();  ///< components sent last; NaN: unknown
  std::optional<HandTarget> next_target_;  ///< not yet sent
  int marks_ = 0;                          ///< marks in this run
  viewer_server::View view_;
  std::unique_ptr<Sample> newest_;
  bool has_news_ = false;  ///< there is news not yet shown on any page
  bool stop_was_asked_ = false;
  bool has_next_ = false;
  std::pair<std::string, std::string> done_;  ///< last report of the desk: name and text
  std::chrono::steady_clock::time_point done_at_;
  std::deque<Asked> asked_;            ///< requested modes, in order
  viewer_server::Command chosen_;      ///< command from which `prepared_` results
  std::future<std::string> prepared_;  ///< why the chosen run cannot be prepared; empty = it is
};

}  // namespace hg::page
