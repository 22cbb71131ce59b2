/// A scenario as a session: its cycle, its simulated device, and an operator who arms and runs it.
///
///     scenario::Session door(file);
///     while (door.advance()) look(door.record());
///
/// Deterministic: cycle k is the same in every session of the same scenario.
#pragma once

#include <filesystem>
#include <memory>

#include "hg/controller/cycle.h"
#include "hg/device/device.h"
#include "hg/runtime/session.h"

namespace hg::config {
struct Scenario;
}

namespace hg::scenario {

/// What a session of a scenario owns, made before it.
struct SessionParts {
  controller::Cycle own_cycle;
  std::unique_ptr<device::Device> own_device;
  std::unique_ptr<TwinForceSource> own_twin_force;
  std::unique_ptr<TwinBaseSource> own_twin_base;
};

/// Session of a scenario, until its planned end. One session serves one thread.
class Session final : private SessionParts, public runtime::Session {
 public:
  /// On the simulated device of the scenario. Throws SetupError.
  explicit Session(const config::Scenario& scenario);
  /// The same of a scenario file.
  explicit Session(const std::filesystem::path& file);
  /// On another device with the same joints. Throws SetupError.
  Session(const config::Scenario& scenario, std::unique_ptr<device::Device> device);

  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
};

}  // namespace hg::scenario
