#include "hg/viewer_server/hand_target_box.h"

namespace hg::viewer_server {

HandTargetBox::HandTargetBox(const Eigen::AlignedBox3d& limits)
    : limits_(limits.min().array() - kMargin, limits.max().array() + kMargin) {}

bool HandTargetBox::put(std::uint64_t page, const HandTarget& target, double now_s) {
  if (dragging_ != 0 && now_s - heard_s_ > kSilence_s) release();
  if (dragging_ != 0 && dragging_ != page) return false;
  if (!target.active) {
    if (dragging_ == page) release();
    return true;
  }
  dragging_ = page;
  heard_s_ = now_s;
  newest_ = target;
  newest_.p_B = target.p_B.cwiseMax(limits_.min()).cwiseMin(limits_.max());
  is_new_ = true;
  return true;
}

bool HandTargetBox::ask(std::uint64_t page, double now_s) {
  const HandHolder now = holder(now_s);
  if (now.page == 0 || now.page == page) return false;
  asked_by_ = page;
  asked_s_ = now_s;
  return true;
}

HandHolder HandTargetBox::holder(double now_s) {
  if (dragging_ != 0 && now_s - heard_s_ > kSilence_s) release();
  if (now_s - asked_s_ > kAsking_s) asked_by_ = 0;
  return {dragging_, asked_by_};
}

void HandTargetBox::leave(std::uint64_t page) {
  if (asked_by_ == page) asked_by_ = 0;
  if (dragging_ == page) release();
}

bool HandTargetBox::take(HandTarget& target, double now_s) {
  if (dragging_ != 0 && now_s - heard_s_ > kSilence_s) release();
  if (!is_new_) return false;
  is_new_ = false;
  target = newest_;
  return true;
}

void HandTargetBox::release() {
  dragging_ = asked_by_ = 0;
  newest_.active = false;
  newest_.press = 0.0;
  is_new_ = true;
}

}  // namespace hg::viewer_server
