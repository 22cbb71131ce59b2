/// Mailbox for hand targets: all pages write to it, the program takes the newest.
///
/// One page drags at a time: the first, until it releases, leaves, or is silent for 0.5 s. Times
/// are arguments, so that the rule is testable without waiting. Not synchronised.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "hg/signals/frames.h"

namespace hg::viewer_server {

/// Numbers of pages; 0 = none.
struct HandHolder {
  std::uint64_t page = 0;      ///< page that drags
  std::uint64_t asked_by = 0;  ///< page that asks it for the hand
};

class HandTargetBox {
 public:
  /// Time after which a silent dragging page counts as gone
  static constexpr double kSilence_s = 0.5;
  static constexpr double kAsking_s = 10.0;  ///< duration of a request for the hand
  static constexpr double kMargin = 0.5;     ///< m; distance by which a target may leave the box

  /// Targets are clamped to `limits` grown by kMargin.
  explicit HandTargetBox(const Eigen::AlignedBox3d& limits);

  /// Stores a target; false when another page drags: the target is ignored.
  bool put(std::uint64_t page, const HandTarget& target, double now_s);

  /// Asks the dragging page for the hand; false when no other page drags.
  bool ask(std::uint64_t page, double now_s);

  HandHolder holder(double now_s);

  /// Removes a page that has disconnected.
  void leave(std::uint64_t page);

  /// Gets the newest target since the last call; false: none.
  bool take(HandTarget& target, double now_s);

 private:
  void release();

  Eigen::AlignedBox3d limits_;
  HandTarget newest_;
  double heard_s_ = 0.0;        ///< time of the last message of the dragging page
  std::uint64_t dragging_ = 0;  ///< page that drags; 0 = none
  std::uint64_t asked_by_ = 0;  ///< page that asks for the hand; 0 = none
  double asked_s_ = 0.0;        ///< time of its request
  bool is_new_ = false;
};

}  // namespace hg::viewer_server
