/// What a run reports while it plays, as data: who prints it, writes it as JSON lines or hands it
/// to Python implements RunObserver.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/signals/state.h"

namespace hg::scenario {

/// Where a run is. Between kMoving and kOver these are the modes of the device.
enum class RunPhase : std::uint8_t {
  kMoving,  ///< a remote device moves to where the twin starts
  kOff,
  kReady,
  kArmed,
  kRunning,
  kStopping,
  kFault,
  kOver,  ///< all files are complete
};

/// "moving", "running", ...
std::string_view to_string(RunPhase phase) noexcept;
RunPhase phase_of(Mode mode) noexcept;

/// Why a run has ended early; a fault of the device.
struct RunFault {
  double time_s = 0.0;
  Fault fault;
  std::string figures;  ///< part, value and limit; empty = none
};

/// The end of one run.
struct RunSummary {
  const nlohmann::ordered_json& json;  ///< as --summary writes it
  std::string text;                    ///< the closing lines for people
  int exit_code = 0;                   ///< as play() returns it
  std::filesystem::path recording;     ///< empty = none
};

/// All functions are called by the thread that plays, in the order of what happens. They delay
/// nothing that stops a device, but samples are lost to page and recording when one of them takes
/// longer than half a second.
class RunObserver {
 public:
  virtual ~RunObserver() = default;

  /// The page is served at `url`, which holds its token.
  virtual void link(const std::string& /*url*/) {}
  /// A phase begins, or what the device waits for has changed: `wanted` says what a person has to
  /// do before it moves; empty = nothing.
  virtual void phase(RunPhase /*phase*/, double /*time_s*/, const std::string& /*wanted*/) {}
  /// Every sample, before what it gives rise to; valid only during the call.
  virtual void sample(const Sample& /*sample*/) {}
  /// An event of the task, or an intervention by a page.
  virtual void event(double /*time_s*/, std::string_view /*name*/, std::string_view /*text*/) {}
  /// The newest sample, ten times per second.
  virtual void status(const Sample& /*sample*/, const config::Scenario& /*scenario*/) {}
  /// Information for people; `label` is what it is about, or empty.
  virtual void note(std::string_view /*label*/, const std::string& /*text*/) {}
  /// Something could not be done; the run continues where it can.
  virtual void problem(const std::string& /*text*/) {}
  virtual void fault(const RunFault& /*fault*/) {}
  /// One run has ended; a page may start another one.
  virtual void summary(const RunSummary& /*summary*/) {}
};

/// Passes everything on to several observers, which must outlive it.
class RunObservers final : public RunObserver {
 public:
  explicit RunObservers(std::vector<RunObserver*> observers) : all_(std::move(observers)) {}

  void link(const std::string& url) override;
  void phase(RunPhase phase, double time_s, const std::string& wanted) override;
  void sample(const Sample& sample) override;
  void event(double time_s, std::string_view name, std::string_view text) override;
  void status(const Sample& sample, const config::Scenario& scenario) override;
  void note(std::string_view label, const std::string& text) override;
  void problem(const std::string& text) override;
  void fault(const RunFault& fault) override;
  void summary(const RunSummary& summary) override;

 private:
  std::vector<RunObserver*> all_;
};

}  // namespace hg::scenario
