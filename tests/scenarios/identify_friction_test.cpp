// What `hapticgiant identify friction` finds of simulated machines, whose truth is known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hg/experiments/player.h"
#include "hg/identify/friction_traces.h"
#include "hg/scenario/options.h"

namespace hg {
namespace {

using identify::Figure;
using identify::FrictionEstimate;

std::vector<FrictionEstimate> identified(const std::string& simulation) {
  const config::Scenario scenario =
      scenario::load({.scenario = "free_space", .user = "friction", .simulation = simulation});
  identify::FrictionTraces traces(scenario.device.model, scenario.device.control.loop.current_lag);
  experiments::Player player(scenario);
  for (bool is_running = true; is_running; is_running = player.end()) {
    player.begin();
    player.run();
    traces.add(player.sample());
  }
  EXPECT_EQ(player.record().fault.code, FaultCode::kNone);
  std::vector<FrictionEstimate> found;
  for (std::size_t i = 0; i < traces.joints().size(); ++i) {
    found.push_back(
        identify::identify_friction(traces.joints()[i], scenario.device.model.actuators[i]));
  }
  return found;
}

const std::vector<double> kCoulomb = {4.0, 4.0, 2.5, 2.5, 1.0, 1.0};
const std::vector<double> kViscous = {3.0, 3.0, 1.5, 1.5, 0.5, 0.5};

// Within its deviations, or within `share` of the truth, which is what the model leaves out.
void expect_near(const Figure& found, double truth, double share, const char* what) {
  EXPECT_TRUE(found.is_found) << what;
  EXPECT_LT(std::abs(found.value - truth), std::max(3.0 * found.deviation, share * truth))
      << what << " " << found.value << " +- " << found.deviation;
}

// From joint `first` on.
void expect_friction(const std::vector<FrictionEstimate>& found, double factor, std::size_t first) {
  ASSERT_EQ(found.size(), 6u);
  for (std::size_t i = first; i < 6; ++i) {
    SCOPED_TRACE("m" + std::to_string(i + 1));
    expect_near(found[i].coulomb, factor * kCoulomb[i], 0.03, "coulomb");
    expect_near(found[i].viscous, factor * kViscous[i], 0.05, "viscous");
    // docs/concepts/friction.md: the heavier the arm behind a joint, the more of the peak at rest
    // is missed
    expect_near(found[i].stiction, 1.2, i < 2 ? 0.09 : 0.03, "stiction");
    if (i < 5) expect_near(found[i].load, factor * 0.06, 0.05, "load");
  }
  EXPECT_FALSE(found[5].load.is_found) << "m6 carries next to nothing";
}

TEST(IdentifyFriction, FindsThatOfTheShippedSimulationAndNoPresliding) {
  const std::vector<FrictionEstimate> found = identified("");
  expect_friction(found, 1.333, 0);
  for (const FrictionEstimate& joint : found) EXPECT_FALSE(joint.presliding.is_found);
}

TEST(IdentifyFriction, FindsPreslidingOfAnotherSimulation) {
  const std::vector<FrictionEstimate> found = identified("as_published");
  constexpr std::size_t kFirst = 2;  // m1 and m2 are shaken, docs/concepts/friction.md
  expect_friction(found, 1.333, kFirst);
  for (std::size_t i = kFirst; i < found.size(); ++i) {
    EXPECT_EQ(found[i].presliding_elements, 2);
    expect_near(found[i].presliding, 1e-4, 0.08, "presliding");
  }
}

}  // namespace
}  // namespace hg
