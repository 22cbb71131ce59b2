#include "bench/times.h"

#include <algorithm>

namespace hg::bench {

void Times::add(std::size_t index, double us) {
  if (index == us_.size()) {
    us_.push_back(us);
  } else {
    us_.at(index) = std::min(us_.at(index), us);
  }
}

}  // namespace hg::bench
