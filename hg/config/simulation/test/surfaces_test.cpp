// Virtual surfaces, as a scenario lists them.

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "hg/config/simulation/scenario.h"
#include "hg/core/test/message_of.h"

namespace hg::config {
namespace {

constexpr const char* kPlate = "solid x\nvertex 0 0 0\nvertex 1000 0 0\nvertex 0 1000 0\nendsolid";

// The twin is the door: its handle starts about 0.75 m from its hinge. `of_twin` is appended to
// twin.yaml.
Scenario load_surfaces(const std::string& surfaces, const std::string& of_twin = "") {
  std::vector<SourceText> texts = {
      {"models/scenarios/run.yaml",
       "title: a\ndescription: b\ndevice: ../haptic_giant/device.yaml\n"
       "twin: ../twins/door/twin.yaml\nperson: mouse\nduration_s: 3\nsurfaces:\n" +
           surfaces},
      {"models/scenarios/plate.stl", kPlate},
      {"models/scenarios/bad.stl", "solid x\nvertex 0 zero 0\n"}};
  for (SourceText source : load_scenario("models/scenarios/door.yaml").sources) {
    if (source.name == "models/twins/door/twin.yaml") source.content += of_twin;
    if (source.name != "models/scenarios/door.yaml") texts.push_back(source);
  }
  return load_scenario(texts);
}

std::string message(const std::string& surface) {
  return message_of([&] { load_surfaces("  - " + surface + "\n"); });
}

TEST(Surfaces, HaveShapePlaceAndFeel) {
  const auto surfaces =
      load_surfaces(
          "  - {name: a, placement: {z_m: -5}}\n"
          "  - {name: b, shape: box, size_m: [1, 2, 3], placement: {x_m: 9}, friction: 0.3}\n"
          "  - {name: c, shape: sphere, radius_m: 0.2, placement: {x_m: 9, yaw_rad: 1.570796},\n"
          "     contact: stop}\n"
          "  - {name: d, shape: cylinder, radius_m: 0.1, length_m: 0.4, placement: {x_m: 9},\n"
          "     stiffness_N_per_m: 500, damping_Ns_per_m: 7}\n"
          "  - {name: e, shape: mesh, mesh: plate.stl, scale: 0.001}\n")
          .surfaces;
  ASSERT_EQ(surfaces.size(), 5U);
  EXPECT_TRUE(std::holds_alternative<surfaces::Plane>(surfaces[0].shape));
  EXPECT_EQ(surfaces[0].stiffness, 2000.0);
  EXPECT_EQ(surfaces[0].pose.p, Eigen::Vector3d(0, 0, -5));
  EXPECT_EQ(std::get<surfaces::Box>(surfaces[1].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(surfaces[1].friction, 0.3);
  EXPECT_EQ(std::get<surfaces::Sphere>(surfaces[2].shape).radius, 0.2);
  EXPECT_NEAR(surfaces[2].pose.R(1, 0), 1.0, 1e-6);
  EXPECT_EQ(std::get<surfaces::Cylinder>(surfaces[3].shape).length, 0.4);
  EXPECT_EQ(surfaces[3].stiffness, 500.0);
  EXPECT_EQ(surfaces[3].damping, 7.0);
  EXPECT_FALSE(surfaces[0].damping);
  EXPECT_EQ(surfaces[0].contact, surfaces::Contact::kSpring);
  EXPECT_EQ(surfaces[2].contact, surfaces::Contact::kStop);
  const auto& mesh = std::get<surfaces::Mesh>(surfaces[4].shape);
  ASSERT_EQ(mesh.triangles().size(), 1U);
  EXPECT_EQ(mesh.triangles()[0].corners[1], Eigen::Vector3d(1, 0, 0));
}

TEST(Surfaces, AreRefusedWithTheirPlace) {
  const std::string at = "models/scenarios/run.yaml:8:";
  EXPECT_EQ(
      message("{name: a, shape: spere}"),
      at + "22: surfaces[0].shape: must be one of plane, box, sphere, cylinder, mesh, got 'spere', "
           "did you mean 'sphere'?");
  EXPECT_EQ(message("{name: a, shape: sphere}"), at + "5: surfaces[0]: key 'radius_m' is missing");
  EXPECT_EQ(message("{name: a, shape: box}"), at + "5: surfaces[0]: a box needs 'size_m'");
  EXPECT_EQ(message("{name: a, shape: mesh, mesh: plat.stl}"),
            at + "34: surfaces[0].mesh: no such file, got 'plat.stl'");
  EXPECT_EQ(message("{name: a, shape: mesh, mesh: bad.stl}"),
            "models/scenarios/bad.stl:2: a number is expected after 'vertex', got 'zero'");
  EXPECT_EQ(message("{name: a, stiffness_N_per_m: 1e6}"),
            at + "34: surfaces[0].stiffness_N_per_m: must be 10 .. 50000, got 1e6");
  EXPECT_EQ(message("{name: a, placement: {z_m: -5}, contact: stop, friction: 0.1}"),
            at + "62: surfaces[0].friction: a surface that is a stop has no such key");
  EXPECT_EQ(message("{name: a, placement: {z_m: -5}}\n  - {name: a, placement: {z_m: -5}}"),
            "models/scenarios/run.yaml:9:12: surfaces[1].name: surfaces must not use a name twice");
  EXPECT_EQ(message("{name: a, placement: {z_m: 50}}"),
            "models/scenarios/run.yaml:8:3: surfaces: the end effector of the twin must not start "
            "inside of one, got 'a' around it");
  EXPECT_EQ(message("{name: a, shape: mesh, mesh: plate.stl, scale: 0.001, contact: stop}"),
            "models/scenarios/run.yaml:8:3: surfaces: surface a: a mesh that is a stop must be "
            "closed: each edge that of two triangles, "
            "which run along it in opposite directions");
}

// A post with a radius of 0.05 m, 0.3 m in front of the open side of the door, as a stop.
constexpr const char* kPost =
    "  - {name: post, shape: cylinder, radius_m: 0.05, length_m: 2, contact: stop,\n"
    "     placement: {x_m: 0.6, y_m: 0.1}}\n";

TEST(Surfaces, AreMetBySpheresOnLinksOfTheTwin) {
  const rendering::TwinModel twin =
      load_surfaces(kPost,
                    "collision_spheres:\n"
                    "  - {link: leaf, centre_m: [0.9, 0, 0.1], radius_m: 0.02}\n"
                    "  - {link: handle}\n")
          .twin.model;
  ASSERT_EQ(twin.spheres.size(), 2U);
  EXPECT_EQ(twin.chain.frame_names()[twin.spheres[0].frame], "leaf");
  EXPECT_EQ(twin.spheres[0].p, Eigen::Vector3d(0.9, 0, 0.1));
  EXPECT_EQ(twin.spheres[0].radius, 0.02);
  EXPECT_EQ(twin.spheres[1].frame, twin.end_effector);
  EXPECT_EQ(twin.spheres[1].p, Eigen::Vector3d::Zero());
  EXPECT_EQ(twin.spheres[1].radius, 0.0);
}

std::string message_of_sphere(const std::string& sphere, const std::string& surface = kPost) {
  return message_of([&] { load_surfaces(surface, "collision_spheres:\n  - " + sphere + "\n"); });
}

TEST(Surfaces, SpheresOfTheTwinAreRefusedAtTheirPlace) {
  const std::string at = "models/twins/door/twin.yaml:32:";  // behind the last line of the door
  EXPECT_EQ(message_of_sphere("{link: leav}"),
            at + "12: collision_spheres[0].link: must be a link of the URDF, got 'leav', did you "
                 "mean 'leaf'?");
  EXPECT_EQ(message_of_sphere("{radius_m: 0.1}"),
            at + "5: collision_spheres[0]: key 'link' is missing");
  EXPECT_EQ(message_of_sphere("{link: leaf, radius_m: -0.1}"),
            at + "28: collision_spheres[0].radius_m: must be 0 .. 1000, got -0.1");
  EXPECT_EQ(message_of_sphere("{link: leaf, radius_m: .inf}"),
            at + "28: collision_spheres[0].radius_m: must be 0 .. 1000, got .inf");
  EXPECT_EQ(message_of_sphere("{link: leaf, center_m: [0, 0, 0]}"),
            at + "18: collision_spheres[0].center_m: unknown key, did you mean 'centre_m'?");
  std::string nine = "{link: leaf}";
  for (int i = 1; i < 9; ++i) nine += "\n  - {link: leaf}";
  EXPECT_EQ(message_of_sphere(nine),
            "models/twins/door/twin.yaml:32:3: collision_spheres: at most 8 are possible");
}

TEST(Surfaces, ASphereMustNotStartInsideOfAStop) {
  const std::string refused =
      "models/scenarios/run.yaml:8:3: surfaces: a collision sphere of the twin must not start "
      "inside of one, got 'post' around that of link 'leaf'";
  EXPECT_EQ(message_of_sphere("{link: leaf, centre_m: [0.9, 0.29, 0]}"), refused);
  EXPECT_EQ(message_of_sphere("{link: leaf, centre_m: [0.9, 0, 0], radius_m: 0.26}"), refused);
  EXPECT_EQ(message_of_sphere("{link: leaf, centre_m: [0.9, 0, 0], radius_m: 0.24}"), "no error");
  EXPECT_EQ(
      message_of_sphere(
          "{link: leaf, centre_m: [0.9, 0.29, 0]}",
          "  - {name: post, shape: sphere, radius_m: 0.1, placement: {x_m: 0.6, y_m: 0.1}}\n"),
      "no error");  // a surface with a spring
}

Scenario waiting_for(const std::string& surface) {
  std::string surfaces = kPost;
  surfaces += "  - {name: floor, placement: {z_m: -5}}\n";
  surfaces += "events: [{name: hit, what: a, when: {surface: ";
  surfaces += surface + "}}]\n";
  return load_surfaces(surfaces);
}

TEST(Surfaces, AnEventWaitsForOneByItsName) {
  const Condition condition = waiting_for("floor").events.at(0).all_of.at(0);
  EXPECT_EQ(condition.kind, ConditionKind::kSurface);
  EXPECT_EQ(condition.index, 1);
  EXPECT_EQ(message_of([] { waiting_for("flor"); }),
            "models/scenarios/run.yaml:11:47: events[0].when.surface: must be a surface of the "
            "scenario, got 'flor', did you mean 'floor'?");
}

}  // namespace
}  // namespace hg::config
