#include "hg/check/light_twin.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hg/config/simulation/scenario.h"
#include "hg/experiments/stability_map.h"

namespace hg {
namespace {

class LightTwin : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Arms, LightTwin, testing::Values("fr3", "iiwa14", "ur5e"),
                         [](const auto& arm) { return arm.param; });

// The judge is the simulation: a hand holds a free body and gets a kick.
TEST_P(LightTwin, ShakesInSimulatedHandsBelowWhatCheckStates) {
  using experiments::DecayClass;
  config::Scenario scenario =
      config::load_scenario("models/arms/" + GetParam() + "/move_tool.yaml");
  const experiments::Place place = experiments::place_of(scenario.device);
  scenario = experiments::at_place(scenario, place);
  experiments::StabilityConfig config;
  config.position = place.middle;
  constexpr double kDamping = 4.0;  // Ns/m
  for (const person::HandPreset preset :
       {person::HandPreset::kRelaxed, person::HandPreset::kNormal, person::HandPreset::kStiff}) {
    const std::vector<person::HandImpedance> hand = {person::hand(preset)};
    const config::Scenario held = experiments::kicked(scenario, config, hand[0], 3.0, kDamping);
    const std::vector<double> lightest = check::lightest_bodies(held.device, held.twin, hand);
    ASSERT_EQ(lightest.size(), 1u);
    const auto shakes = [&](double share) {
      const DecayClass verdict =
          experiments::kick(scenario, config, hand[0], share * lightest[0], kDamping).verdict;
      return verdict == DecayClass::kSustained || verdict == DecayClass::kDiverges;
    };
    EXPECT_TRUE(shakes(0.6)) << static_cast<int>(preset);
    EXPECT_FALSE(shakes(1.6)) << static_cast<int>(preset);
  }
}

}  // namespace
}  // namespace hg
