/// Hand data of a page beyond the record of a cycle: the user's wrench part by part, and the
/// distance to a singular posture.
///
/// Moves chains of its own; allocates. For one observer thread.
#pragma once

#include <optional>

#include "hg/config/simulation/scenario.h"
#include "hg/model/chain_data.h"
#include "hg/viewer_server/view.h"

namespace hg::page {

class HandAnalysis {
 public:
  explicit HandAnalysis(const config::Scenario& scenario);

  /// Converts the budget of the record, in joints of the twin, to wrenches on the hand: the
  /// smallest wrench with the same torques, so that the parts and the bearing reactions add up to
  /// the user's.
  viewer_server::HandBudget budget(const CycleRecord& record);

  /// Distance to a singular posture; empty until the device has a posture.
  std::optional<viewer_server::Singularity> singularity(const CycleRecord& record);

 private:
  model::ChainData twin_;
  int end_effector_;
  DeviceModel device_;
  model::ChainData device_chain_;
  double best_ = 0.0;  ///< best dexterity of many postures
};

}  // namespace hg::page
