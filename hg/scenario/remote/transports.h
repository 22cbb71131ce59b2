/// The transports to a device that is not simulated here: one entry for each kind of address.
///
/// A driver adds its entry to transports(), and nothing else knows it; docs/start/own_driver.md.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hg/config/simulation/scenario.h"
#include "hg/core/types.h"
#include "hg/device/connected_device.h"

namespace hg::scenario {

/// What a transport needs to reach a device; set-up data.
struct LinkRequest {
  std::string address;       ///< --device-address, with its scheme
  std::string machine_file;  ///< --machine; empty = the one beside the device file
  std::string key_file;      ///< --key-file; empty = none
  std::string client;        ///< name that the device is given
  bool is_fast = false;      ///< lock-step
  /// A session of this program has just ended, which the device may not know yet.
  bool follows_session = false;
};

/// What is known of a device before a session that drives it.
struct Contact {
  bool is_simulated = false;      ///< the computer need not be ready
  bool needs_start_test = false;  ///< a machine whose brakes `hapticgiant start-test` tests
  /// Session by which this is known; nullptr = none was needed
  std::unique_ptr<device::ConnectedDevice> session;
  /// Opens another session. Throws SetupError.
  std::function<std::unique_ptr<device::ConnectedDevice>()> open;
};

struct Transport {
  std::string_view scheme;  ///< beginning of its addresses, "franka://"; empty = HOST:PORT
  std::string_view help;    ///< form and kind of device, for the help of --device-address
  /// Why --key-file and --fast are refused; empty = they are not, or only by the device.
  std::string_view key_refusal, fast_refusal;
  /// Why start-test and commission are refused; empty = they are possible.
  std::string_view start_test_refusal, commission_refusal;
  /// Why both are refused for a device that is a simulation; empty = they are possible.
  std::string_view simulation_refusal;
  /// `hapticgiant commission` tests that the device stops when no commands come.
  bool tests_silence = false;
  /// Reaches the device of the scenario. Files that describe the machine become sources of the
  /// scenario. Throws SetupError.
  Contact (*reach)(const LinkRequest& request, config::Scenario& scenario) = nullptr;
  /// Why a device of this transport needs no start test, where Contact says so.
  std::string (*note)(const device::ConnectedDevice& device) = nullptr;
  /// Moves a device of this transport to the joint positions q_m (rad or m) by its own motion, in a
  /// real-time thread. nullptr = it moves by the law. Throws SetupError.
  void (*move_to)(device::ConnectedDevice& device, const VectorM& q_m) = nullptr;
};

/// All of them, the one without a scheme first.
std::span<const Transport* const> transports();

/// The transport of an address of --device-address, which is not empty. Throws SetupError for an
/// unknown scheme, with the nearest one.
const Transport& transport_of(const std::string& address);

/// Throws SetupError if the scenario injects faults, which only a simulated device takes.
void refuse_faults(const config::Scenario& scenario, const std::string& address);

}  // namespace hg::scenario
