/// What a page tells about the hand beyond the record of a cycle: the user's wrench part by part,
/// and how near the device is to a singular posture.
///
/// Moves chains of its own; allocates. For one observer thread.
#pragma once

#include <optional>

#include "hg/config/scenario.h"
#include "hg/viewer_server/view.h"

namespace hg::apps {

class HandAnalysis {
 public:
  explicit HandAnalysis(const config::Scenario& scenario);

  /// The budget of the record, which is in joints of the twin, as wrenches on the hand: of all
  /// wrenches with the same torques the smallest, so that the parts and what the bearings carry add
  /// up to the user's.
  viewer_server::HandBudget budget(const CycleRecord& record);

  /// Nothing until the device has a posture.
  std::optional<viewer_server::Singularity> singularity(const CycleRecord& record);

 private:
  model::Chain twin_;
  int end_effector_;
  rendering::DeviceModel device_;
  double best_ = 0.0;  ///< of the dexterity of many postures
};

}  // namespace hg::apps
