#include "hg/scenario/remote/transports.h"

#include <gtest/gtest.h>

#include <set>

#include "hg/core/test/message_of.h"
#include "hg/scenario/options.h"

namespace hg::scenario {
namespace {

TEST(Transports, EachHasItsSchemeAndSaysWhyNoStartTestIsRequired) {
  std::set<std::string_view> schemes;
  for (const Transport* transport : transports()) {
    EXPECT_TRUE(schemes.insert(transport->scheme).second) << transport->scheme;
    EXPECT_NE(transport->reach, nullptr);
    EXPECT_NE(transport->note, nullptr);
    EXPECT_NE(transport->help, "");
  }
  EXPECT_EQ(transports().front()->scheme, "");
}

TEST(Transports, AnAddressLeadsToItsTransport) {
  for (const char* address : {"127.0.0.1:4810", "[::1]:4810", "host"}) {
    EXPECT_EQ(transport_of(address).scheme, "");
  }
  EXPECT_EQ(transport_of("franka://10.0.0.2/speeds").scheme, "franka://");
  EXPECT_EQ(transport_of("ethercat://eth0").scheme, "ethercat://");
}

TEST(Transports, AnUnknownSchemeIsRefusedWithTheNearest) {
  EXPECT_EQ(message_of([] { transport_of("frnka://10.0.0.2"); }),
            "--device-address: no device is reached by 'frnka://', did you mean 'franka://'?");
}

TEST(Transports, AMachineTakesNoInjectedFaults) {
  config::Scenario scenario = load({.scenario = "free_space"});
  EXPECT_EQ(message_of([&] { refuse_faults(scenario, "franka://host"); }), "no error");
  scenario.faults = {{.kind = faults::find_kind("motor_dead"), .magnitude = 1.0}};
  EXPECT_NE(message_of([&] { refuse_faults(scenario, "franka://host"); }).find("motor_dead"),
            std::string::npos);
}

}  // namespace
}  // namespace hg::scenario
