/// A device as the station of a start test: its control cycle runs period by period, and a person
/// or a simulated operator acts.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "hg/config/simulation/scenario.h"
#include "hg/scenario/session.h"
#include "hg/start_test/procedure.h"
#include "hg/start_test/simulated_operator.h"

namespace hg::start_test {

/// The joints to test, with the least load of each: a brake that holds less than twice the friction
/// of its joint proves nothing.
Setup setup_of(const config::DeviceConfig& device, bool is_simulated);

class DeviceStation final : public Station {
 public:
  /// Prints requests to the operator ("-> ...") and results; `time_s` is the device's clock.
  using Print = std::function<void(double time_s, const std::string& words)>;

  /// `scenario` and `interrupted`, which ends the test once true, must outlive the station. Throws
  /// SetupError.
  DeviceStation(const config::Scenario& scenario, std::unique_ptr<device::Device> device,
                bool is_simulated, const std::atomic<bool>& interrupted, Print print);

  Observation advance(Wish wish) override;
  void prompt(Act act, const std::string& words) override;
  void report(const std::string& words) override;

  /// Switches the drives off.
  void release();
  /// Fault that ended the connection; kNone = the device is still connected.
  FaultCode end() const { return end_; }

 private:
  ModeRequest request(Wish wish) const;
  Observation observe(Wish wish);

  scenario::Session session_;
  const DeviceModel& model_;
  model::ChainData chain_;  ///< in the posture of the last usable sample
  const bool is_simulated_;
  const std::atomic<bool>& interrupted_;
  const Print print_;
  SimulatedOperator operator_;
  bool had_motor_side_ = false;
  FaultCode end_ = FaultCode::kNone;
};

}  // namespace hg::start_test
