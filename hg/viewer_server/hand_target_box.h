/// Where the hand targets of all pages arrive and the program picks up the newest.
///
/// One page drags at a time: the first, until it lets go, leaves, or is silent for 0.5 s. Times are
/// arguments, so that the rule is testable without waiting. Not synchronised.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "hg/signals/frames.h"

namespace hg::viewer_server {

class HandTargetBox {
 public:
  static constexpr double kSilence_s = 0.5;  ///< after it a dragging page counts as gone
  static constexpr double kMargin = 0.5;     ///< m; how far a target may leave the box

  /// Targets are clamped to `limits` grown by kMargin.
  explicit HandTargetBox(const Eigen::AlignedBox3d& limits);

  /// False when another page drags: the target is ignored.
  bool put(std::uint64_t page, const HandTarget& target, double now_s);

  /// The page has gone.
  void leave(std::uint64_t page);

  /// The newest target since the last call, or false.
  bool take(HandTarget& target, double now_s);

 private:
  void release();

  Eigen::AlignedBox3d limits_;
  HandTarget newest_;
  double heard_s_ = 0.0;        ///< when the dragging page was heard last
  std::uint64_t dragging_ = 0;  ///< page that drags; 0 = none
  bool is_new_ = false;
};

}  // namespace hg::viewer_server
