/// Volume of a cloud of points, in voxels, and the points reached in one orientation.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "hg/config/device.h"
#include "hg/workspace/survey.h"

namespace hg::workspace {

/// A box cut into voxels of equal size, each edge near the wanted one.
class VoxelGrid {
 public:
  VoxelGrid(const Eigen::AlignedBox3d& box, double edge);

  void touch(const Eigen::Vector3d& point);
  /// Volume of the touched voxels in m^3. A voxel at the edge of the cloud counts half: it is cut
  /// through the middle on average. The faces of the box are no edge.
  double volume() const;

 private:
  /// Whether all 26 neighbours are touched
  bool are_neighbours_touched(const Eigen::Vector3i& cell) const;
  bool is_touched(const Eigen::Vector3i& cell) const;
  std::size_t index(const Eigen::Vector3i& cell) const;

  Eigen::AlignedBox3d box_;
  Eigen::Vector3i count_;
  Eigen::Vector3d edge_;
  std::vector<char> touched_;
};

/// Box in which all Cartesian limits of the handle together keep it; infinite on unlimited axes.
Eigen::AlignedBox3d handle_box(const DeviceModel& model);

struct HandleWorkspace {
  Eigen::AlignedBox3d bounds;    ///< bounds of the handle, m
  double volume = 0.0;           ///< m^3
  bool has_box = false;          ///< the handle is limited on all axes
  double box_volume = 0.0;       ///< m^3
  double share_any = 0.0;        ///< share of the box reached in some orientation
  double share_nominal = 0.0;    ///< share of the box reached in the orientation below
  Eigen::Vector3d nominal_axis;  ///< z axis of the handle in B in the nominal posture
};

HandleWorkspace workspace(const config::DeviceConfig& device, const Survey& survey);

}  // namespace hg::workspace
