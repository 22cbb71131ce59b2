/// The catalogue of all limits of a device and a twin: the order of the rows of tasks 2 to 6.
#pragma once

#include <string>
#include <vector>

#include "hg/controller/rendering/twin_model.h"
#include "hg/model/chain_data.h"
#include "hg/model/device_model.h"
#include "hg/signals/limit.h"

namespace hg::rendering {

/// Manipulator joints, virtual joints, motors that the law models, x y z of each Cartesian frame,
/// then one entry per degree of freedom of the twin. Quantities without limits are listed, too:
/// their range is unbounded.
LimitCatalogue make_catalogue(const DeviceModel& device, const TwinModel& twin);

/// Names used more than once in the catalogue: such limits could not be distinguished in events,
/// figures and on the page.
std::vector<std::string> repeated_names(const LimitCatalogue& catalogue);

/// Positions of the device's limits, first in the catalogue.
class LimitPositions {
 public:
  explicit LimitPositions(const DeviceModel& device);

  /// Computes them with the gantry at `q_p` and the manipulator at `q_m`.
  void find(const VectorP& q_p, const VectorM& q_m, std::vector<double>& positions);

 private:
  std::vector<VirtualJoint> virtual_joints_;
  std::size_t motors_;
  bool keeps_apart_;
  std::vector<int> frames_;  ///< Frames with Cartesian limits
  model::ChainData chain_;   ///< Device in the posture of the last find()
};

}  // namespace hg::rendering
