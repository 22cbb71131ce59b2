/// The extension hapticgiant._run: plays a run of the program inside a Python process.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "hg/core/error.h"
#include "hg/scenario/run/json_lines.h"
#include "hg/scenario/run/plan_options.h"
#include "hg/scenario/run/run_player.h"
#include "python/src/play/remote.h"

namespace nb = nanobind;

namespace hg::python {
namespace {

constexpr std::chrono::milliseconds kLook(50);  // between two looks at Ctrl-C
constexpr std::size_t kMostReports = 100'000;   // that wait

/// Reports between the thread that plays and the one of Python.
class Reports {
 public:
  void push(std::string line, scenario::Worth worth) {
    const std::lock_guard lock(mutex_);
    if (worth == scenario::Worth::kStatus && !waiting_.empty()) return;
    if (waiting_.size() == kMostReports) {
      ++lost_;
      return;
    }
    waiting_.push_back(std::move(line));
    news_.notify_one();
  }

  /// All that wait, after a moment if there are none.
  std::deque<std::string> take() {
    std::unique_lock lock(mutex_);
    news_.wait_for(lock, kLook, [this] { return !waiting_.empty(); });
    std::deque<std::string> taken = std::exchange(waiting_, {});
    if (lost_ > 0) {
      taken.push_front(scenario::to_line({{"lost", std::exchange(lost_, 0)}}));
    }
    return taken;
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<std::string> waiting_;
  std::uint64_t lost_ = 0;  ///< since the last take()
};

/// Hands reports to Python, and keeps the first exception: of Ctrl-C, or of the callable.
class Listener {
 public:
  explicit Listener(nb::object on_report) : on_report_(std::move(on_report)) {}

  /// False from the first exception on. Needs the GIL.
  bool pass(const std::deque<std::string>& lines) {
    try {
      if (!error_ && PyErr_CheckSignals() != 0) throw nb::python_error();
      for (const std::string& line : lines) {
        if (!error_ && !on_report_.is_none()) on_report_(nb::str(line.c_str(), line.size()));
      }
    } catch (nb::python_error& error) {
      error_.emplace(std::move(error));
    }
    return !error_;
  }

  void raise() {
    if (error_) throw std::move(*error_);
  }
  bool has_error() const { return error_.has_value(); }

 private:
  nb::object on_report_;
  std::optional<nb::python_error> error_;
};

struct Played {
  scenario::RunOutcome outcome;
  nb::object error = nb::none();  ///< of Ctrl-C or the callable, after a run in order
};

// Plays in a thread of its own, so that the callable holds nothing up.
Played play(const std::string& request, nb::object on_report) {
  Reports reports;
  std::atomic<bool> stop{false};
  Listener listener(std::move(on_report));
  auto playing = std::async(std::launch::async, [&] {
    scenario::JsonObserver observer([&](const auto& report, scenario::Worth worth) {
      reports.push(scenario::to_line(report), worth);
    });
    return scenario::play(scenario::plan_of_request(request), observer, stop);
  });
  for (bool is_over = false; !is_over;) {
    std::deque<std::string> lines;
    {
      const nb::gil_scoped_release no_gil;
      is_over = playing.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
      lines = reports.take();
    }
    if (!listener.pass(lines)) stop = true;
  }
  Played played{.outcome = playing.get()};
  if (listener.has_error()) {
    try {
      listener.raise();
    } catch (nb::python_error& error) {
      played.error = nb::borrow(error.value());
    }
  }
  return played;
}

nb::tuple play_request(const std::string& request, nb::object on_report) {
  try {
    const Played played = play(request, std::move(on_report));
    const scenario::RunOutcome& outcome = played.outcome;
    return nb::make_tuple(outcome.exit_code, outcome.summary, outcome.recording.string(),
                          played.error);
  } catch (const SetupError& error) {
    const nb::object type = nb::module_::import_("hapticgiant._core").attr("SetupError");
    PyErr_SetString(type.ptr(), error.what());
    throw nb::python_error();
  }
}

}  // namespace
}  // namespace hg::python

NB_MODULE(_run, module) {
  module.doc() = "Whole runs: device, recording, page, streams, summary; and remote machines.";
  module.def("play", &hg::python::play_request, nb::arg("request"),
             nb::arg("on_report") = nb::none(),
             "Plays the run of a JSON request. Returns exit code, summary as JSON, recording, and "
             "the exception that has ended it, or None.");
  hg::python::bind_remote(module);
}
