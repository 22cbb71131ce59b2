#include "hg/scenario/remote/franka_setup.h"

#include <fmt/format.h>

#include <string_view>

#include "hg/controller/tracking/joint_control.h"
#include "hg/core/error.h"

namespace hg::scenario {
namespace {

constexpr std::string_view kScheme = "franka://";
constexpr std::string_view kSpeeds = "/speeds";
constexpr const char* kShipped = "models/arms/fr3/fci.yaml is such a device: --device fr3/fci";

franka::Interface interface_of(const std::string& text) {
  return text.ends_with(kSpeeds) ? franka::Interface::kSpeeds : franka::Interface::kTorques;
}

udp::Address address_of(const std::string& text) {
  std::string host = text.substr(kScheme.size());
  if (host.ends_with(kSpeeds)) host.resize(host.size() - kSpeeds.size());
  while (host.ends_with('/')) host.pop_back();
  if (host.empty() || host.find('/') != std::string::npos) {
    throw SetupError(
        "--device-address: expected franka://HOST or franka://HOST:PORT, or one of them with "
        "/speeds, got '" +
        text + "'");
  }
  if (host.find(':') == std::string::npos) host += std::string(":") + franka::kCommandPort;
  return udp::parse_address("--device-address", host);
}

void check_device(const config::DeviceConfig& device) {
  const auto refuse = [&](const std::string& why) {
    throw SetupError(fmt::format("{}: {}; {}", device.name, why, kShipped));
  };
  if (device.model.n_p != 0 || device.model.n_m != franka::kJoints) {
    refuse(fmt::format("a Franka has 7 joints and no gantry, this device {} and {}",
                       device.model.n_m, device.model.n_p));
  }
  if (device.model.rate_Hz * franka::kPeriod_s != 1.0) {
    refuse(fmt::format("rate_Hz: a Franka runs at 1000 Hz, got {:g}", device.model.rate_Hz));
  }
  if (device.control.method != tracking::Method::kDrives) {
    refuse(
        "actuators: a Franka controls its motors itself and is led along a reference, so its "
        "device "
        "file lists no actuators");
  }
  if (device.estimation.wrench.payload.mass > 0.0) {
    refuse(
        "payload: the robot subtracts the weight of the tool from its estimate, so no payload is "
        "given");
  }
  if (!device.chain_options.tool) refuse("tool: a Franka needs a tool on its flange");
}

franka::LoadRequest load_of(const model::Tool& tool) {
  franka::LoadRequest load;
  load.mass = tool.mass;
  std::array<double, 3> com;
  Eigen::Map<Eigen::Vector3d>(com.data()) = tool.p_com;
  std::array<double, 9> inertia;
  Eigen::Map<Eigen::Matrix3d>(inertia.data()) = tool.inertia;
  load.p_F_load = com;
  load.inertia = inertia;
  return load;
}

Contact reach(const LinkRequest& request, config::Scenario& scenario) {
  return {
      .open = [address = request.address, &scenario] { return connect_franka(address, scenario); }};
}

std::string note_on(const device::ConnectedDevice& device) {
  std::string note = "a Franka tests its brakes and stops itself: no start test is required";
  if (!static_cast<const franka::FrankaDevice&>(device).has_checked_signs()) {
    note +=
        "; the weight of the tool does not appear in its estimate: push lightly first, and see "
        "that the arm yields that way";
  }
  return note;
}

void move_to(device::ConnectedDevice& device, const VectorM& q_m) {
  static_cast<franka::FrankaDevice&>(device).move_to(q_m);
}

}  // namespace

const Transport kFrankaTransport = {
    .scheme = kScheme,
    .help = "franka://HOST of a Franka FR3 (docs/start/franka.md)",
    .key_refusal = "a Franka's protocol has no key",
    .fast_refusal = "a Franka keeps its own time, leave it out",
    .start_test_refusal = "a Franka tests its brakes and stop inputs itself, see Desk",
    .commission_refusal = "a Franka is commissioned by its maker, see Desk",
    .reach = &reach,
    .note = &note_on,
    .move_to = &move_to};

franka::FrankaConfig franka_config(const std::string& address, const config::Scenario& scenario) {
  const config::DeviceConfig& device = scenario.device;
  franka::FrankaConfig result;
  result.address = address_of(address);
  result.interface = interface_of(address);
  check_device(device);
  refuse_faults(scenario, address);
  const model::Tool& tool = *device.chain_options.tool;
  result.load = load_of(tool);
  result.flange = tool.link;
  result.T_F_S = tool.T_link_handle * device.model.T_H_S;
  return result;
}

std::unique_ptr<franka::FrankaDevice> connect_franka(const std::string& address,
                                                     const config::Scenario& scenario) {
  return std::make_unique<franka::FrankaDevice>(franka_config(address, scenario),
                                                scenario.device.model.chain);
}

}  // namespace hg::scenario
