#include "hg/scenario/options.h"

#include <gtest/gtest.h>

#include <string>

#include "hg/config/law_names.h"
#include "hg/core/open_file.h"
#include "hg/core/test/message_of.h"
#include "hg/core/test/temporary_folder.h"
#include "hg/scenario/names.h"

namespace hg::scenario {
namespace {

TEST(Options, ARecordingKeepsThoseThatDetermineTheCycle) {
  const ScenarioOptions options = {.scenario = "door", .rate_Hz = 500.0, .law = "paper_bounds"};
  EXPECT_EQ(to_text(options), "--rate-hz 500\n--law paper_bounds\n");
  const config::Scenario recorded =
      load_recorded(load({.scenario = "door"}).sources, to_text(options));
  EXPECT_EQ(recorded.device.model.rate_Hz, 500.0);
  EXPECT_EQ(recorded.device.rendering.law, rendering::Law::kPaper);
  EXPECT_EQ(recorded.device.rendering.bounds, rendering::Bounds::kPaper);
}

TEST(Options, EveryPresetSetsTheFourPartsOfTheLaw) {
  const auto parts = [](const char* law) {
    const analysis::RunFacts facts = facts_of_scenario(load({.scenario = "door", .law = law}));
    return facts.law + " " + facts.bounds + " " + facts.gantry + " " + facts.braking;
  };
  EXPECT_EQ(parts(""), "gauss recoverable rule together");
  EXPECT_EQ(parts("gauss"), "gauss recoverable rule alone");
  EXPECT_EQ(parts("gantry"), "gauss recoverable law alone");
  EXPECT_EQ(parts("together"), "gauss recoverable rule together");
  EXPECT_EQ(parts("paper"), "paper recoverable rule alone");
  EXPECT_EQ(parts("paper_bounds"), "paper paper rule alone");
}

TEST(Options, ASinglePartOfTheLawReplacesThatOfThePreset) {
  const ScenarioOptions options = {
      .scenario = "door",
      .law = "paper",
      .changes = {"device.rendering.bounds=paper", "device.rendering.law=together"}};
  const config::Scenario scenario = load(options);
  EXPECT_EQ(config::preset_name(scenario.device.rendering), "paper_bounds");
  const config::Scenario recorded = load_recorded(scenario.sources, to_text(options));
  EXPECT_EQ(config::preset_name(recorded.device.rendering), "paper_bounds");
}

TEST(Options, ARecordingOfAnEarlierVersionKeepsItsPartsOfTheLaw) {
  const config::Scenario recorded = load_recorded(
      load({.scenario = "door"}).sources,
      "--seed 3\n--law paper\n--bounds paper\n--gantry law\n--braking together\n--passivity act\n");
  EXPECT_EQ(recorded.device.rendering.law, rendering::Law::kPaper);
  EXPECT_EQ(recorded.device.rendering.bounds, rendering::Bounds::kPaper);
  EXPECT_EQ(recorded.device.rendering.gantry, rendering::Gantry::kLaw);
  EXPECT_EQ(recorded.device.rendering.braking, rendering::Braking::kTogether);
  EXPECT_EQ(recorded.device.passivity.reaction, passivity::Reaction::kAct);
}

TEST(Options, SurfacesOfAnotherScenarioAreMetAndARecordingHasThem) {
  const ScenarioOptions options = {.scenario = "free_space", .surfaces = "surfaces"};
  const config::Scenario scenario = load(options);
  ASSERT_EQ(scenario.surfaces.size(), 6u);
  EXPECT_EQ(scenario.surfaces.front().name, "table");
  EXPECT_EQ(scenario.title, "Free space");
  EXPECT_TRUE(scenario.events.empty());
  EXPECT_EQ(load_recorded(scenario.sources, to_text(options)).surfaces.size(), 6u);

  const ScenarioOptions changed = {
      .scenario = "free_space", .surfaces = "surfaces", .changes = {"twin.mass_scale=2"}};
  EXPECT_EQ(load(changed).surfaces.size(), 6u);
  EXPECT_TRUE(load({.scenario = "surfaces", .surfaces = "none"}).surfaces.empty());
}

TEST(Options, SurfacesThatDoNotFitAreRefused) {
  const auto message = [](const std::string& surfaces) {
    return message_of([&] { load({.scenario = "door", .surfaces = surfaces}); });
  };
  EXPECT_EQ(message("path"), "--surfaces path: this scenario has no surfaces");
  EXPECT_NE(message("surface").find("did you mean 'surfaces'?"), std::string::npos);
  // a ball around the handle of the door at its start
  const std::string ball =
      "surfaces:\n  - {name: ball, shape: sphere, radius_m: 0.3, placement: {x_m: 0.45, y_m: "
      "-0.26, z_m: -0.8}}\n";
  config::Scenario door = load({.scenario = "door"});
  door.sources.front().content += ball;
  EXPECT_NE(message_of([&] { load_recorded(door.sources, ""); }).find("must not start inside"),
            std::string::npos);
}

TEST(Options, AnotherDeviceLosesTheNameAndRefusesTheFaultsOfTheScenariosOwn) {
  const config::Scenario drawer = load({.scenario = "fr3/open_drawer", .device = "ur10e"});
  EXPECT_EQ(drawer.title, "Drawer");
  EXPECT_EQ(drawer.device.name, "Universal Robots UR10e");
  config::Scenario own = load({.scenario = "fr3/open_drawer"});
  own.sources.front().content += "faults:\n  - {at_s: 1, fault: motor_dead, of: fr3_joint7}\n";
  const std::vector<config::SourceText> device = load({.scenario = "ur10e/open_drawer"}).sources;
  own.sources.insert(own.sources.end(), device.begin(), device.end());
  EXPECT_NE(message_of([&] {
              load_recorded(own.sources, "--device models/arms/ur10e/device.yaml\n");
            }).find("of its own device"),
            std::string::npos);
}

TEST(Options, AnUnknownNameIsRefusedWithItsOption) {
  EXPECT_EQ(message_of([] { load({.scenario = "door", .law = "gaus"}); }),
            "--law: expected one of the names of --help, got 'gaus'");
  EXPECT_NE(message_of([] { load({.scenario = "dor"}); }).find("did you mean 'door'?"),
            std::string::npos);
}

TEST(Options, SetReplacesAndAddsValuesOfAnyFileAndARecordingHasThem) {
  const ScenarioOptions options = {
      .scenario = "door",
      .changes = {"twin.joints.hinge.damping_Nms_per_rad=7.5", "scenario.title=Heavy door",
                  "simulation.factors.friction=1.25", "simulation.seed=9", "twin.mass_scale=2"}};
  const config::Scenario scenario = load(options);
  EXPECT_EQ(scenario.twin.model.dofs[0].damping, 7.5);
  EXPECT_EQ(scenario.twin.model.mass_scale, 2.0);
  EXPECT_EQ(scenario.title, "Heavy door");
  EXPECT_EQ(scenario.device.simulation.factors.friction, 1.25);
  EXPECT_EQ(scenario.device.simulation.sensors.seed, 9U);
  const config::Scenario recorded = load_recorded(scenario.sources, to_text(options));
  EXPECT_EQ(recorded.twin.model.dofs[0].damping, 7.5);
  EXPECT_EQ(hash_of(recorded.sources), hash_of(scenario.sources));
  EXPECT_NE(hash_of(load({.scenario = "door"}).sources), hash_of(scenario.sources));
}

TEST(Options, SetTakesNamesWithDotsInQuotes) {
  const TemporaryFolder folder;
  std::string urdf = read_file("models/twins/door/door.urdf");
  std::string twin = read_file("models/twins/door/twin.yaml");
  const auto rename = [](std::string& text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  };
  rename(urdf, "\"hinge\"", "\"hinge.1\"");
  rename(twin, "hinge", "hinge.1");
  folder.write("door.urdf", urdf);
  const std::string file = folder.write("twin.yaml", twin).string();
  const auto with = [&](const std::string& change) {
    return load({.scenario = "door", .twin = file, .changes = {change}});
  };
  EXPECT_EQ(with("twin.joints.\"hinge.1\".damping_Nms_per_rad=7").twin.model.dofs[0].damping, 7.0);
  EXPECT_NE(message_of([&] {
              with("twin.joints.hinge.damping_Nms_per_rad=7");
            }).find("stands in quotes, as in joints.\"arm.1\""),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              with("twin.joints.\"hinge.1.damping_Nms_per_rad=7");
            }).find("the quotes behind 'joints.' do not end"),
            std::string::npos);
}

TEST(Options, SetChangesTheFileOfAnOption) {
  const config::Scenario scenario =
      load({.scenario = "door",
            .twin = "light",
            .simulation = "harder",
            .changes = {"twin.mass_scale=1.5", "simulation.factors.friction=3"}});
  EXPECT_EQ(scenario.twin.model.mass_scale, 1.5);
  EXPECT_EQ(scenario.device.simulation.factors.friction, 3.0);
}

TEST(Options, AValueThatDoesNotFitIsRefusedAsTheOneThatWasSet) {
  const auto message = [](const char* change) {
    return message_of([&] { load({.scenario = "door", .changes = {change}}); });
  };
  EXPECT_EQ(message("twin.joints.hing.damping_Nms_per_rad=1"),
            "--set twin.joints.hing: must be a joint of the twin, got 'hing', did you mean "
            "'hinge'?");
  EXPECT_EQ(message("simulation.factors.frictio=1"),
            "--set simulation.factors.frictio: unknown key, did you mean 'friction'?");
  EXPECT_EQ(message("twin.mass_scale=much"), "--set twin.mass_scale: must be a number, got 'much'");
  EXPECT_EQ(message("twim.mass_scale=1"),
            "--set twim.mass_scale=1: no such part, did you mean 'twin'?");
  EXPECT_EQ(message("mass_scale"),
            "--set mass_scale: expected PART.KEY=VALUE, as twin.mass_scale=2; a part is scenario, "
            "device, simulation, twin, script");
  EXPECT_EQ(message("scenario.events[99].name=x"),
            "--set scenario.events[99].name: 'events' has 8 entries");
  EXPECT_EQ(
      message("twin.urdf=/etc/passwd"),
      "--set twin.urdf: no such file, got '/etc/passwd'; --set reads no file that the scenario "
      "did not read without it: change the file that names it, or give --twin or --device");
  EXPECT_EQ(message("twin.mass_scale.x=1"), "--set twin.mass_scale: must be a number, got a map");
  EXPECT_EQ(message("twin.joints.\"hin: ge\".damping_Nms_per_rad=1"),
            "--set twin.joints.hin: ge: must be a joint of the twin, got 'hin: ge', did you mean "
            "'hinge'?");
  // the words of a fault count as little in a value as any others
  EXPECT_EQ(message("twin.mass_scale=\": no such file, got \""),
            "--set twin.mass_scale: must be a number, got ': no such file, got '");
  EXPECT_EQ(message("twin.mass_scale=\"did you mean 'a.b'\""),
            "--set twin.mass_scale: must be a number, got 'did you mean 'a.b''");
}

}  // namespace
}  // namespace hg::scenario
