#include "hg/scenario/run/connection.h"

#include <fmt/format.h>

#include <future>
#include <utility>

#include "hg/core/error.h"
#include "hg/doctor/gate.h"
#include "hg/runtime/control_thread.h"
#include "hg/scenario/remote/transports.h"
#include "hg/scenario/run/version.h"
#include "hg/scenario/start_posture.h"

namespace hg::scenario {
namespace {

void refuse(const char* option, bool is_given, std::string_view why) {
  if (is_given && !why.empty()) throw SetupError(fmt::format("{}: {}", option, why));
}

// In lock-step a late computer does no harm.
std::string check_computer(const MachineAddress& machine, const RunTiming& timing,
                           const config::Scenario& scenario) {
  if (timing.is_fast) return {};
  return doctor::check_ready(scenario.device.model.rate_Hz,
                             {.priority = timing.priority, .cpu = timing.cpu}, machine.despite);
}

Contact reach(const Transport& transport, const MachineAddress& machine, const RunTiming& timing,
              config::Scenario& scenario, const std::string& command) {
  refuse("--fast", timing.is_fast, transport.fast_refusal);
  refuse("--key-file", !machine.key_file.empty(), transport.key_refusal);
  return transport.reach({.address = machine.address,
                          .machine_file = machine.machine_file,
                          .key_file = machine.key_file,
                          .client = fmt::format("hapticgiant {} {}", command, version()),
                          .is_fast = timing.is_fast,
                          .follows_session = machine.moves_to_start},
                         scenario);
}

// The computer is checked without a session, which would have to be served meanwhile.
void open_if_ready(Contact& contact, Connection& connection, const MachineAddress& machine,
                   const RunTiming& timing, const config::Scenario& scenario) {
  if (contact.session != nullptr && !contact.is_simulated) {
    contact.session->close(FaultCode::kNone);
    contact.session.reset();
  }
  if (contact.session == nullptr) {
    if (!contact.is_simulated) connection.computer = check_computer(machine, timing, scenario);
    contact.session = contact.open();
  }
  connection.device = std::move(contact.session);
  connection.is_simulated = contact.is_simulated;
}

void move_alone(const Transport& transport, device::ConnectedDevice& device,
                const RunTiming& timing, const config::Scenario& scenario) {
  const VectorM start = find_start(scenario.device, scenario.twin).q_m;
  std::async(std::launch::async, [&] {
    runtime::become_real_time({.priority = timing.priority, .cpu = timing.cpu});
    transport.move_to(device, start);
  }).get();
}

}  // namespace

start_test::MachineMemory machine_memory(const MachineAddress& machine, const std::string& folder) {
  return {.folder = folder,
          .address = machine.address,
          .without_start_test = machine.without_start_test,
          .confirmed_joints = machine.confirmed_joints};
}

Connection connect_to_run(const MachineAddress& machine, const RunTiming& timing,
                          const std::string& folder, config::Scenario& scenario) {
  const Transport& transport = transport_of(machine.address);
  Contact contact = reach(transport, machine, timing, scenario, "run");
  const start_test::MachineMemory memory = machine_memory(machine, folder);
  Connection connection{.is_machine = contact.needs_start_test};
  const bool has_session = contact.session != nullptr;
  if (connection.is_machine) {
    connection.start_test = start_test::check_start_test(memory, scenario.device);
  }
  if (connection.is_machine && has_session) {
    connection.posture = start_test::check_posture(memory, scenario.device, *contact.session);
  }
  open_if_ready(contact, connection, machine, timing, scenario);
  if (connection.is_machine && !has_session) {
    connection.posture = start_test::check_posture(memory, scenario.device, *connection.device);
  }
  if (machine.moves_to_start && transport.move_to != nullptr) {
    move_alone(transport, *connection.device, timing, scenario);
  }
  if (!connection.is_machine) connection.note = transport.note(*connection.device);
  return connection;
}

Connection connect_to_test(const MachineAddress& machine, const RunTiming& timing,
                           config::Scenario& scenario, const std::string& command) {
  const Transport& transport = transport_of(machine.address);
  Contact contact = reach(transport, machine, timing, scenario, command);
  refuse(command.c_str(), contact.is_simulated, transport.simulation_refusal);
  Connection connection;
  open_if_ready(contact, connection, machine, timing, scenario);
  return connection;
}

bool moves_by_law(const MachineAddress& machine) {
  return machine.moves_to_start && transport_of(machine.address).move_to == nullptr;
}

std::string close_device(device::ConnectedDevice& device, FaultCode fault) {
  device.close(fault);
  return device.farewell();
}

}  // namespace hg::scenario
