#include "hg/config/device_collision.h"

#include "hg/model/urdf_parts.h"

namespace hg::config {

void watch_collisions(const UrdfText& urdf, const model::ChainOptions& options,
                      const DeviceDraft& draft, Device& device) {
  const model::Chain& chain = device.model.chain;
  collision::Geometry geometry = collision::read_geometry(
      model::serial_part(model::read_urdf_text(urdf.text, urdf.file.generic_string()),
                         options.root_link, options.tip_link),
      chain);
  device.unknown_links = std::move(geometry.links_without);
  if (options.tool) device.unknown_links.push_back(options.tool->handle);
  if (geometry.shapes.empty()) return;

  collision::Config& collision = device.collision;
  collision.shapes = std::move(geometry.shapes);
  if (draft.has_floor) collision.shapes.push_back(collision::floor_at(device.floor_z));
  std::vector<Interval> range(device.prepositioning.q_limits.begin(),
                              device.prepositioning.q_limits.begin() + device.model.n_p);
  for (const limits::JointLimits& joint : device.model.joint_limits) {
    range.push_back({joint.q_min, joint.q_max});
  }
  collision.pairs = collision::choose_pairs(collision.shapes, chain, range,
                                            collision.safe_distance + collision::kFarEnough);
}

void set_reaction(Device& device, double dt) {
  constexpr double kDrive = 0.010;  // s, [HANDBOOK] 6.4
  const int n_p = device.model.n_p;
  const int n = n_p + device.model.n_m;
  collision::Config& collision = device.collision;
  collision.reaction = VectorPM::Constant(n, 2.0 * dt + kDrive);
  collision.deceleration.resize(n);
  for (int i = 0; i < n; ++i) {
    if (i < n_p) {
      collision.reaction[i] = 2.0 * dt + device.drive.dead_time + device.drive.lag;
      collision.deceleration[i] = device.prepositioning.drive.ddq_max;
    } else {
      collision.deceleration[i] =
          device.model.joint_limits[static_cast<std::size_t>(i - n_p)].ddq_max;
    }
  }
}

}  // namespace hg::config
