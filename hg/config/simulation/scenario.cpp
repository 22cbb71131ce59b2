#include "hg/config/simulation/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hg/config/file_kind.h"
#include "hg/config/loader.h"
#include "hg/config/simulation/scenario_schema.h"
#include "hg/controller/rendering/catalogue.h"
#include "hg/controller/rendering/surfaces/cast.h"
#include "hg/controller/rendering/surfaces/nearest.h"
#include "hg/core/error.h"
#include "hg/model/chain_data.h"

namespace hg::config {

namespace {

// What load() returns; its faults join those of the scenario.
template <class Load>
auto part(LoaderFile& file, const std::filesystem::path& path, Load load)
    -> std::optional<decltype(load())> {
  if (path.empty()) return {};
  try {
    return load();
  } catch (const SetupError& error) {
    file.faults.add_all(error);
    return {};
  }
}

EventNames names_of(const DeviceConfig& device, const Twin& twin, const LimitCatalogue& catalogue) {
  EventNames names;
  for (const LimitInfo& limit : catalogue) names.limits.push_back(limit.name);
  const std::size_t first_twin_limit = catalogue.size() - twin.model.dofs.size();
  for (std::size_t i = 0; i < twin.model.dofs.size(); ++i) {
    if (twin.model.dofs[i].q_index < 0) continue;
    names.twin_joints.push_back(twin.model.dofs[i].name);
    names.twin_limits.push_back(static_cast<int>(first_twin_limit + i));
    names.twin_coordinates.push_back(twin.model.dofs[i].q_index);
  }
  for (int i = 0; i < device.model.n_m; ++i) {
    names.manipulator.push_back(device.model.manipulator_joint(i));
  }
  for (int i = 0; i < device.model.n_p; ++i) {
    names.gantry.push_back(device.model.chain.joints()[i].name);
  }
  return names;
}

// Whether a sphere of a twin at its start is inside of a surface.
bool is_inside(const surfaces::Surface& surface, const Eigen::Vector3d& centre, double radius) {
  bool is_near = surfaces::is_inside(surface, centre);
  surfaces::for_each_facing(surface, centre, radius, [&](const surfaces::Facing& facing) {
    is_near = is_near || (facing.distance >= 0.0 && facing.distance < radius);
  });
  return is_near;
}

// Calls refuse(rule, where) for everything of the twin that starts inside of `surface`.
template <class Refuse>
void find_inside(const surfaces::Surface& surface, const rendering::TwinModel& twin,
                 const Refuse& refuse) {
  model::ChainData start(twin.chain);
  start.update_poses(twin.q_start);
  if (surfaces::is_inside(surface, start.pose(twin.end_effector).p)) {
    refuse("the end effector of the twin must not start inside of one",
           "'" + surface.name + "' around it");
  }
  if (surface.contact != surfaces::Contact::kStop) return;
  for (const rendering::CollisionSphere& sphere : twin.spheres) {
    const Pose& T_B_link = start.pose(sphere.frame);
    const Eigen::Vector3d centre = T_B_link.p + T_B_link.R * sphere.p;
    if (!is_inside(surface, centre, sphere.radius)) continue;
    refuse("a collision sphere of the twin must not start inside of one",
           fmt::format("'{}' around that of link '{}'", surface.name,
                       twin.chain.frame_names()[sphere.frame]));
  }
}

std::vector<surfaces::Surface> load_surfaces(Loader& loader, LoaderFile& file,
                                             const rendering::TwinModel& twin,
                                             std::vector<std::string>& names) {
  std::vector<SurfaceDraft> drafts;
  const std::size_t faults = file.faults.count();
  describe_surfaces(loader, drafts);
  for (const SurfaceDraft& draft : drafts) names.push_back(draft.surface.name);
  if (file.faults.count() > faults) return {};
  std::vector<surfaces::Surface> surfaces;
  for (const SurfaceDraft& draft : drafts) {
    try {
      surfaces.push_back(surface_of(draft, file.sources));
    } catch (const SetupError& error) {
      file.faults.add_all(error);
      continue;
    }
    find_inside(surfaces.back(), twin, [&](const char* rule, const std::string& where) {
      loader.rule(false, "surfaces", rule, where);
    });
  }
  try {
    surfaces::check_surfaces(surfaces);
  } catch (const SetupError& error) {
    loader.rule(false, "surfaces", error.what());
  }
  return surfaces;
}

std::optional<BystanderInTheWay> in_the_way(BystanderDraft draft) {
  if (!draft.bystander) return {};
  return BystanderInTheWay{*draft.bystander, std::move(draft.hit_by)};
}

Scenario load(const std::filesystem::path& path, SourceReader& reader) {
  LoaderFile file = {path, reader, Faults(path.generic_string())};
  ScenarioDraft draft;
  ChangesDraft changes;
  InjectionsDraft injections;
  BystanderDraft bystander;
  TeleoperationDraft teleoperation;
  std::vector<surfaces::Surface> surfaces;
  std::vector<TimedPanel> panel;
  std::optional<SimulatedDeviceConfig> device;
  std::optional<Twin> twin;
  std::optional<Script> script = Script{};
  LimitCatalogue catalogue;
  load_file_of_kind(FileKind::kScenario, file, [&](Loader& loader) {
    describe_parts(loader, draft);
    device = part(file, draft.device, [&] { return load_simulated_device(draft.device, reader); });
    twin = part(file, draft.twin, [&] { return load_twin(draft.twin, reader, draft.moves()); });
    if (twin && !draft.script.empty()) {
      script =
          part(file, draft.script, [&] { return load_script(draft.script, twin->model, reader); });
    }
    if (!device || !twin || !script) file.faults.throw_if_any();
    catalogue = rendering::make_catalogue(device->model, twin->model);
    for (const std::string& name : rendering::repeated_names(catalogue)) {
      loader.rule(false, "twin", "device and twin together must not use a name twice",
                  "'" + name + "'");
    }
    draft.names = names_of(*device, *twin, catalogue);
    surfaces = load_surfaces(loader, file, twin->model, draft.names.surfaces);
    describe_events(loader, draft);
    changes = changes_of(twin->model);
    describe_changes(loader, changes);
    describe_panel(loader, panel);
    injections = injections_of(draft.names.manipulator, draft.names.gantry);
    describe_injections(loader, injections);
    bystander = bystander_of(device->model.chain.frame_names());
    describe_bystander(loader, bystander);
    teleoperation = teleoperation_of(twin->model);
    describe_teleoperation(loader, teleoperation, changes);
  });

  return {.title = draft.title,
          .description = draft.description,
          .duration_s = draft.duration_s,
          .device = std::move(*device),
          .twin = std::move(*twin),
          .person = draft.person,
          .script = std::move(*script),
          .limits = std::move(catalogue),
          .events = std::move(draft.events),
          .changes = std::move(changes.changes),
          .panel = std::move(panel),
          .faults = std::move(injections.injections),
          .surfaces = std::move(surfaces),
          .bystander = in_the_way(std::move(bystander)),
          .teleoperation = teleoperation_of(teleoperation),
          .twin_motion = std::move(draft.twin_motion),
          .sources = reader.texts(),
          .places = std::move(file.places)};
}

}  // namespace

Scenario load_scenario(const std::filesystem::path& file) {
  SourceReader reader;
  return load(file, reader);
}

Scenario load_scenario(std::vector<SourceText> recorded) {
  if (recorded.empty()) throw SetupError("recording: holds no configuration");
  const std::filesystem::path file = recorded.front().name;
  SourceReader reader(std::move(recorded));
  return load(file, reader);
}

Scenario load_scenario(const std::filesystem::path& file, SourceReader& reader) {
  return load(file, reader);
}

void check_start_outside(const std::vector<surfaces::Surface>& surfaces,
                         const rendering::TwinModel& twin) {
  for (const surfaces::Surface& surface : surfaces) {
    find_inside(surface, twin, [](const char* rule, const std::string& where) {
      throw SetupError(fmt::format("surfaces: {}, got {}", rule, where));
    });
  }
}

void settle_law(Scenario& scenario) {
  settle_law(scenario.device);
  const LimitCatalogue before = std::move(scenario.limits);
  scenario.limits = rendering::make_catalogue(scenario.device.model, scenario.twin.model);
  for (EventRule& event : scenario.events) {
    for (Condition& condition : event.all_of) {
      using enum ConditionKind;
      const bool is_of_limit =
          condition.kind == kLimit || condition.kind == kSpeedLimit || condition.kind == kLocked;
      if (!is_of_limit) continue;
      const std::string& name = before[condition.index].name;
      const auto limit = std::ranges::find(scenario.limits, name, &LimitInfo::name);
      if (limit == scenario.limits.end()) {
        throw SetupError("event '" + event.name + "': waits for '" + name +
                         "', which is a limit only where the law models the torques of the motors: "
                         "law gauss, bounds recoverable, plant elastic");
      }
      condition.index = static_cast<int>(limit - scenario.limits.begin());
    }
  }
}

surfaces::Surface surface_of(const SurfaceDraft& draft, SourceReader& reader) {
  surfaces::Surface surface = draft.surface;
  surface.pose = pose_of(draft.placement);
  if (!std::isnan(draft.damping)) surface.damping = draft.damping;
  switch (draft.shape) {
    case SurfaceShape::kPlane:
      break;
    case SurfaceShape::kBox:
      surface.shape = surfaces::Box{draft.size};
      break;
    case SurfaceShape::kSphere:
      surface.shape = surfaces::Sphere{draft.radius};
      break;
    case SurfaceShape::kCylinder:
      surface.shape = surfaces::Cylinder{draft.radius, draft.length};
      break;
    case SurfaceShape::kMesh:
      surface.shape =
          surfaces::read_stl(reader.read(draft.mesh), draft.mesh.generic_string(), draft.scale);
      break;
  }
  return surface;
}

}  // namespace hg::config
