#include "hg/device/udp/inbox.h"

#include <algorithm>

namespace hg::udp {

NumberWindow::Place NumberWindow::accept(std::uint64_t number) noexcept {
  if (count_ == 0 || number > newest_) {
    const std::uint64_t step = count_ == 0 ? kSize : number - newest_;
    seen_ <<= step;
    seen_.set(0);
    if (count_ == 0) first_ = number;
    newest_ = number;
    ++count_;
    return Place::kNewest;
  }
  const std::uint64_t age = newest_ - number;
  if (age >= kSize || seen_[age]) return Place::kSeen;
  seen_.set(age);
  first_ = std::min(first_, number);
  ++count_;
  return Place::kOvertaken;
}

bool Inbox::accept(DatagramCheck verdict, const Header& header) noexcept {
  was_overtaken_ = false;
  switch (verdict) {
    case DatagramCheck::kGood:
      break;
    case DatagramCheck::kTruncated:
      ++counts_.truncated;
      return false;
    case DatagramCheck::kForeign:
      ++counts_.foreign;
      return false;
    case DatagramCheck::kCorrupted:
      ++counts_.corrupted;
      return false;
    case DatagramCheck::kWrongVersion:
      ++counts_.wrong_version;
      return false;
    case DatagramCheck::kForged:
      ++counts_.forged;
      return false;
  }
  if (header.session != session_) {
    ++counts_.wrong_session;
    return false;
  }
  if (!sends(sender_, static_cast<MessageType>(header.type))) {
    ++counts_.foreign;
    return false;
  }
  switch (window_.accept(header.number)) {
    case NumberWindow::Place::kSeen:
      ++counts_.duplicate;
      return false;
    case NumberWindow::Place::kOvertaken:
      ++counts_.reordered;
      was_overtaken_ = true;
      break;
    case NumberWindow::Place::kNewest:
      break;
  }
  ++counts_.received;
  return true;
}

LinkCounts Inbox::counts() const noexcept {
  LinkCounts counts = counts_;
  counts.lost = window_.missing();
  return counts;
}

}  // namespace hg::udp
