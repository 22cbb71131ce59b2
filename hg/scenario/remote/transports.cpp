#include "hg/scenario/remote/transports.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "hg/core/error.h"
#include "hg/core/nearest_name.h"
#include "hg/scenario/remote/ethercat_setup.h"
#include "hg/scenario/remote/franka_setup.h"
#include "hg/scenario/remote/remote_setup.h"

namespace hg::scenario {
namespace {

constexpr std::array kTransports = {&kUdpTransport, &kFrankaTransport, &kEthercatTransport};

constexpr std::string_view kSlashes = "://";

}  // namespace

std::span<const Transport* const> transports() { return kTransports; }

const Transport& transport_of(const std::string& address) {
  const std::size_t end = address.find(kSlashes);
  const std::string scheme =
      end == std::string::npos ? "" : address.substr(0, end + kSlashes.size());
  std::vector<std::string> known;
  for (const Transport* transport : kTransports) {
    if (transport->scheme == scheme) return *transport;
    if (!transport->scheme.empty()) known.emplace_back(transport->scheme);
  }
  throw SetupError(fmt::format("--device-address: no device is reached by '{}', did you mean '{}'?",
                               scheme, nearest_name(scheme, known)));
}

void refuse_faults(const config::Scenario& scenario, const std::string& address) {
  if (scenario.faults.empty()) return;
  throw SetupError(fmt::format(
      "faults: the device at {} is a machine, only a simulated one takes injected faults, got {}",
      address, scenario.faults.front().kind->name));
}

}  // namespace hg::scenario
