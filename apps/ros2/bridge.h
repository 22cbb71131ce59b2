/// The bridge: what a run offers live, as topics, services and parameters of a ROS 2 node.
#pragma once

#include <atomic>
#include <string>

#include "apps/ros2/node.h"

namespace hg::ros2 {

struct BridgeOptions {
  NodeOptions node;
  std::string live;      ///< address of the live interface; empty: that of the newest run here
  bool is_view = false;  ///< topics out of the run only: nothing in ROS can change it
};

/// Connects a node with a run, and again whenever a run begins, until `stop`. Throws SetupError.
void run_bridge(const BridgeOptions& options, const std::atomic<bool>& stop);

}  // namespace hg::ros2
