#include "hg/start_test/machine_memory.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <exception>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "hg/core/error.h"
#include "hg/core/open_file.h"
#include "hg/core/whole_file.h"
#include "hg/signals/off_command.h"

namespace hg::start_test {
namespace {

constexpr double kBraked = 0.2;   // s after which brakes have closed and nothing moves any more
constexpr double kWatched = 1.0;  // s in which nothing may move then

// Text of a file; empty if there is none. Throws SetupError if it cannot be read.
std::optional<std::string> text_of(const std::string& file) {
  constexpr std::uintmax_t kMost = 1'000'000;  // bytes
  if (access(file.c_str(), F_OK) != 0 && errno == ENOENT) return std::nullopt;
  return read_file(file, kMost);
}

std::string posture_file(const MachineMemory& memory, const config::DeviceConfig& device) {
  return file_of(memory.folder, "posture", device.name, memory.address);
}

std::vector<Position> posture_of(const config::DeviceConfig& device, const SensorFrame& sensors) {
  std::vector<Position> posture;
  const std::vector<model::Joint>& joints = device.model.chain.joints();
  for (int i = 0; i < device.model.n_p + device.model.n_m; ++i) {
    const model::Joint& joint = joints[i];
    const bool is_gantry = i < device.model.n_p;
    posture.push_back({.name = joint.name,
                       .value = is_gantry ? sensors.q_p[i] : sensors.q_m[i - device.model.n_p],
                       .is_slide = joint.is_slide(),
                       .is_endless = joint.type == model::JointType::kContinuous});
  }
  return posture;
}

// Posture with drives off and brakes closed; empty if the connection to the device is lost.
std::optional<std::vector<Position>> braked_posture(const config::DeviceConfig& device,
                                                    device::ConnectedDevice& machine,
                                                    double duration_s = kBraked) {
  SensorFrame sensors;
  CommandFrame off = off_command(device.model.n_p, device.model.n_m,
                                 device.control.method != tracking::Method::kDrives);
  for (double time_s = 0.0; time_s < duration_s; time_s += 1.0 / device.model.rate_Hz) {
    machine.read(sensors);
    if (sensors.driver_fault != FaultCode::kNone) return std::nullopt;
    off.sequence = sensors.sequence;
    off.q_m = sensors.q_m;
    machine.write(off);
  }
  return posture_of(device, sensors);
}

// Names of joints and axes that move although their brakes are closed.
std::vector<std::string> slipping(const config::DeviceConfig& device,
                                  const std::vector<Position>& from,
                                  const std::vector<Position>& to) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const double moved = to[i].value - from[i].value;
    const double most =
        from[i].is_slide ? device.monitor.slide_brake_slip : device.monitor.brake_slip;
    if (std::abs(moved) > most) names.push_back(from[i].name);
  }
  return names;
}

}  // namespace

std::string sha256_of(const config::DeviceConfig& device) {
  std::vector<std::string_view> texts;
  for (const config::SourceText& source : device.sources) texts.push_back(source.content);
  return sha256(texts);
}

std::string start_test_file(const std::string& folder, const config::DeviceConfig& device,
                            const std::string& address) {
  return file_of(folder, "start_test", device.name, address.empty() ? "simulated" : address);
}

std::string commission_file(const std::string& folder, const config::DeviceConfig& device,
                            const std::string& address) {
  return file_of(folder, "commission", device.name, address.empty() ? "simulated" : address);
}

std::string check_start_test(const MachineMemory& memory, const config::DeviceConfig& device) {
  const std::string file = start_test_file(memory.folder, device, memory.address);
  Validity validity = {.objection = "there is none"};
  try {
    if (const std::optional<std::string> kept = text_of(file)) {
      validity = check_validity(*kept, {.device = device.name,
                                        .address = memory.address,
                                        .files_sha256 = sha256_of(device),
                                        .valid_for_s = device.start_test.valid_for_s,
                                        .now = std::time(nullptr)});
    }
  } catch (const SetupError& error) {
    validity.objection = error.what();
  }
  if (validity.objection.empty()) {
    return validity.untested.empty() ? fmt::format("passed {}", validity.ended)
                                     : fmt::format("passed {}; not tested: {}", validity.ended,
                                                   fmt::join(validity.untested, ", "));
  }
  if (memory.without_start_test) {
    return fmt::format("BRAKES AND STOP INPUTS ARE NOT TESTED: {}", validity.objection);
  }
  throw SetupError(fmt::format(
      "{}: no start test of {} that counts: {}; test brakes and stop inputs with 'hapticgiant "
      "start-test --device-address {}' and the same device, or run with --without-start-test",
      file, device.name, validity.objection, memory.address));
}

std::string check_posture(const MachineMemory& memory, const config::DeviceConfig& device,
                          device::ConnectedDevice& machine) {
  const auto now = braked_posture(device, machine);
  if (!now) {
    throw SetupError(fmt::format("{}: the device has gone before it was armed {}", memory.address,
                                 machine.farewell()));
  }
  for (const std::string& name : memory.confirmed_joints) {
    if (std::ranges::find(*now, name, &Position::name) != now->end()) continue;
    throw SetupError(fmt::format("--posture-confirmed: {} has no joint '{}'", device.name, name));
  }
  const std::string file = posture_file(memory, device);
  const std::optional<std::string> kept = text_of(file);
  if (!kept) return "nothing is known of the last run: homing was not compared";
  std::vector<Moved> moved;
  try {
    moved = compare_posture(*kept, memory.address, *now, device.start_test);
  } catch (const SetupError& error) {
    throw SetupError(fmt::format("{}: {}; look where the machine stands, then delete the file",
                                 file, error.what()));
  }
  std::string lines, names;
  for (const Moved& joint : moved) {
    if (std::ranges::find(memory.confirmed_joints, joint.name) != memory.confirmed_joints.end()) {
      continue;
    }
    lines += "  " + joint.words + "\n";
    names += (names.empty() ? "" : ",") + joint.name;
  }
  if (names.empty()) {
    return moved.empty() ? "stands where the last run has left it"
                         : "stands elsewhere than the last run has left it, as was confirmed";
  }
  throw SetupError(
      fmt::format("{}: {} stands elsewhere than the last run has left it:\n{}look at the machine: "
                  "home it where "
                  "these values are wrong; where they are right run with --posture-confirmed {}",
                  file, device.name, lines, names));
}

std::vector<std::string> leave_machine(const MachineMemory& memory,
                                       const config::DeviceConfig& device,
                                       device::ConnectedDevice& machine, FaultCode fault) {
  std::vector<std::string> lines;
  const auto braked = braked_posture(device, machine);
  const auto now = braked ? braked_posture(device, machine, kWatched) : std::nullopt;
  const std::vector<std::string> names =
      now ? slipping(device, *braked, *now) : std::vector<std::string>{};
  if (!names.empty()) {
    lines.push_back(
        fmt::format("brakes       {} MOVES WITH ITS BRAKE CLOSED", fmt::join(names, ", ")));
  }
  if (!names.empty() || fault == FaultCode::kBrakesSlip) {
    std::error_code ignored;  // there may be none
    std::filesystem::remove(start_test_file(memory.folder, device, memory.address), ignored);
    lines.push_back("start test   counts no more, because a brake did not hold");
  }
  if (!now) {
    lines.push_back(
        "posture      not kept, because the device has gone: the next run compares with an older "
        "one");
    return lines;
  }
  try {
    make_folder(memory.folder);
    write_whole_file(posture_file(memory, device),
                     posture_to_json(device.name, memory.address, std::time(nullptr), *now));
  } catch (const std::exception& error) {
    lines.push_back(fmt::format("posture      not kept: {}", error.what()));
  }
  return lines;
}

}  // namespace hg::start_test
